use tracelight_rig::{PanTilt, SPEED_RANGE};

use crate::job::Job;
use crate::state::{ARMED_TICKS, PAUSED_TICKS, State};

/// When a pause begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// Dark within a tick, wherever the spot is.
    AtOnce,
    /// Dark at the end of the stroke that is lit.
    AfterStroke,
}

/// What somebody asks of a session.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// Take the joints to be at these counts.
    Home(PanTilt<i32>),
    /// Allow the next job to light. It is forgotten after [`ARMED_TICKS`](crate::ARMED_TICKS).
    Arm,
    /// Take that back.
    Disarm,
    /// Trace a job from its beginning.
    Trace(Job),
    /// Pause the job.
    Pause(When),
    /// Go on where the light was.
    Resume,
    /// Run the plan's clock at this multiple of the plan's own speed, now and for jobs to come.
    Speed(f32),
    /// Darken, whatever the state.
    Stop,
    /// Acknowledge the fault. The head stays dark.
    Clear,
    /// Forget the job and return to zero in the dark.
    Park,
}

impl Request {
    /// Name of the request.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Home(_) => "home",
            Self::Arm => "arm",
            Self::Disarm => "disarm",
            Self::Trace(_) => "trace",
            Self::Pause(_) => "pause",
            Self::Resume => "resume",
            Self::Speed(_) => "speed",
            Self::Stop => "stop",
            Self::Clear => "clear",
            Self::Park => "park",
        }
    }
}

/// Why a request is refused. Nothing has changed then.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Refused {
    /// The request makes no sense in this state.
    #[error("{request} is not possible while the session is {}: {advice}", .state.name())]
    State {
        /// Name of the request.
        request: &'static str,
        /// State of the session.
        state: State,
        /// What may be asked instead.
        advice: &'static str,
    },
    /// Light needs somebody who arms first.
    #[error("arm first: a job lights only within {} s after somebody armed", ARMED_TICKS / 1000)]
    NotArmed,
    /// The job paused too long ago.
    #[error("it has been paused for more than {} s: arm first", PAUSED_TICKS / 1000)]
    PausedLong,
    /// The job has nothing in it.
    #[error("the job is empty: give it at least one segment")]
    Empty,
    /// The head is not where the job begins.
    #[error("the head is {off_rad:.4} rad from where the job begins: park first")]
    Elsewhere {
        /// How far the joint is that is further off, rad.
        off_rad: f32,
    },
    /// The speed is out of its bounds.
    #[error("a speed of {asked} is not between {} and {}", SPEED_RANGE.0, SPEED_RANGE.1)]
    Speed {
        /// What was asked.
        asked: f32,
    },
    /// The rig takes no commands at present.
    #[error("the rig has not taken earlier commands yet: wait, or stop")]
    Busy,
    /// The rig does not take it.
    #[error("the rig does not take it now: the joints move, or cannot be there")]
    Rig,
}
