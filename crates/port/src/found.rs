//! Serial ports of this computer, and which of them are those of boards.

use std::fs;
use std::path::{Path, PathBuf};

/// A serial port that is there.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Found {
    /// Its device, such as `/dev/ttyACM0`.
    pub port: PathBuf,
    /// By what it is called that tells which device it is, however it is plugged in.
    pub name: Option<String>,
}

impl Found {
    /// Whether it says by its name that it is a board of Tracelight's.
    #[must_use]
    pub fn is_board(&self) -> bool {
        self.name.as_ref().is_some_and(|name| name.to_lowercase().contains("tracelight"))
    }
}

/// The serial ports of USB devices, in the order of their names. Nothing is opened.
#[must_use]
pub fn found() -> Vec<Found> {
    found_in(Path::new("/dev"))
}

/// Likewise, where devices are in that folder.
fn found_in(dev: &Path) -> Vec<Found> {
    let entries = |dir: PathBuf| fs::read_dir(dir).into_iter().flatten().filter_map(Result::ok);
    let named: Vec<(PathBuf, String)> = entries(dev.join("serial/by-id"))
        .filter_map(|entry| {
            let port = fs::canonicalize(entry.path()).ok()?;
            Some((port, entry.file_name().to_string_lossy().into_owned()))
        })
        .collect();
    let is_usb = |name: &str| ["ttyACM", "ttyUSB", "cu.usbmodem"].iter().any(|kind| name.starts_with(kind));
    let ports = entries(dev.to_owned()).filter(|entry| is_usb(&entry.file_name().to_string_lossy()));
    let mut all: Vec<Found> = ports
        .map(|entry| {
            let port = entry.path();
            let same = fs::canonicalize(&port).unwrap_or_else(|_| port.clone());
            let name = named.iter().find(|(at, _)| *at == same).map(|(_, name)| name.clone());
            Found { port, name }
        })
        .collect();
    all.sort();
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ports_are_told_with_the_names_of_their_devices() {
        let dev = std::env::temp_dir().join(format!("tracelight-dev-{}", std::process::id()));
        fs::create_dir_all(dev.join("serial/by-id")).unwrap();
        for name in ["ttyACM1", "ttyACM0", "ttyUSB0", "tty1", "null"] {
            fs::write(dev.join(name), "").unwrap();
        }
        let link = |to: &str, name: &str| {
            std::os::unix::fs::symlink(format!("../../{to}"), dev.join("serial/by-id").join(name)).unwrap();
        };
        link("ttyACM1", "usb-Tracelight_Pico_2_E66-if00");
        link("ttyUSB0", "usb-1a86_USB_Serial-if00-port0");
        link("ttyACM9", "usb-gone");
        let found = found_in(&dev);
        fs::remove_dir_all(&dev).unwrap();
        let of = |name: &str, id: Option<&str>| Found { port: dev.join(name), name: id.map(str::to_owned) };
        assert_eq!(
            found,
            [
                of("ttyACM0", None),
                of("ttyACM1", Some("usb-Tracelight_Pico_2_E66-if00")),
                of("ttyUSB0", Some("usb-1a86_USB_Serial-if00-port0")),
            ]
        );
        assert_eq!(found.iter().map(Found::is_board).collect::<Vec<_>>(), [false, true, false]);
        assert_eq!(found_in(Path::new("/nowhere")), []);
    }
}
