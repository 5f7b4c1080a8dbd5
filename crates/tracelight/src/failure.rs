use std::fmt::Display;
use std::process::ExitCode;

use tracelight_rig::Fault;

/// How a command that did not succeed ends the process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Status {
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
    const fn code(self) -> u8 {
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
pub(crate) struct Failure {
    pub(crate) status: Status,
    /// Stable, for `--json` and `explain`.
    pub(crate) code: &'static str,
    pub(crate) message: String,
}

impl Failure {
    /// A readable input that is refused, or work that failed.
    pub(crate) fn failed(code: &'static str, message: impl Display) -> Self {
        Self { status: Status::Failed, code, message: message.to_string() }
    }

    /// A wrong command line or file.
    pub(crate) fn usage(code: &'static str, message: impl Display) -> Self {
        Self { status: Status::Usage, code, message: message.to_string() }
    }

    /// The user pressed Ctrl-C.
    pub(crate) fn interrupted() -> Self {
        Self {
            status: Status::Interrupted,
            code: "interrupted",
            message: "interrupted: the laser is dark, the log is closed".into(),
        }
    }

    /// The rig latched a fault.
    pub(crate) fn fault(fault: Fault) -> Self {
        let message = format!(
            "the laser darkened and the run stopped: {} ({})",
            fault.code(),
            crate::output::fault_words(fault)
        );
        Self { status: Status::Fault, code: fault.code(), message }
    }

    /// The process's exit status.
    pub(crate) fn exit_code(&self) -> ExitCode {
        ExitCode::from(self.status.code())
    }

    /// `{"error":{"code","message"}}`.
    pub(crate) fn json(&self) -> String {
        serde_json::json!({"error": {"code": self.code, "message": self.message}}).to_string()
    }
}

impl From<crate::output::OutputError> for Failure {
    fn from(error: crate::output::OutputError) -> Self {
        Self::failed("cannot-write", error)
    }
}

impl From<tracelight_trajectory::PlanError> for Failure {
    fn from(error: tracelight_trajectory::PlanError) -> Self {
        use tracelight_trajectory::PlanError;
        let code = match error {
            PlanError::Empty => "no-strokes",
            PlanError::Aim { .. } => "unreachable",
            PlanError::TooWeak { .. } => "motor-too-weak",
            PlanError::TooLong { .. } => "too-long",
            PlanError::NoWayAtSpeed { .. } => "no-way-at-speed",
            PlanError::TooBent { .. } => "too-bent",
        };
        Self::failed(code, error)
    }
}
