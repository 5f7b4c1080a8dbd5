//! Cuts strokes into legs: a corner is passed, rounded, or ends the leg.

use tracelight_maths::{sin, tan};
use tracelight_stroke::{Path, Piece, turn_rad};

use crate::leg::{DUST_M, Fate, LENGTH_TOLERANCE_M, Leg};
use crate::machine::Machine;
use crate::mark::mark;
use crate::request::{End, LitSpeed, MarkRequest, PlanRequest};
use crate::retime::steady_speed;

/// A break of the tangent from which on the head stops: 20°. Below it the spot passes with the speed that keeps the
/// jump of velocity under [`JUMP_M_S`].
const CORNER_RAD: f64 = 0.35;

/// Jump of the spot's velocity at a small break of the tangent, m/s: at 3 ft that is 16 mrad/s, which a 60 rad/s
/// loop makes good with 0.1 mrad (0.1 mm) of error.
const JUMP_M_S: f64 = 0.015;

/// A smaller break than this is none, rad.
const NONE_RAD: f64 = 1e-3;

/// How much of the pieces on either side of a corner is timed to see what rounding it off is worth, m: the way from rest to
/// 1 ft/s on the 2006 rig twice.
const TRIAL_M: f64 = 0.015;

/// A shorter curve is a corner to places that lie half a millimetre apart, m.
const SHORTEST_M: f64 = 2.5e-4;

/// What counts as gained: a tick is lost or won at either end of a trial by where the ticks fall.
const LEAST_GAIN_TICKS: usize = 3;

/// How breaks of the tangent are judged.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corners<'a> {
    machine: &'a Machine,
    request: &'a PlanRequest,
    /// What the motors have for the spot, about, m/s².
    acceleration_m_s2: f64,
}

impl<'a> Corners<'a> {
    pub(crate) fn of(machine: &'a Machine, request: &'a PlanRequest) -> Self {
        Self { machine, request, acceleration_m_s2: machine.spot_acceleration_m_s2() }
    }

    /// The legs of a path in drawing order, cut or rounded off at corners.
    pub(crate) fn legs(&self, path: &Path) -> Vec<Leg> {
        let sized = path.pieces().map(|piece| (piece, piece.length(LENGTH_TOLERANCE_M)));
        let pieces: Vec<(Piece, f64)> = sized.filter(|&(_, length)| length >= DUST_M).collect();
        // a piece may be cut back at both ends, and some of it must be left to tell its direction
        let fate = |pair: &[(Piece, f64)]| {
            let [(before, before_m), (after, after_m)] = [pair[0], pair[1]];
            self.fate(&before, &after, 0.45 * before_m.min(after_m))
        };
        let fates: Vec<Fate> = pieces.windows(2).map(fate).collect();
        Leg::joined(&pieces, &fates)
    }

    /// What becomes of the break between two pieces; no more than `room_m` of either may be given up.
    fn fate(&self, before: &Piece, after: &Piece, room_m: f64) -> Fate {
        let turn = turn_rad(before.end_tangent(), after.start_tangent());
        let passed_m_s = break_speed(turn);
        if turn < NONE_RAD || passed_m_s >= self.request.speed_m_s {
            return Fate::Pass(passed_m_s);
        }
        let exact = self.request.lit_speed == LitSpeed::Exact;
        let sharp = if turn < CORNER_RAD && !exact { Fate::Pass(passed_m_s) } else { Fate::Cut };
        // an arc that touches both lines leaves the corner by d tan(θ/4) and has the radius d / tan(θ/2)
        let cut_m = (self.request.corner_m / tan(0.25 * turn)).min(room_m);
        let rounded_m_s = (self.acceleration_m_s2 * cut_m / tan(0.5 * turn)).max(0.0).sqrt();
        let rounds = match exact {
            true => {
                cut_m > 0.0 && rounded_m_s >= self.request.speed_m_s && self.keeps_speed(before, after, cut_m)
            }
            false => cut_m * turn / tan(0.5 * turn) >= SHORTEST_M && self.gains(before, after, cut_m, sharp),
        };
        if rounds { Fate::Round(cut_m) } else { sharp }
    }

    /// The pieces near a corner that loses so much of both, with their lengths.
    fn near(before: &Piece, after: &Piece, cut_m: f64) -> [(Piece, f64); 2] {
        let lengths = [before, after].map(|piece| piece.length(LENGTH_TOLERANCE_M));
        let near_m = lengths.map(|length| length.min(cut_m + TRIAL_M));
        let before = before.part(lengths[0] - near_m[0], lengths[0], LENGTH_TOLERANCE_M);
        let after = after.part(0.0, near_m[1], LENGTH_TOLERANCE_M);
        [before, after].map(|piece| (piece, piece.length(LENGTH_TOLERANCE_M)))
    }

    /// Whether the motors hold the set speed on a rounded corner.
    fn keeps_speed(&self, before: &Piece, after: &Piece, cut_m: f64) -> bool {
        let legs = Leg::joined(&Self::near(before, after, cut_m), &[Fate::Round(cut_m)]);
        let speed_m_s = self.request.speed_m_s;
        let holds = |leg: &Leg| {
            leg.places(self.machine, speed_m_s)
                .is_ok_and(|all| steady_speed(self.machine, &all).0 >= speed_m_s)
        };
        legs.iter().all(holds)
    }

    /// Whether a corner is passed sooner when it is rounded off: both are timed.
    fn gains(&self, before: &Piece, after: &Piece, cut_m: f64, sharp: Fate) -> bool {
        let near = Self::near(before, after, cut_m);
        let ticks = |legs: Vec<Leg>| -> Option<usize> {
            let last = legs.len() - 1;
            let end = |there: bool| if there { End::Moving } else { End::Rest };
            let timed = legs.iter().enumerate().map(|(i, leg)| {
                let request = MarkRequest {
                    speed_m_s: self.request.speed_m_s,
                    ramp_s: self.request.ramp_s,
                    run_up_s: 0.5 * self.request.ramp_s,
                    ends: [end(i == 0), end(i == last)],
                    stroke: 0,
                };
                mark(self.machine, leg, &request).ok().map(|marked| marked.points.len())
            });
            timed.sum()
        };
        let rounded = ticks(Leg::joined(&near, &[Fate::Round(cut_m)]));
        let sharp = ticks(Leg::joined(&near, &[sharp]));
        matches!((rounded, sharp), (Some(rounded), Some(sharp)) if rounded + LEAST_GAIN_TICKS <= sharp)
    }
}

/// How fast a small break of the tangent is passed, m/s.
fn break_speed(turn_rad: f64) -> f64 {
    JUMP_M_S / (2.0 * sin(0.5 * turn_rad)).max(1e-12)
}
