//! A rig that is known better than before, as a rig file.

use tracelight_rigfile as rigfile;
use tracelight_sim::RigConfig;
use tracelight_task::Failure;

/// The text of its rig file.
///
/// # Errors
/// `identify`: what was found is no head that a rig file takes.
pub fn rig_file(better: &RigConfig) -> Result<String, Failure> {
    let text = rigfile::write(better);
    match rigfile::parse("what was found", &text) {
        Ok(_) => Ok(text),
        Err(wrong) => {
            let message =
                format!("what was found is no head that a rig file takes, so nothing is written: {wrong}");
            Err(Failure::failed("identify", message))
        }
    }
}
