//! Profiles of seven phases with constant jerk: trapezoids and S-curves of velocity.

use super::limits::{MoveLimits, Peaks};
use crate::move_point::MovePoint;

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

    /// Mean over peak acceleration.
    fn mean_acceleration(&self) -> f64 {
        1.0 - 0.5 * (self.pa1 + self.pa2)
    }

    /// Mean over peak deceleration.
    fn mean_deceleration(&self) -> f64 {
        1.0 - 0.5 * (self.pb1 + self.pb2)
    }

    /// Mean speeds of both phases, over the peak speed.
    fn mean_speeds(&self) -> [f64; 2] {
        [mean_speed(self.pa1, self.pa2), mean_speed(self.pb2, self.pb1)]
    }
}

/// Seven phases of constant jerk; a trapezoid's ramps have no length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Phases {
    /// Acceleration phase, cruise, deceleration phase, s.
    accelerate_s: f64,
    cruise_s: f64,
    decelerate_s: f64,
    pub(super) peak_speed: f64,
    ramps: Ramps,
}

impl Phases {
    /// Ramps scale with their phase, so both phases' lengths are proportional to the peak speed v: the distance
    /// without cruise is v²(cₐ/(a kₐ) + c_b/(d k_b)), k mean over peak acceleration, c mean over peak velocity.
    pub(super) fn fastest(distance: f64, limits: &MoveLimits, ramps: Ramps) -> Self {
        let up = 1.0 / (limits.acceleration * ramps.mean_acceleration());
        let down = 1.0 / (limits.deceleration * ramps.mean_deceleration());
        let [ca, cb] = ramps.mean_speeds();
        let ramp_distance_per_v2 = ca * up + cb * down;
        let peak_speed = (distance / ramp_distance_per_v2).sqrt().min(limits.speed);
        let cruise_s = (distance / peak_speed - peak_speed * ramp_distance_per_v2).max(0.0);
        let (accelerate_s, decelerate_s) = (peak_speed * up, peak_speed * down);
        Self { accelerate_s, cruise_s, decelerate_s, peak_speed, ramps }
    }

    /// Over `distance` in one unit of time, of which the acceleration and the deceleration phase take these shares.
    pub(super) fn of_shares(distance: f64, ramps: Ramps, [accelerate_s, decelerate_s]: [f64; 2]) -> Self {
        let cruise_s = (1.0 - accelerate_s - decelerate_s).max(0.0);
        let [ca, cb] = ramps.mean_speeds();
        let peak_speed = distance / (ca * accelerate_s + cruise_s + cb * decelerate_s);
        Self { accelerate_s, cruise_s, decelerate_s, peak_speed, ramps }
    }

    pub(super) fn duration_s(&self) -> f64 {
        self.accelerate_s + self.cruise_s + self.decelerate_s
    }

    /// Stretches the duration by `factor` over an unchanged distance.
    pub(super) fn slower(&self, factor: f64) -> Self {
        Self {
            accelerate_s: factor * self.accelerate_s,
            cruise_s: factor * self.cruise_s,
            decelerate_s: factor * self.decelerate_s,
            peak_speed: self.peak_speed / factor,
            ramps: self.ramps,
        }
    }

    /// `factor` times the way in the same time.
    pub(super) fn longer(&self, factor: f64) -> Self {
        Self { peak_speed: factor * self.peak_speed, ..*self }
    }

    pub(super) fn peaks(&self) -> Peaks {
        let Ramps { pa1, pa2, pb1, pb2 } = self.ramps;
        let acceleration = self.peak_speed / (self.accelerate_s * self.ramps.mean_acceleration());
        let deceleration = self.peak_speed / (self.decelerate_s * self.ramps.mean_deceleration());
        let jerks = [
            acceleration / (pa1 * self.accelerate_s),
            acceleration / (pa2 * self.accelerate_s),
            deceleration / (pb1 * self.decelerate_s),
            deceleration / (pb2 * self.decelerate_s),
        ];
        let jerk = jerks.into_iter().fold(0.0, f64::max);
        Peaks {
            speed: self.peak_speed,
            acceleration,
            deceleration,
            jerk: jerk.is_finite().then_some(jerk),
            speed_jump: 0.0,
        }
    }

    /// When the acceleration may jump.
    pub(super) fn breaks_s(&self) -> [f64; 2] {
        [self.accelerate_s, self.accelerate_s + self.cruise_s]
    }

    pub(super) fn at(&self, t_s: f64, distance: f64) -> MovePoint {
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
