//! Safety thresholds of a rig: base motion, parking.

use tracelight_rig::PanTilt;

/// When what a head stands on counts as bumped, and where a head is parked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SafetySettings {
    /// From how fast it turns, rad/s, where a gyroscope is fixed to it.
    pub jolt_rad_s: f64,
    /// Largest rotation of the base after a bump that counts as undisplaced, rad.
    pub turned_rad: f64,
    /// Where the joints go, rad, when a switch of the laser does not open: of both or of none.
    pub park_rad: PanTilt<Option<f64>>,
}

impl SafetySettings {
    /// Default thresholds: two degrees a second, which every bump exceeds and nobody walking by does, and 0.3 mm at a metre.
    pub const USUAL: Self = Self { jolt_rad_s: 0.035, turned_rad: 3e-4, park_rad: PanTilt::new(None, None) };

    /// Where the head turns, rad, when a switch of the laser does not open; `None` where it stays.
    pub(crate) fn parked_rad(&self) -> Option<PanTilt<f64>> {
        let PanTilt { pan, tilt } = self.park_rad;
        Some(PanTilt::new(pan?, tilt?))
    }
}
