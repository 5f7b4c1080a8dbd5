//! Moves of one coordinate from rest to rest: closed forms.

use std::f64::consts::PI;

/// How long the acceleration builds up and fades, as shares of the acceleration phase (`pa`) and of the
/// deceleration phase (`pb`); all zero is a trapezoid of velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ramps {
    /// Build-up of acceleration, share of its phase.
    pub pa1: f64,
    /// Fading of acceleration.
    pub pa2: f64,
    /// Build-up of deceleration, share of its phase.
    pub pb1: f64,
    /// Fading of deceleration.
    pub pb2: f64,
}

impl Ramps {
    /// A trapezoid.
    pub const NONE: Self = Self { pa1: 0.0, pa2: 0.0, pb1: 0.0, pb2: 0.0 };
    /// The report's S-curve.
    pub const REPORT: Self = Self { pa1: 0.20, pa2: 0.20, pb1: 0.15, pb2: 0.15 };
}

/// Shape of the velocity over time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Constant acceleration, cruise, constant deceleration; with ramps an S-curve.
    Ramped(Ramps),
    /// Half a sine of velocity: x = (d/2)(1 − cos πt/T).
    Sine,
    /// Logistic position, cut where 1 % of it is missing at either end and rescaled to the whole distance.
    Sigmoid,
}

/// What a move may do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoveLimits {
    /// Highest speed, unit/s.
    pub speed: f64,
    /// Highest acceleration, unit/s².
    pub acceleration: f64,
    /// Highest deceleration, unit/s²; shapes that are symmetric keep to the smaller of the two.
    pub deceleration: f64,
}

/// Place, speed and acceleration at one time of a move.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MovePoint {
    /// From the start, unit.
    pub position: f64,
    /// unit/s.
    pub velocity: f64,
    /// unit/s².
    pub acceleration: f64,
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
    Sine,
    Sigmoid,
}

/// Seven phases of constant jerk; a trapezoid's ramps have no length.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Phases {
    /// Acceleration phase, cruise, deceleration phase, s.
    accelerate_s: f64,
    cruise_s: f64,
    decelerate_s: f64,
    peak_speed: f64,
    ramps: Ramps,
}

/// Missing share at either end of a sigmoid.
const SIGMOID_CUT: f64 = 0.01;

/// Steepness of the cut logistic over its whole length: σ(−k/2) = [`SIGMOID_CUT`].
fn sigmoid_steepness() -> f64 {
    2.0 * (1.0 / SIGMOID_CUT - 1.0).ln()
}

impl Profile {
    /// The fastest move of that shape over `distance` > 0 within the limits, all > 0.
    pub fn new(shape: Shape, distance: f64, limits: &MoveLimits) -> Self {
        let gentle = limits.acceleration.min(limits.deceleration);
        match shape {
            Shape::Ramped(ramps) => Self::ramped(distance, limits, ramps),
            // peak velocity (π/2)d/T, peak acceleration (π²/2)d/T²
            Shape::Sine => Self::smooth(
                Curve::Sine,
                distance,
                PI / 2.0 * distance / limits.speed,
                PI * (distance / (2.0 * gentle)).sqrt(),
            ),
            // peak of σ′ is 1/4, of σ″ 1/(6√3)
            Shape::Sigmoid => {
                let k = sigmoid_steepness();
                let spread = distance / (1.0 - 2.0 * SIGMOID_CUT);
                Self::smooth(
                    Curve::Sigmoid,
                    distance,
                    k / 4.0 * spread / limits.speed,
                    k * (spread / (6.0 * 3f64.sqrt() * gentle)).sqrt(),
                )
            }
        }
    }

    fn smooth(curve: Curve, distance: f64, by_speed_s: f64, by_acceleration_s: f64) -> Self {
        Self { distance, duration_s: by_speed_s.max(by_acceleration_s), curve }
    }

    /// Ramps scale with their phase, so both phases' lengths are proportional to the peak speed v: the distance
    /// without cruise is v²(cₐ/(a kₐ) + c_b/(d k_b)), k mean over peak acceleration, c mean over peak velocity.
    fn ramped(distance: f64, limits: &MoveLimits, ramps: Ramps) -> Self {
        let ka = 1.0 - 0.5 * (ramps.pa1 + ramps.pa2);
        let kb = 1.0 - 0.5 * (ramps.pb1 + ramps.pb2);
        let up = 1.0 / (limits.acceleration * ka);
        let down = 1.0 / (limits.deceleration * kb);
        let (ca, cb) = (mean_speed(ramps.pa1, ramps.pa2), mean_speed(ramps.pb2, ramps.pb1));
        let ramp_distance_per_v2 = ca * up + cb * down;
        let peak_speed = (distance / ramp_distance_per_v2).sqrt().min(limits.speed);
        let cruise_s = (distance / peak_speed - peak_speed * ramp_distance_per_v2).max(0.0);
        let phases = Phases {
            accelerate_s: peak_speed * up,
            cruise_s,
            decelerate_s: peak_speed * down,
            peak_speed,
            ramps,
        };
        let duration_s = phases.accelerate_s + cruise_s + phases.decelerate_s;
        Self { distance, duration_s, curve: Curve::Ramped(phases) }
    }

    /// Length of the move, s.
    pub const fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// Highest speed of the move, unit/s.
    pub fn peak_speed(&self) -> f64 {
        match self.curve {
            Curve::Ramped(p) => p.peak_speed,
            Curve::Sine | Curve::Sigmoid => self.at(0.5 * self.duration_s).velocity,
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
            Curve::Sine => self.sine_at(t_s),
            Curve::Sigmoid => self.sigmoid_at(t_s),
        }
    }

    fn sine_at(&self, t_s: f64) -> MovePoint {
        let w = PI / self.duration_s;
        let (s, c) = (w * t_s).sin_cos();
        let half = 0.5 * self.distance;
        MovePoint { position: half * (1.0 - c), velocity: half * w * s, acceleration: half * w * w * c }
    }

    fn sigmoid_at(&self, t_s: f64) -> MovePoint {
        let w = sigmoid_steepness() / self.duration_s;
        let y = 1.0 / (1.0 + (-w * (t_s - 0.5 * self.duration_s)).exp());
        let scale = self.distance / (1.0 - 2.0 * SIGMOID_CUT);
        let slope = y * (1.0 - y);
        MovePoint {
            position: scale * (y - SIGMOID_CUT),
            velocity: scale * w * slope,
            acceleration: scale * w * w * slope * (1.0 - 2.0 * y),
        }
    }
}

impl Phases {
    fn at(&self, t_s: f64, distance: f64) -> MovePoint {
        let braking = self.accelerate_s + self.cruise_s;
        if t_s < self.accelerate_s {
            return speed_up(t_s, self.accelerate_s, self.peak_speed, self.ramps.pa1, self.ramps.pa2);
        }
        if t_s < braking {
            let reached = mean_speed(self.ramps.pa1, self.ramps.pa2) * self.peak_speed * self.accelerate_s;
            let position = reached + self.peak_speed * (t_s - self.accelerate_s);
            return MovePoint { position, velocity: self.peak_speed, acceleration: 0.0 };
        }
        // braking is speeding up in a mirror: time and place counted from the end
        let left = braking + self.decelerate_s - t_s;
        let mirrored = speed_up(left, self.decelerate_s, self.peak_speed, self.ramps.pb2, self.ramps.pb1);
        MovePoint {
            position: distance - mirrored.position,
            velocity: mirrored.velocity,
            acceleration: -mirrored.acceleration,
        }
    }
}

/// From rest to `speed` in `length_s`, the acceleration building up over the share `p1` and fading over `p2`.
fn speed_up(t: f64, length_s: f64, speed: f64, p1: f64, p2: f64) -> MovePoint {
    let peak = speed / (length_s * (1.0 - 0.5 * (p1 + p2)));
    let (t1, t3) = (p1 * length_s, p2 * length_s);
    let t2 = length_s - t1 - t3;
    if t < t1 {
        let jerk = peak / t1;
        return MovePoint {
            position: jerk * t * t * t / 6.0,
            velocity: 0.5 * jerk * t * t,
            acceleration: jerk * t,
        };
    }
    let (x1, v1) = (peak * t1 * t1 / 6.0, 0.5 * peak * t1);
    let u = (t - t1).min(t2);
    let (x2, v2) = (x1 + v1 * u + 0.5 * peak * u * u, v1 + peak * u);
    let w = t - t1 - t2;
    if w <= 0.0 || t3 == 0.0 {
        return MovePoint { position: x2, velocity: v2, acceleration: peak };
    }
    let jerk = peak / t3;
    MovePoint {
        position: x2 + v2 * w + 0.5 * peak * w * w - jerk * w * w * w / 6.0,
        velocity: v2 + peak * w - 0.5 * jerk * w * w,
        acceleration: peak - jerk * w,
    }
}

/// Mean speed of [`speed_up`] over its peak speed.
fn mean_speed(p1: f64, p2: f64) -> f64 {
    speed_up(1.0, 1.0, 1.0, p1, p2).position
}

#[cfg(test)]
mod tests {
    use super::*;

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
            let shape = [TRAPEZOID, Shape::Ramped(ramps), Shape::Sine, Shape::Sigmoid][round % 4];
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
        assert!((place - profile.distance).abs() < 2e-3 * profile.distance, "{profile:?}: {place}");
        let end = profile.at(profile.duration_s() * (1.0 - 1e-12)).position;
        let cut = if profile.curve == Curve::Sigmoid { 1e-9 } else { 1e-6 };
        assert!((end - profile.distance).abs() <= cut * profile.distance.max(1.0), "{profile:?}: {end}");
    }
}
