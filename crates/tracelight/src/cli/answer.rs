//! What every command is told and what it answers.

use std::io::Write;

use clap::Args;
use tracelight_task::{Failure, Stop};

/// What every command has.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(crate) struct Voice {
    /// One JSON object on standard output, nothing else there
    #[arg(long, global = true)]
    pub(crate) json: bool,
    /// No progress and no remarks on standard error
    #[arg(long, global = true)]
    pub(crate) quiet: bool,
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

    /// The one that will be printed; the other is not made.
    pub(crate) fn either(voice: Voice, text: impl FnOnce() -> String, json: impl FnOnce() -> String) -> Self {
        if voice.json { Self::new("", json()) } else { Self::new(text(), "") }
    }
}

/// Does what a command line says, in this process, and returns what would be printed.
pub(crate) type Performs = fn(&[&str], &Stop) -> Result<Answer, Failure>;

/// To standard output; a reader that has left is no error.
pub(crate) fn print(text: &str) {
    let mut out = std::io::stdout().lock();
    if !text.is_empty() {
        drop(writeln!(out, "{text}"));
    }
}

/// A piece of what is printed, before the rest is there; a reader that has left is no error.
pub(crate) fn print_piece(text: &str) {
    drop(write!(std::io::stdout().lock(), "{text}"));
}
