//! What every command is told and what it answers.

use std::io::Write;

use clap::Args;
use tracelight_operator::{Bar, Seat};
use tracelight_task::{Failure, Stop, Task};

/// What every command has.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(crate) struct Voice {
    /// One JSON object on standard output, nothing else there
    #[arg(long, global = true)]
    pub(crate) json: bool,
    /// No progress and no remarks on standard error
    #[arg(long, global = true)]
    pub(crate) quiet: bool,
    /// What people are told is made too, for somebody who shows both
    #[arg(long, global = true, hide = true, requires = "json")]
    pub(crate) words: bool,
}

/// What work comes to that tells how far it is.
pub(crate) fn watched<T>(voice: Voice, stop: &Stop, work: impl FnOnce(Task<'_>) -> T) -> T {
    let bar = Bar::new(voice.quiet);
    work(Task { progress: &bar, stop })
}

/// What a command prints on standard output when it succeeds, for people and for scripts.
pub(crate) struct Answer {
    pub(crate) text: String,
    pub(crate) json: String,
    /// The command did its work, and what it worked on failed.
    pub(crate) failure: Option<Failure>,
}

impl Answer {
    pub(crate) fn new(text: impl Into<String>, json: impl Into<String>) -> Self {
        Self { text: text.into(), json: json.into(), failure: None }
    }

    /// The one that will be printed, or both; what nobody reads is not made.
    pub(crate) fn either(voice: Voice, text: impl FnOnce() -> String, json: impl FnOnce() -> String) -> Self {
        match (voice.json, voice.words) {
            (true, true) => Self::new(text(), json()),
            (true, false) => Self::new("", json()),
            (false, _) => Self::new(text(), ""),
        }
    }
}

/// Does what a command line says, in this process, and returns what would be printed.
pub(crate) type Performs = fn(&[&str], &Stop) -> Result<Answer, Failure>;

/// The same for somebody who shows by himself how far it is, and may attend it.
pub(crate) type PerformsWith = fn(&[String], Option<&dyn Seat>, Task<'_>) -> Result<Answer, Failure>;

/// Looks through a camera as a command line says, and shows somebody one image after the other, as JPEG and in figures, until he wants no more.
pub(crate) type LooksFor =
    fn(&[String], &Stop, &mut dyn FnMut(Vec<u8>, serde_json::Value) -> bool) -> Result<(), Failure>;

/// To standard output; a reader that has left is no error.
///
/// # Errors
/// `cannot-write` where what was to be answered was not.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    if text.is_empty() { Ok(()) } else { print_piece(&format!("{text}\n")) }
}

/// A piece of what is printed, before the rest is there.
pub(crate) fn print_piece(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            let message = format!(
                "cannot write to standard output: {error}; nothing, or only a part, of the answer was written"
            );
            Err(Failure::failed("cannot-write", message))
        }
        _ => Ok(()),
    }
}
