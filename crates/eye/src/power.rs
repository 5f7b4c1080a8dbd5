//! A rig that was just powered up, or lost power.

use tracelight_rig::Telemetry;
use tracelight_task::Failure;

/// Refuses a rig that does not know where its joints are.
///
/// # Errors
/// `unhomed`: nobody told the rig where zero is since it was powered up.
pub fn check_homed(now: &Telemetry) -> Result<(), Failure> {
    if now.homed {
        return Ok(());
    }
    let message = "the head was powered up and not homed since: nobody knows where its light would fall, and nothing was drawn; home it first (tracelight calibrate head --home --camera …)";
    Err(Failure::failed("unhomed", message))
}

/// What becomes of a job whose rig was homed, and is not any more.
#[must_use]
pub fn lost_power() -> Failure {
    let message = "the rig lost power while it drew: it is dark, and nobody knows where its light would fall; what was drawn until then is told; home it (tracelight calibrate head --home --camera …) and draw what is left";
    Failure::failed("unhomed", message)
}
