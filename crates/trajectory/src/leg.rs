//! Strokes cut into legs: stretches without a corner, each run from rest to rest.

use tracelight_aim::{AimError, JointPath, SpotMotion};
use tracelight_stroke::{Path, PathPoint, Piece, Point};

use crate::Machine;
use crate::retime::PathSample;

/// A break of the tangent from which on the head stops: 20°. Below it the spot passes with the speed that keeps the
/// jump of velocity under [`JUMP_M_S`].
const CORNER_RAD: f64 = 0.35;

/// Jump of the spot's velocity at a small break of the tangent, m/s: at 3 ft that is 16 mrad/s, which a 60 rad/s
/// loop makes good with 0.1 mrad (0.1 mm) of error.
const JUMP_M_S: f64 = 0.015;

/// Shorter pieces than this are dust, m.
const DUST_M: f64 = 1e-7;

/// Most places at which a leg is looked at: 50 m at the finest.
const MOST_PLACES: f64 = 1e5;

/// Error of arc length on curves, m: a ten-thousandth of what the spot moves in a tick at 1 ft/s.
const LENGTH_TOLERANCE_M: f64 = 3e-8;

/// A stretch of a stroke without a corner, with arc length along it.
#[derive(Clone, Debug)]
pub(crate) struct Leg {
    pieces: Vec<Piece>,
    /// Arc length at the start of each piece, and at the end of the last, m.
    starts_m: Vec<f64>,
    /// Places with a small break of the tangent, and the speed at which to pass them: (m, m/s).
    breaks: Vec<(f64, f64)>,
}

impl Leg {
    /// The legs of a path in drawing order, cut at corners, and where a break of the tangent would have to be passed
    /// slower than `slowest_m_s`.
    pub(crate) fn split(path: &Path, slowest_m_s: f64) -> Vec<Leg> {
        let mut legs: Vec<Leg> = Vec::new();
        let mut incoming = None;
        for piece in path.pieces() {
            let length = piece.length(LENGTH_TOLERANCE_M);
            if length < DUST_M {
                continue;
            }
            let turn = incoming.map(|t: tracelight_stroke::Vec2| {
                let out = piece.start_tangent();
                t.cross(out).atan2(t.dot(out)).abs()
            });
            match (turn, legs.last_mut()) {
                (Some(turn), Some(leg)) if turn < CORNER_RAD && break_speed(turn) >= slowest_m_s => {
                    leg.extend(piece, length, turn)
                }
                _ => legs.push(Leg { pieces: vec![piece], starts_m: vec![0.0, length], breaks: Vec::new() }),
            }
            incoming = Some(piece.end_tangent());
        }
        legs
    }

    fn extend(&mut self, piece: Piece, length: f64, turn: f64) {
        let at = self.length_m();
        self.breaks.push((at, break_speed(turn)));
        self.pieces.push(piece);
        self.starts_m.push(at + length);
    }

    pub(crate) fn length_m(&self) -> f64 {
        self.starts_m.last().copied().unwrap_or(0.0)
    }

    /// Place, tangent and curvature at arc length `s_m`; beyond an end the leg goes on along the circle it follows
    /// there, so that whoever runs up to it or out of it feels no jerk.
    pub(crate) fn at(&self, s_m: f64) -> PathPoint {
        let within = s_m.clamp(0.0, self.length_m());
        onwards(self.within(within), s_m - within)
    }

    fn within(&self, s_m: f64) -> PathPoint {
        let index = self.starts_m.partition_point(|&start| start <= s_m).clamp(1, self.pieces.len()) - 1;
        let (start, end) = (self.starts_m[index], self.starts_m[index + 1]);
        let within = (s_m - start).clamp(0.0, end - start);
        self.pieces[index].at_length(within, LENGTH_TOLERANCE_M)
    }

    /// Places along the leg, at most `step_m` apart and at least `fewest` steps: all ends of its pieces twice, for
    /// the curvature may jump there, and every place once. Nowhere faster than `speed_m_s`, nor at a break of the
    /// tangent than that allows.
    pub(crate) fn samples(
        &self,
        machine: &Machine,
        speed_m_s: f64,
        (step_m, fewest): (f64, f64),
    ) -> Result<Vec<PathSample>, AimError> {
        let step_m = step_m.min(self.length_m() / fewest).max(self.length_m() / MOST_PLACES);
        let mut samples = Vec::with_capacity((self.length_m() / step_m) as usize + 2 * self.pieces.len());
        for (piece, ends) in self.pieces.iter().zip(self.starts_m.windows(2)) {
            let length = ends[1] - ends[0];
            let count = (length / step_m).ceil().max(1.0);
            for i in 0..=count as usize {
                let within = length * i as f64 / count;
                let joints = self.aim(machine, &piece.at_length(within, LENGTH_TOLERANCE_M))?;
                samples.push(PathSample { s: ends[0] + within, joints, cap: speed_m_s });
            }
        }
        for &(at_m, speed) in &self.breaks {
            let at_break = |sample: &&mut PathSample| (sample.s - at_m).abs() < DUST_M;
            samples.iter_mut().filter(at_break).for_each(|sample| sample.cap = sample.cap.min(speed));
        }
        Ok(samples)
    }

    /// The place at arc length `s_m`, with the joint angles there and their derivatives by arc length.
    pub(crate) fn joints_at(&self, machine: &Machine, s_m: f64) -> Result<(Point, JointPath), AimError> {
        let at = self.at(s_m);
        Ok((at.point, self.aim(machine, &at)?))
    }

    fn aim(&self, machine: &Machine, at: &PathPoint) -> Result<JointPath, AimError> {
        let spot = SpotMotion { point: at.point, velocity: at.tangent, acceleration: at.curvature };
        machine.geometry.motion(&machine.pose, &spot)
    }
}

/// How fast a small break of the tangent is passed, m/s.
fn break_speed(turn: f64) -> f64 {
    JUMP_M_S / (2.0 * (0.5 * turn).sin()).max(1e-12)
}

/// A place `by_m` further along the circle of curvature.
fn onwards(at: PathPoint, by_m: f64) -> PathPoint {
    if by_m == 0.0 {
        return at;
    }
    let per_radius = at.tangent.cross(at.curvature);
    let angle = per_radius * by_m;
    let (sin, cos) = angle.sin_cos();
    let normal = at.tangent.turn_90();
    // sin x / x and (1 − cos x) / x
    let (along, aside) =
        if angle.abs() < 1e-6 { (1.0, 0.5 * angle) } else { (sin / angle, (1.0 - cos) / angle) };
    let tangent = at.tangent * cos + normal * sin;
    PathPoint {
        point: at.point + at.tangent * (along * by_m) + normal * (aside * by_m),
        tangent,
        curvature: tangent.turn_90() * per_radius,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_stroke::Element;

    #[test]
    fn a_square_has_four_legs_and_a_circle_one() {
        let corners = [(0.0, 0.0), (0.1, 0.0), (0.1, 0.1), (0.0, 0.1)].map(|(x, y)| Point::new(x, y));
        let square = Path::polyline(&corners, true).unwrap();
        assert_eq!(Leg::split(&square, 0.0).len(), 4);
        let mut circle = Path::new(Point::new(0.1, 0.0));
        for _ in 0..4 {
            circle.push(Element::Arc { centre: Point::ORIGIN, sweep: std::f64::consts::FRAC_PI_2 });
        }
        circle.close();
        let legs = Leg::split(&circle, 0.0);
        assert_eq!(legs.len(), 1);
        assert!((legs[0].length_m() - 0.2 * std::f64::consts::PI).abs() < 1e-12);
        let halfway = legs[0].at(0.1 * std::f64::consts::PI).point;
        assert!(halfway.distance(Point::new(-0.1, 0.0)) < 1e-12);
    }

    #[test]
    fn a_small_break_limits_the_speed_instead_of_cutting() {
        let points = [(0.0, 0.0), (0.1, 0.0), (0.2, 0.01)].map(|(x, y)| Point::new(x, y));
        let legs = Leg::split(&Path::polyline(&points, false).unwrap(), 0.0);
        assert_eq!(legs.len(), 1);
        let (at, speed) = legs[0].breaks[0];
        assert!((at - 0.1).abs() < 1e-12 && (speed - 0.1505).abs() < 1e-3, "{speed}");
    }
}
