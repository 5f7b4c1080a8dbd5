//! Why a camera cannot be used, in words.

use std::io;

use tracelight_picture::unless_it_panics;

use crate::devices::devices;
use crate::latest::PATIENCE;

const EIO: i32 = 5;
const ENXIO: i32 = 6;
const ENODEV: i32 = 19;
const ENOTTY: i32 = 25;
const ENOSPC: i32 = 28;
const EPIPE: i32 = 32;
const EPROTO: i32 = 71;

/// What a driver answers, where the library panics at what it does not know of.
pub(super) fn calmly<T>(ask: impl FnOnce() -> io::Result<T>) -> io::Result<T> {
    unless_it_panics(ask).unwrap_or_else(|| Err(io::Error::other("its driver says what nobody knows")))
}

/// Whether the camera is no longer there.
pub(super) fn is_gone(error: &io::Error) -> bool {
    matches!(error.raw_os_error(), Some(ENODEV | ENXIO))
}

/// Of a camera that was found.
pub(super) fn in_words(error: &io::Error) -> String {
    match (error.kind(), error.raw_os_error()) {
        (io::ErrorKind::TimedOut, _) => format!("no image for {} s", PATIENCE.as_secs()),
        (io::ErrorKind::ResourceBusy, _) => "another program uses it: close that first".to_owned(),
        (_, Some(ENODEV | ENXIO)) => "it was unplugged".to_owned(),
        (_, Some(ENOSPC)) => {
            "its bus has no room for so many and so large images: plug it in elsewhere, take a smaller --camera-size, or close the program that uses another camera".to_owned()
        }
        (_, Some(EIO | EPIPE | EPROTO)) => {
            format!("it does not answer as it should ({error}): unplug it and plug it in again")
        }
        (_, Some(ENOTTY)) => "it is no camera".to_owned(),
        _ => error.to_string(),
    }
}

/// Of one that is opened.
pub(super) fn not_opened(path: &str, error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => {
            let all: Vec<String> = devices().iter().map(|path| path.display().to_string()).collect();
            let there = if all.is_empty() {
                "there is none".to_owned()
            } else {
                format!("there is {}", all.join(", "))
            };
            format!("no such device ({there}): is it plugged in? `tracelight doctor` lists what is there")
        }
        io::ErrorKind::PermissionDenied => format!(
            "you may not use it: add yourself to the group that owns it (sudo usermod -aG video $USER; ls -l {path}) and log in again"
        ),
        _ => in_words(error),
    }
}
