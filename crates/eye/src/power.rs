//! A rig that was just powered up, or lost power, and not one that lost counts: of that a fault tells.

use tracelight_rig::{Fault, Telemetry};
use tracelight_task::Failure;

/// Tells whether a rig that is not homed any more lost power, tick by tick.
#[derive(Clone, Copy, Debug, Default)]
pub struct PowerWatch {
    /// Number of its faults when it last said that it was homed.
    homed_with: Option<u32>,
    /// Whether it was told to forget where it points, and was not homed since.
    forgot: bool,
}

impl PowerWatch {
    /// Tells that it is told to forget where it points: that it is not homed afterwards means nothing.
    pub const fn forget(&mut self) {
        self.forgot = true;
    }

    /// Whether it lost power, or was never homed, by what it tells in one more tick. Who lost counts has had one more fault since.
    pub fn is_lost(&mut self, now: &Telemetry) -> bool {
        if now.homed {
            *self = Self { homed_with: Some(now.fault_number), forgot: false };
            return false;
        }
        !self.forgot && self.homed_with.is_none_or(|number| now.fault_number <= number)
    }
}

/// Refuses a rig that does not know where its joints are, but for one whose fault says why.
///
/// # Errors
/// `unhomed`: nobody told the rig where zero is since it was powered up.
pub fn check_homed(now: &Telemetry) -> Result<(), Failure> {
    if now.homed || now.fault().is_some_and(Fault::loses_counts) {
        return Ok(());
    }
    Err(unhomed())
}

/// What becomes of a job whose rig does not know where its joints are.
#[must_use]
pub fn unhomed() -> Failure {
    let message = "the head was powered up and not homed since: nobody knows where its light would fall, and nothing was drawn; home it first: tracelight home, for a head at a port that points straight ahead, or tracelight calibrate head --home --camera …";
    Failure::failed("unhomed", message)
}

/// What becomes of a job whose rig was homed, and is not any more.
#[must_use]
pub fn lost_power() -> Failure {
    let message = "the rig lost power while it drew: it is dark, and nobody knows where its light would fall; what was drawn until then is told; home it (tracelight home, or tracelight calibrate head --home --camera …) and draw what is left";
    Failure::failed("unhomed", message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_that_were_lost_are_not_power_that_was_lost() {
        let homed = |fault_number| Telemetry { homed: true, fault_number, ..Telemetry::default() };
        let unhomed = |fault_number| Telemetry { fault_number, ..Telemetry::default() };
        let mut watch = PowerWatch::default();
        assert!(watch.is_lost(&unhomed(0)), "it never was homed");
        assert!(!watch.is_lost(&homed(2)) && !watch.is_lost(&unhomed(3)) && !watch.is_lost(&unhomed(4)));
        assert!(watch.is_lost(&unhomed(0)), "power that went while it was homed again");
        assert!(!watch.is_lost(&homed(5)) && watch.is_lost(&unhomed(0)));
        assert!(!watch.is_lost(&homed(5)));
        watch.forget();
        assert!(!watch.is_lost(&unhomed(5)), "as it was told");
        assert!(
            !watch.is_lost(&homed(5)) && watch.is_lost(&unhomed(5)),
            "and homed again it is another time"
        );
    }
}
