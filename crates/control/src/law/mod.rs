//! From where a joint is and where it should be to torque.

mod feedforward;
mod lead_lag;
mod pid;
mod state_feedback;

use tracelight_rig::Setpoint;

use crate::observer::Estimate;
pub use feedforward::Feedforward;
pub(crate) use feedforward::feedforward;
pub use lead_lag::{Biquad, LeadLag};
pub use pid::Pid;
pub use state_feedback::StateFeedback;

use lead_lag::LeadLagState;
use pid::PidState;

/// How one joint is controlled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawConfig {
    /// What acts on the error.
    pub feedback: Feedback,
    /// What the model adds, whatever the error.
    pub feedforward: Feedforward,
}

/// What acts on the error; torques in N m at the joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Feedback {
    /// Proportional, integral, derivative.
    Pid(Pid),
    /// Poles and zeros.
    LeadLag(LeadLag),
    /// Position and velocity error to acceleration; what disturbs is estimated and taken away.
    State(StateFeedback),
}

/// What one joint's law remembers.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LawState {
    pid: PidState,
    lead_lag: LeadLagState,
}

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
    fn error_rad(&self) -> f32 {
        self.setpoint.position_rad - self.estimate.position_rad
    }

    fn rate_error_rad_s(&self) -> f32 {
        self.setpoint.velocity_rad_s - self.estimate.velocity_rad_s
    }
}

impl Feedback {
    /// Torque for this tick, N m, not limited.
    pub(crate) fn torque_nm(&self, state: &mut LawState, input: &LawInput<'_>) -> f32 {
        match self {
            Feedback::Pid(pid) => pid.torque_nm(&mut state.pid, input),
            Feedback::LeadLag(lead_lag) => lead_lag.torque_nm(&mut state.lead_lag, input.error_rad()),
            Feedback::State(state_feedback) => state_feedback.torque_nm(input),
        }
    }

    /// Anti-windup: told how much more was asked for than the amplifier gives.
    pub(crate) fn settle(&self, state: &mut LawState, input: &LawInput<'_>, excess_v: f32) {
        if let Feedback::Pid(pid) = self {
            pid.integrate(&mut state.pid, input.error_rad(), excess_v);
        }
    }
}
