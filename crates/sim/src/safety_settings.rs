//! When a rig is dark although nothing is wrong with its head, and where it turns when it is not dark although it should be.

use tracelight_rig::PanTilt;

/// When what a head stands on counts as bumped, and where a head is parked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SafetySettings {
    /// From how fast it turns, rad/s, where a gyroscope is fixed to it.
    pub jolt_rad_s: f64,
    /// How far it may have turned once it is still again, and count as standing where it stood, rad.
    pub turned_rad: f64,
    /// Where the joints go, rad, when a switch of the laser does not open: of both or of none.
    pub park_rad: PanTilt<Option<f64>>,
}

impl SafetySettings {
    /// Two degrees a second, which nobody who walks by makes and every bump does, and 0.3 mm at a metre.
    pub const USUAL: Self = Self { jolt_rad_s: 0.035, turned_rad: 3e-4, park_rad: PanTilt::new(None, None) };

    /// Where the head turns, rad, when a switch of the laser does not open; `None` where it stays.
    pub(crate) fn parked_rad(&self) -> Option<PanTilt<f64>> {
        let PanTilt { pan, tilt } = self.park_rad;
        Some(PanTilt::new(pan?, tilt?))
    }
}
