use super::input::LawInput;

/// Position and velocity error to acceleration, both closed-loop poles placed; there is no integrator, since what an
/// integrator would find is estimated by the observer and taken away by [`Feedforward::Learned`](super::Feedforward).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StateFeedback {
    /// Distance of the poles from the origin, rad/s.
    pub bandwidth_rad_s: f32,
    /// Damping ratio of the pair.
    pub damping: f32,
}

impl StateFeedback {
    /// s² + 2ζω s + ω² for the inertia the joint has shown.
    pub(super) fn torque_nm(&self, input: &LawInput<'_>) -> f32 {
        let w = self.bandwidth_rad_s;
        let acceleration = w * w * input.error_rad() + 2.0 * self.damping * w * input.rate_error_rad_s();
        input.inertia_kg_m2 * (1.0 + input.estimate.learned.inertia_share) * acceleration
    }
}
