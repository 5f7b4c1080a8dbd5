//! When a rig is dark although nothing is wrong with its head.

/// When what a head stands on counts as bumped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SafetySettings {
    /// From how fast it turns, rad/s, where a gyroscope is fixed to it.
    pub jolt_rad_s: f64,
    /// How far it may have turned once it is still again, and count as standing where it stood, rad.
    pub turned_rad: f64,
}

impl SafetySettings {
    /// Two degrees a second, which nobody who walks by makes and every bump does, and 0.3 mm at a metre.
    pub const USUAL: Self = Self { jolt_rad_s: 0.035, turned_rad: 3e-4 };
}
