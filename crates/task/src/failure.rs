//! Why work failed: a status, a code for scripts, a sentence for people.

use std::fmt::Display;

use tracelight_rig::FaultRecord;

use crate::place::Place;

/// How a command that did not succeed ends the process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The work failed, or a readable input was refused.
    Failed,
    /// The command line, or a file given to it, is wrong.
    Usage,
    /// A rig fault darkened the laser and stopped the run.
    Fault,
    /// The user interrupted.
    Interrupted,
}

impl Status {
    /// The exit status of a process.
    #[must_use]
    pub const fn code(self) -> u8 {
        match self {
            Status::Failed => 1,
            Status::Usage => 2,
            Status::Fault => 3,
            Status::Interrupted => 130,
        }
    }
}

/// Why a command failed, in words for the user and a code for scripts.
#[derive(Clone, Debug)]
pub struct Failure {
    /// Whose fault it is.
    pub status: Status,
    /// Stable, for `--json` and `explain`.
    pub code: &'static str,
    /// A sentence: what, where, and what to do.
    pub message: String,
}

impl Failure {
    /// A readable input that is refused, or work that failed.
    #[must_use]
    pub fn failed(code: &'static str, message: impl Display) -> Self {
        Self { status: Status::Failed, code, message: message.to_string() }
    }

    /// A wrong command line or file.
    #[must_use]
    pub fn usage(code: &'static str, message: impl Display) -> Self {
        Self { status: Status::Usage, code, message: message.to_string() }
    }

    /// The user pressed Ctrl-C.
    #[must_use]
    pub fn interrupted() -> Self {
        Self {
            status: Status::Interrupted,
            code: "interrupted",
            message: "interrupted: the laser is dark, the log is closed".into(),
        }
    }

    /// The rig latched a fault.
    #[must_use]
    pub fn fault(record: FaultRecord) -> Self {
        let (fault, evidence) = (record.fault, record.evidence());
        let shown = if evidence.is_empty() { String::new() } else { format!(": {evidence}") };
        let message =
            format!("the laser darkened and the run stopped: {}{shown} ({})", fault.code(), fault.words());
        Self { status: Status::Fault, code: fault.code(), message }
    }

    /// Where in a file something is wrong, if the message begins with that: `rig.toml:3:1: …` or `plan.dxf: line 12, column 4: …`.
    #[must_use]
    pub fn place(&self) -> Option<Place> {
        Place::before(self.message.lines().next()?)
    }

    /// `{"error":…}` with the failure's [object](Self::object).
    #[must_use]
    pub fn json(&self, help: &str) -> String {
        serde_json::json!({ "error": self.object(help) }).to_string()
    }

    /// `{"code","message","where","help","exit"}`; `where` is `{"file","line","column"}`, null where no place is known, and so is
    /// the column. `help` is what to do.
    #[must_use]
    pub fn object(&self, help: &str) -> serde_json::Value {
        let place = self.place().map(
            |Place { file, line, column }| serde_json::json!({"file": file, "line": line, "column": column}),
        );
        serde_json::json!({
            "code": self.code,
            "message": self.message,
            "where": place,
            "help": help,
            "exit": self.status.code(),
        })
    }
}
