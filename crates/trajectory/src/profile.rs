//! Moves of one coordinate from rest to rest: closed forms.

pub(crate) mod limits;
mod ramped;
mod smooth;

use tracelight_maths::powi;

use crate::move_point::MovePoint;
use limits::{MoveLimits, Peaks};
use ramped::Phases;
pub use ramped::Ramps;
use smooth::Unit;

/// Shape of the velocity over time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Constant acceleration, cruise, constant deceleration; with ramps an S-curve.
    Ramped(Ramps),
    /// Half a sine of velocity: x = (d/2)(1 − cos πt/T). The acceleration jumps at both ends.
    Sine,
    /// A whole sine of acceleration, a raised cosine of velocity: x = d(t/T − sin(2πt/T)/2π).
    Cycloid,
    /// Logistic position, cut where 1 % of it is missing at either end and rescaled to the whole distance: it starts
    /// and ends with a jump of the speed.
    Sigmoid,
    /// The polynomial of fifth degree with speed and acceleration zero at both ends.
    Quintic,
}

/// A move of a positive distance, fully determined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    distance: f64,
    duration_s: f64,
    curve: Curve,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Curve {
    Ramped(Phases),
    Smooth(Unit),
}

impl Profile {
    /// The fastest move of that shape over `distance` > 0 within the limits, all > 0.
    pub fn new(shape: Shape, distance: f64, limits: &MoveLimits) -> Self {
        match shape {
            Shape::Ramped(ramps) => Self::ramped(distance, Phases::fastest(distance, limits, ramps)),
            Shape::Sine => Self::smooth(Unit::Sine, distance, limits),
            Shape::Cycloid => Self::smooth(Unit::Cycloid, distance, limits),
            Shape::Sigmoid => Self::smooth(Unit::Sigmoid, distance, limits),
            Shape::Quintic => Self::smooth(Unit::Quintic, distance, limits),
        }
    }

    /// Over one unit of way in one of time. Of a ramped shape's time, acceleration and deceleration take `shares`, not
    /// more than one together; other shapes have no phases.
    pub(crate) fn unit(shape: Shape, shares: [f64; 2]) -> Self {
        let even = MoveLimits { speed: f64::MAX, acceleration: 1.0, deceleration: 1.0 };
        let profile = match shape {
            Shape::Ramped(ramps) => Self::ramped(1.0, Phases::of_shares(1.0, ramps, shares)),
            _ => Self::new(shape, 1.0, &even),
        };
        profile.lasting(1.0)
    }

    fn ramped(distance: f64, phases: Phases) -> Self {
        Self { distance, duration_s: phases.duration_s(), curve: Curve::Ramped(phases) }
    }

    fn smooth(unit: Unit, distance: f64, limits: &MoveLimits) -> Self {
        let peaks = unit.peaks();
        let gentle = limits.acceleration.min(limits.deceleration);
        let by_speed_s = peaks.velocity * distance / limits.speed;
        let by_acceleration_s = (peaks.acceleration * distance / gentle).sqrt();
        Self { distance, duration_s: by_speed_s.max(by_acceleration_s), curve: Curve::Smooth(unit) }
    }

    /// Rescales the move to another duration, s.
    pub(crate) fn lasting(&self, duration_s: f64) -> Self {
        let curve = match self.curve {
            Curve::Ramped(phases) => Curve::Ramped(phases.slower(duration_s / self.duration_s)),
            smooth @ Curve::Smooth(_) => smooth,
        };
        Self { duration_s, curve, ..*self }
    }

    /// Rescales the move to another distance.
    pub(crate) fn over(&self, distance: f64) -> Self {
        let curve = match self.curve {
            Curve::Ramped(phases) => Curve::Ramped(phases.longer(distance / self.distance)),
            smooth @ Curve::Smooth(_) => smooth,
        };
        Self { distance, curve, ..*self }
    }

    /// Length of the move, s.
    pub const fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// Highest speed of the move, unit/s.
    pub fn peak_speed(&self) -> f64 {
        self.peaks().speed
    }

    /// The most of its derivatives.
    pub fn peaks(&self) -> Peaks {
        match self.curve {
            Curve::Ramped(phases) => phases.peaks(),
            Curve::Smooth(unit) => {
                let (most, per_s) = (unit.peaks(), 1.0 / self.duration_s);
                let acceleration = most.acceleration * self.distance * per_s * per_s;
                Peaks {
                    speed: most.velocity * self.distance * per_s,
                    acceleration,
                    deceleration: acceleration,
                    jerk: (!unit.starts_hard()).then_some(most.jerk * self.distance * powi(per_s, 3)),
                    speed_jump: unit.at(0.0).velocity * self.distance * per_s,
                }
            }
        }
    }

    /// Times within the move at which its acceleration may jump, s.
    pub(crate) fn breaks_s(&self) -> [f64; 2] {
        match self.curve {
            Curve::Ramped(phases) => phases.breaks_s(),
            Curve::Smooth(_) => [0.0, self.duration_s],
        }
    }

    /// Where the move is at time `t_s`; before it starts at its start, after its end at its end.
    pub fn at(&self, t_s: f64) -> MovePoint {
        if t_s <= 0.0 {
            return MovePoint::default();
        }
        if t_s >= self.duration_s {
            return MovePoint { position: self.distance, ..MovePoint::default() };
        }
        match self.curve {
            Curve::Ramped(phases) => phases.at(t_s, self.distance),
            Curve::Smooth(unit) => {
                let per_s = 1.0 / self.duration_s;
                let at = unit.at(t_s * per_s);
                MovePoint {
                    position: self.distance * at.position,
                    velocity: self.distance * per_s * at.velocity,
                    acceleration: self.distance * per_s * per_s * at.acceleration,
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use std::f64::consts::PI;

    const SEED: MoveLimits = MoveLimits { speed: 24.0, acceleration: 100.0, deceleration: 100.0 };
    const FEASIBLE: MoveLimits = MoveLimits { speed: 5.0, acceleration: 4.0, deceleration: 1.0 };
    const S_CURVE: Shape = Shape::Ramped(Ramps::REPORT);
    const TRAPEZOID: Shape = Shape::Ramped(Ramps::NONE);

    fn check(shape: Shape, limits: &MoveLimits, duration_s: f64, peak_speed: f64) {
        let profile = Profile::new(shape, PI, limits);
        assert!((profile.duration_s() - duration_s).abs() < 6e-5, "{}", profile.duration_s());
        assert!((profile.peak_speed() - peak_speed).abs() < 6e-3, "{}", profile.peak_speed());
    }

    #[test]
    fn half_a_turn_takes_what_the_report_says() {
        check(TRAPEZOID, &SEED, 0.3545, 17.72);
        check(S_CURVE, &SEED, 0.390461, 16.09);
        check(Shape::Sine, &SEED, 0.3937, 12.53);
        check(Shape::Cycloid, &SEED, 0.4443, 14.14);
        check(Shape::Quintic, &SEED, 0.4259, 13.83);
        check(TRAPEZOID, &FEASIBLE, 2.8025, 2.242);
        check(S_CURVE, &FEASIBLE, 3.0587, 2.054);
    }

    #[test]
    fn a_sigmoid_keeps_to_the_acceleration_after_rescaling() {
        // unrescaled it would be 0.5053 s; rescaling by 1/0.98 stretches that by 1/√0.98
        check(Shape::Sigmoid, &SEED, 0.5053 / 0.98f64.sqrt(), 14.43);
    }

    #[test]
    fn every_shape_obeys_its_limits_and_its_own_derivatives() {
        let mut dice = oorandom::Rand64::new(7);
        for round in 0..400 {
            let mut draw = |low: f64, high: f64| low + (high - low) * dice.rand_float();
            let limits = MoveLimits {
                speed: draw(0.1, 30.0),
                acceleration: draw(0.5, 100.0),
                deceleration: draw(0.5, 100.0),
            };
            let ramps =
                Ramps { pa1: draw(0.0, 0.5), pa2: draw(0.0, 0.5), pb1: draw(0.0, 0.5), pb2: draw(0.0, 0.5) };
            let shape = [
                TRAPEZOID,
                Shape::Ramped(ramps),
                Shape::Sine,
                Shape::Cycloid,
                Shape::Sigmoid,
                Shape::Quintic,
            ][round % 6];
            obeys(&Profile::new(shape, draw(1e-3, 4.0), &limits), &limits);
        }
    }

    fn obeys(profile: &Profile, limits: &MoveLimits) {
        const STEPS: usize = 2000;
        let h = profile.duration_s() / STEPS as f64;
        let mut place = 0.0;
        for i in 0..STEPS {
            let p = profile.at((i as f64 + 0.5) * h);
            assert!(-1e-12 <= p.velocity && p.velocity <= limits.speed * (1.0 + 1e-9), "{profile:?}");
            assert!(p.acceleration <= limits.acceleration * (1.0 + 1e-9), "{profile:?}");
            assert!(-p.acceleration <= limits.deceleration * (1.0 + 1e-9), "{profile:?}");
            place += p.velocity * h;
        }
        peaks_are_what_is_seen(profile);
        assert!((place - profile.distance).abs() < 2e-3 * profile.distance, "{profile:?}: {place}");
        let end = profile.at(profile.duration_s() * (1.0 - 1e-12)).position;
        let cut = if profile.curve == Curve::Smooth(Unit::Sigmoid) { 1e-9 } else { 1e-6 };
        assert!((end - profile.distance).abs() <= cut * profile.distance.max(1.0), "{profile:?}: {end}");
    }

    fn peaks_are_what_is_seen(profile: &Profile) {
        const STEPS: usize = 4000;
        let points: Vec<MovePoint> =
            (1..STEPS).map(|i| profile.at(i as f64 / STEPS as f64 * profile.duration_s())).collect();
        let most = |value: &dyn Fn(&MovePoint) -> f64| points.iter().map(value).fold(0.0, f64::max);
        let peaks = profile.peaks();
        let near = |seen: f64, said: f64| {
            assert!(seen <= said * (1.0 + 1e-9) && seen > 0.98 * said, "{profile:?}: {seen} {said}");
        };
        near(most(&|p| p.velocity), peaks.speed);
        near(most(&|p| p.acceleration), peaks.acceleration);
        near(most(&|p| -p.acceleration), peaks.deceleration);
        if let Some(jerk) = peaks.jerk {
            let h = profile.duration_s() / STEPS as f64;
            let steepest = points.windows(2).map(|w| (w[1].acceleration - w[0].acceleration).abs() / h);
            let seen = steepest.fold(0.0, f64::max);
            // a ramp may be shorter than a step
            let least = if matches!(profile.curve, Curve::Smooth(_)) { 0.9 * jerk } else { 0.0 };
            assert!(seen <= jerk * (1.0 + 1e-6) && seen > least, "{profile:?}: {seen} {jerk}");
        }
        assert!(
            (profile.at(1e-9 * profile.duration_s()).velocity - peaks.speed_jump).abs() < 1e-6 * peaks.speed
        );
    }

    #[test]
    fn a_jump_of_the_acceleration_has_no_jerk() {
        let jerk = |shape| Profile::new(shape, PI, &SEED).peaks().jerk;
        assert_eq!([TRAPEZOID, Shape::Sine, Shape::Sigmoid].map(jerk), [None; 3]);
        assert_eq!(jerk(Shape::Ramped(Ramps { pa1: 0.0, ..Ramps::REPORT })), None);
        // the report's: 100 rad/s² over 0.15 of the deceleration phase
        assert!((jerk(S_CURVE).unwrap() - 3521.0).abs() < 1.0);
        assert!((jerk(Shape::Quintic).unwrap() - 60.0 * PI / 0.4259f64.powi(3)).abs() < 3.0);
    }

    #[test]
    fn another_time_and_distance_make_the_same_shape() {
        for shape in [S_CURVE, Shape::Quintic] {
            let profile = Profile::new(shape, PI, &FEASIBLE);
            let other = profile.over(2.0).lasting(1.5);
            for i in 0..=20 {
                let share = f64::from(i) / 20.0;
                let (a, b) = (profile.at(share * profile.duration_s()), other.at(share * 1.5));
                assert!((a.position / PI - b.position / 2.0).abs() < 1e-12);
                let per = profile.duration_s() / 1.5 * 2.0 / PI;
                assert!((a.velocity * per - b.velocity).abs() < 1e-12);
            }
        }
    }
}
