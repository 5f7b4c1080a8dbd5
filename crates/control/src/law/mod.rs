//! Control laws: from estimate and setpoint to torque.

mod feedforward;
mod input;
mod lead_lag;
mod pid;
mod state_feedback;

pub(crate) use feedforward::feedforward;
pub(crate) use input::LawInput;
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

/// What the model adds to feedback.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Feedforward {
    /// Nothing.
    #[default]
    None,
    /// What holds the head against gravity where it should be.
    Gravity,
    /// All the motion asks for by the model: inertia, Coriolis, gravity, friction.
    Model,
    /// Feedforward with the learned parameters, and against the learned load.
    Learned,
}

/// What one joint's law remembers.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LawState {
    pid: PidState,
    lead_lag: LeadLagState,
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
