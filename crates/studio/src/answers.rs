//! What commands answer.

use serde_json::Value;
use tracelight_task::Failure;

use crate::program::Performed;

/// What a command has answered, whatever failed of what it worked on.
///
/// # Errors
/// `internal` where it is no JSON.
pub(crate) fn json_of(performed: Performed) -> Result<Value, Failure> {
    serde_json::from_str(&performed.json)
        .map_err(|e| Failure::failed("internal", format!("the program's answer is no JSON: {e}")))
}

/// What a command has answered.
///
/// # Errors
/// What failed of what it worked on.
pub(crate) fn answer(performed: Performed) -> Result<Value, Failure> {
    let failure = performed.failure.clone();
    let answer = json_of(performed)?;
    failure.map_or(Ok(answer), Err)
}
