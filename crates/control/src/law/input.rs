//! Inputs of a law in one tick.

use tracelight_rig::Setpoint;

use crate::estimate::Estimate;

/// What a law looks at in one tick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LawInput<'a> {
    /// Where the joint should be now.
    pub(crate) setpoint: &'a Setpoint,
    /// Where it is believed to be.
    pub(crate) estimate: &'a Estimate,
    /// Inertia the joint feels, by the model, kg m².
    pub(crate) inertia_kg_m2: f32,
}

impl LawInput<'_> {
    pub(super) fn error_rad(&self) -> f32 {
        self.setpoint.position_rad - self.estimate.position_rad
    }

    pub(super) fn rate_error_rad_s(&self) -> f32 {
        self.setpoint.velocity_rad_s - self.estimate.velocity_rad_s
    }
}
