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
    /// Forget where the joints are.
    Unhome,
    /// Turn the head in the dark along a job's way, from where it rests. It may not be homed.
    Jog(Job),
    /// Let a head that is not homed let out dots, wherever it is turned, until it is homed. Somebody armed before.
    Seek,
    /// Let out a dot of light for so many ticks where the head rests: on the way of a job that paused, or while its zero is sought. The light's budget
    /// may make it shorter.
    Mark(u16),
    /// Allow the next job to light. It is forgotten after [`ARMED_TICKS`](crate::ARMED_TICKS).
    Arm,
    /// Take that back; of a dot, end it.
    Disarm,
    /// Trace a job from its beginning.
    Trace(Job),
    /// Darken, return to zero, and trace this one instead, armed as the one before was, or by who armed just now.
    Next(Job),
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
            Self::Unhome => "unhome",
            Self::Jog(_) => "jog",
            Self::Seek => "seek",
            Self::Mark(_) => "mark",
            Self::Arm => "arm",
            Self::Disarm => "disarm",
            Self::Trace(_) => "trace",
            Self::Next(_) => "next",
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
    /// The head is where the job begins, and moves.
    #[error("the head moves: wait until it rests")]
    Moving,
    /// The speed is out of its bounds.
    #[error("a speed of {asked} is not between {} and {}", SPEED_RANGE.0, SPEED_RANGE.1)]
    Speed {
        /// What was asked.
        asked: f32,
    },
    /// At this speed the light of the job would stand for too long somewhere.
    #[error("at {:.0} % the light would stand in one place for too long: this drawing is traced at {:.0} % at least", 100.0 * .asked, 100.0 * .least)]
    Slow {
        /// What was asked.
        asked: f32,
        /// The lowest speed.
        least: f32,
    },
    /// The rig takes no commands at present.
    #[error("the rig has not taken earlier commands yet: wait, or stop")]
    Busy,
    /// The rig does not take it.
    #[error("the rig does not take it now: the joints move, or cannot be there")]
    Rig,
}

/// What may be asked in a state.
pub(crate) const fn advice(state: State) -> &'static str {
    match state {
        State::Unhomed => "home the head first; jog it, or arm and seek",
        State::Homing => "home it, or stop",
        State::Jogging => "wait until it rests, or stop",
        State::Marking => "wait until the dot is out, or stop",
        State::Ready | State::Done => "arm, then trace",
        State::Armed => "trace or resume, or disarm",
        State::Tracing
        | State::Stepping
        | State::Pointing
        | State::Framing
        | State::Returning
        | State::Pausing => "pause or stop it first",
        State::Paused => "resume, stop or park",
        State::Stopped => "arm and resume, or park",
        State::Parking => "wait until it is at zero",
        State::Fault => "clear the fault first",
        State::Lost => "connect the rig again",
    }
}

/// Speeds that one goes through who hurries or slows a job, as multiples of the plan's.
const SPEEDS: [f32; 9] = [0.1, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0];
/// The next higher of the speeds that one goes through who hurries a job.
#[must_use]
pub fn faster(speed: f32) -> f32 {
    SPEEDS.into_iter().find(|&next| next > speed + 1e-3).unwrap_or(SPEEDS[SPEEDS.len() - 1])
}

/// The next lower one.
#[must_use]
pub fn slower(speed: f32) -> f32 {
    SPEEDS.into_iter().rev().find(|&next| next < speed - 1e-3).unwrap_or(SPEEDS[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_go_up_and_down_and_end() {
        assert_eq!([faster(1.0), faster(0.3), faster(2.0)], [1.25, 0.5, 2.0]);
        assert_eq!([slower(1.0), slower(0.3), slower(0.1)], [0.75, 0.25, 0.1]);
    }
}
