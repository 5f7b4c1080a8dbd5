//! Requested motion of a drawing, and of each of its legs.

use tracelight_rig::TICK_F64_S;

use crate::machine::Machine;
use crate::profile::Shape;

/// A dark rest before a stroke, beside the one in which the head settles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wait {
    /// Number of the stroke, from 0.
    pub stroke: usize,
    /// How long, s.
    pub time_s: f64,
}

/// How lit strokes are run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LitSpeed {
    /// As fast as the set speed and the motors allow: from rest to rest at corners and stroke ends, or past them at
    /// speed, whichever is quicker.
    #[default]
    Fastest,
    /// From rest to rest at every corner and stroke end.
    Stops,
    /// At one speed throughout: what the tightest curve permits of the set speed. Every corner and stroke end is passed at
    /// that speed, with dark ways up to it and out of it.
    Exact,
}

impl LitSpeed {
    /// How legs may start and end.
    pub(crate) const fn ends(self) -> &'static [End] {
        match self {
            LitSpeed::Fastest => &End::BOTH,
            LitSpeed::Stops => &[End::Rest],
            LitSpeed::Exact => &[End::Moving],
        }
    }
}

/// How a dark move goes from rest to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DarkMove {
    /// Both joints by one profile of that shape, each over its own distance.
    Shaped(Shape),
    /// As fast as each joint can, limited in jerk, both arriving together ([`crate::steer`]).
    Optimal,
}

/// How a drawing is to be run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanRequest {
    /// Speed of the lit spot on the target, m/s; slower where the motors need it.
    pub speed_m_s: f64,
    /// Whether that is to be kept.
    pub lit_speed: LitSpeed,
    /// The dark moves from rest to rest.
    pub travel: DarkMove,
    /// Time over which the acceleration along a stroke builds up, s.
    pub ramp_s: f64,
    /// Rest before a stroke that begins at rest is lit, s.
    pub settle_s: f64,
    /// Distance from the stroke at which the laser is to be darkened, m.
    pub tolerance_m: f64,
    /// How far corners may be rounded off, m: by so much the line may lie inside of them where that is quicker than to stop
    /// there; at one speed, where they need no slowing down then. Zero keeps all of them sharp, and where a closed stroke
    /// begins it stays sharp anyway.
    pub corner_m: f64,
}

impl PlanRequest {
    /// Rest before a stroke that does not begin where the last one ends, s: to settle, and for the relay to have let go
    /// before it is to hold again.
    pub fn lift_s(&self, machine: &Machine) -> f64 {
        self.settle_s.max(f64::from(relay_ticks(machine)) * TICK_F64_S)
    }

    /// Extends the rise time so that the acceleration can build up within the highest jerk.
    pub(crate) fn within_jerk(&self, machine: &Machine) -> Self {
        Self { ramp_s: self.ramp_s.max(machine.least_ramp_s()), ..*self }
    }

    /// How long the spot runs up to a stroke, s: past the end of the S-curve, and for the relay to have let go before it
    /// is to hold again.
    pub(crate) fn run_up_s(&self, machine: &Machine) -> f64 {
        RUN_UP_S.max(0.5 * self.ramp_s).max(f64::from(relay_ticks(machine)) * TICK_F64_S)
    }

    /// Time over which the acceleration of dark moves under way builds up, s.
    pub(crate) fn swing_rise_s(&self) -> f64 {
        0.5 * self.ramp_s
    }
}

/// From one light to the next at least, ticks.
const fn relay_ticks(machine: &Machine) -> u32 {
    machine.relay_on_ticks + machine.relay_off_ticks + 1
}

/// Shortest run-up, s: on the simulated 2006 rig the error at a stroke's start is no smaller after a longer one.
const RUN_UP_S: f64 = 0.015;

/// How the spot comes to a leg's start, or leaves its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// The spot rests at this end.
    Rest,
    /// The spot passes this end: a dark run-up precedes the start, or a dark run-out follows the end.
    Moving,
}

impl End {
    pub(crate) const BOTH: [End; 2] = [End::Rest, End::Moving];
}

/// How a leg is to be run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MarkRequest {
    /// Set speed, m/s.
    pub(crate) speed_m_s: f64,
    /// Window of the S-curve, s.
    pub(crate) ramp_s: f64,
    /// How long the spot runs up to the leg at even speed, s; half a window at least.
    pub(crate) run_up_s: f64,
    /// How it starts and ends.
    pub(crate) ends: [End; 2],
    /// Number of the stroke, for messages.
    pub(crate) stroke: usize,
}
