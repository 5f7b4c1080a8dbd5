use tracelight_rig::{FaultRecord, TICK_F64_S};

use crate::request::Refused;
use crate::state::State;

/// Ticks as seconds.
pub fn seconds(ticks: u32) -> f64 {
    f64::from(ticks) * TICK_F64_S
}

/// What happened.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// The state changed.
    State {
        /// Tick of the rig.
        tick: u32,
        /// The state before.
        from: State,
        /// The state now.
        to: State,
    },
    /// A stroke begins.
    Stroke {
        /// Tick of the rig.
        tick: u32,
        /// Number of the stroke, from 0.
        stroke: u32,
        /// How many there are.
        of: u32,
    },
    /// A job that was to be next did not begin.
    NotBegun {
        /// Tick of the rig.
        tick: u32,
        /// Why not.
        why: Refused,
    },
    /// A fault was latched.
    Fault(FaultRecord),
}

/// Where a session stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Snapshot {
    /// What it does.
    pub state: State,
    /// Tick of the rig.
    pub tick: u32,
    /// Whether the rig knows where it points.
    pub homed: bool,
    /// Whether the gate is open.
    pub gate: bool,
    /// Speed of the plan's clock that is asked for, as a multiple of the plan's own.
    pub speed: f32,
    /// Where the plan's clock stands, ticks; 0 without a job.
    pub plan_tick: u32,
    /// Length of the job, ticks; 0 without one.
    pub plan_ticks: u32,
    /// Number of the stroke that is drawn or comes next, from 0; `None` without a job, or after its last.
    pub stroke: Option<u32>,
    /// How many strokes the drawing has.
    pub strokes: u32,
    /// How often a job that is done again and again was done.
    pub laps: u32,
    /// Ticks for which it stays armed.
    pub armed_ticks: u32,
}
