//! A refusal, as scripts and pages read it.

use axum::Json;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use serde_json::json;
use tracelight_task::{Failure, Status};

use crate::tasks::failure_json;

/// A failure as the command line's `--json` has it, and HTTP's number of its kind.
pub(crate) struct Refused(StatusCode, Failure);

impl Refused {
    /// A refusal whose kind HTTP alone knows.
    pub(crate) const fn with(status: StatusCode, failure: Failure) -> Self {
        Self(status, failure)
    }

    /// What is not there.
    pub(crate) fn missing(what: &str) -> Self {
        let failure = Failure::usage("unreadable", format!("there is no such {what} in the studio"));
        Self(StatusCode::NOT_FOUND, failure)
    }

    /// Where the path of a request names what is not there, HTTP says so.
    pub(crate) fn of_path(self) -> Self {
        let Self(status, failure) = self;
        Self(if failure.code == "unreadable" { StatusCode::NOT_FOUND } else { status }, failure)
    }

    /// What was asked is wrong.
    pub(crate) fn usage(message: impl Into<String>) -> Self {
        Failure::usage("usage", message.into()).into()
    }
}

impl From<Failure> for Refused {
    fn from(failure: Failure) -> Self {
        let status = match (failure.code, failure.status) {
            ("busy", _) => StatusCode::CONFLICT,
            (_, Status::Usage) => StatusCode::BAD_REQUEST,
            (_, Status::Interrupted) => StatusCode::CONFLICT,
            (_, Status::Failed | Status::Fault) => StatusCode::UNPROCESSABLE_ENTITY,
        };
        Self(status, failure)
    }
}

impl IntoResponse for Refused {
    fn into_response(self) -> Response {
        let Self(status, failure) = self;
        (status, Json(json!({ "error": failure_json(&failure) }))).into_response()
    }
}
