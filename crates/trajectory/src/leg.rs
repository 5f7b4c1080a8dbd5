//! Legs: parts of a stroke without a corner.

use tracelight_aim::{AimError, JointPath, SpotMotion};
use tracelight_maths::sin_cos;
use tracelight_stroke::{PathPoint, Piece, Point};

use crate::machine::Machine;
use crate::plan::LegEnd;
use crate::retime::PathSample;
use crate::rounding::rounding;

/// Shorter pieces than this are dust, m.
pub(crate) const DUST_M: f64 = 1e-7;

/// Most places at which a leg is looked at: 50 m at the finest.
const MOST_PLACES: f64 = 1e5;

/// Error of arc length on curves, m: a ten-thousandth of what the spot moves in a tick at 1 ft/s.
pub(crate) const LENGTH_TOLERANCE_M: f64 = 3e-8;

/// What becomes of a break of the tangent between two pieces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fate {
    /// The corner is passed, no faster than this, m/s.
    Pass(f64),
    /// So much of both pieces, m, gives way to a curve from one to the other.
    Round(f64),
    /// One leg ends there and another begins.
    Cut,
}

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
    /// Legs of pieces, each with its length, that are joined by what becomes of the breaks between them.
    pub(crate) fn joined(pieces: &[(Piece, f64)], fates: &[Fate]) -> Vec<Leg> {
        let cut_m = |fate: Option<&Fate>| if let Some(&Fate::Round(cut_m)) = fate { cut_m } else { 0.0 };
        let mut legs: Vec<Leg> = Vec::new();
        for (i, &(piece, length)) in pieces.iter().enumerate() {
            let before = i.checked_sub(1).and_then(|last| fates.get(last));
            let (from, to) = (cut_m(before), length - cut_m(fates.get(i)));
            let piece =
                if (from, to) == (0.0, length) { piece } else { piece.part(from, to, LENGTH_TOLERANCE_M) };
            match (before, legs.last_mut()) {
                (Some(&Fate::Pass(speed)), Some(leg)) => {
                    leg.breaks.push((leg.length_m(), speed));
                    leg.push(piece, to - from);
                }
                (Some(Fate::Round(_)), Some(leg)) => {
                    if let Some(last) = leg.pieces.last() {
                        let curve = rounding(last, &piece);
                        leg.push(curve, curve.length(LENGTH_TOLERANCE_M));
                    }
                    leg.push(piece, to - from);
                }
                _ => {
                    legs.push(Leg { pieces: vec![piece], starts_m: vec![0.0, to - from], breaks: Vec::new() })
                }
            }
        }
        legs
    }

    /// Appends a piece, if anything is left of it.
    fn push(&mut self, piece: Piece, length: f64) {
        if length >= DUST_M {
            self.starts_m.push(self.length_m() + length);
            self.pieces.push(piece);
        }
    }

    pub(crate) fn length_m(&self) -> f64 {
        self.starts_m.last().copied().unwrap_or(0.0)
    }

    /// The rest at its end, at a tick, of a spot that began at another.
    pub(crate) fn rest_at_end(&self, start_tick: u32, tick: u32) -> LegEnd {
        let length_m = self.length_m();
        let end = self.at(length_m);
        LegEnd { tick, start_tick, point: end.point, tangent: end.tangent, length_m }
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

    /// Places before its start and after its end, up to where the spot is so many seconds before and after at a speed; as
    /// far as they are in reach.
    pub(crate) fn around(&self, machine: &Machine, speed_m_s: f64, times_s: [f64; 2]) -> Vec<PathSample> {
        let steps = (1..=8).map(|i| f64::from(i) / 8.0 * speed_m_s);
        let ways = steps.flat_map(|way| [-way * times_s[0], self.length_m() + way * times_s[1]]);
        let place =
            |s: f64| Some(PathSample { s, joints: self.aim(machine, &self.at(s)).ok()?, cap: speed_m_s });
        ways.filter_map(place).collect()
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

/// A place `by_m` further along the circle of curvature.
fn onwards(at: PathPoint, by_m: f64) -> PathPoint {
    if by_m == 0.0 {
        return at;
    }
    let per_radius = at.tangent.cross(at.curvature);
    let angle = per_radius * by_m;
    let (sin, cos) = sin_cos(angle);
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
    use tracelight_maths::planar;
    use tracelight_stroke::{Element, Path};

    use super::*;

    fn pieces(path: &Path) -> Vec<(Piece, f64)> {
        path.pieces().map(|piece| (piece, piece.length(LENGTH_TOLERANCE_M))).collect()
    }

    #[test]
    fn pieces_that_are_passed_make_one_leg_and_cuts_part_them() {
        let corners = [(0.0, 0.0), (0.1, 0.0), (0.1, 0.1), (0.0, 0.1)].map(|(x, y)| Point::new(x, y));
        let square = pieces(&Path::polyline(&corners, true).unwrap());
        let fates = [Fate::Cut, Fate::Pass(0.2), Fate::Round(0.01)];
        let legs = Leg::joined(&square, &fates);
        assert_eq!(legs.len(), 2);
        assert_eq!(legs[1].breaks, [(0.1, 0.2)]);
        // the arc of 10 mm is shorter than the corner it replaces
        let with_arc = 0.3 - 0.02 + 0.01 * std::f64::consts::FRAC_PI_2;
        assert!((legs[1].length_m() - with_arc).abs() < 1e-5, "{}", legs[1].length_m());
        for i in 0..=280 {
            let (at, on) = (legs[1].at(1e-3 * f64::from(i)), legs[1].at(1e-3 * f64::from(i) + 1e-7));
            assert!(at.point.distance(on.point) < 1.01e-7);
        }
    }

    #[test]
    fn a_leg_goes_on_along_its_circle_beyond_its_ends() {
        let mut circle = Path::new(Point::new(0.1, 0.0));
        for _ in 0..2 {
            circle.push(Element::Arc { centre: Point::ORIGIN, sweep: std::f64::consts::FRAC_PI_2 });
        }
        let legs = Leg::joined(&pieces(&circle), &[Fate::Pass(f64::INFINITY)]);
        assert_eq!(legs.len(), 1);
        let length = 0.1 * std::f64::consts::PI;
        assert!((legs[0].length_m() - length).abs() < 1e-12);
        for (s, angle) in [
            (-0.01, -0.1),
            (0.5 * length, 0.5 * std::f64::consts::PI),
            (length + 0.02, std::f64::consts::PI + 0.2),
        ] {
            let at = legs[0].at(s);
            let arm = planar::direction(angle) * 0.1;
            assert!((at.point.to_vec2() - arm).hypot() < 1e-12, "{s}: {at:?}");
            assert!((at.tangent - planar::direction(angle).turn_90()).hypot() < 1e-12, "{s}: {at:?}");
            assert!((at.curvature + arm * 100.0).hypot() < 1e-9, "{s}: {at:?}");
        }
    }
}
