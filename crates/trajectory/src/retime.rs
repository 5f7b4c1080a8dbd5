//! Speed along a leg: as fast as asked, as slow as the motors need, from rest to rest.
//!
//! With s the arc length, x = ṡ² and u = s̈, every motor's torque is linear, τ = a u + b x + c, so at each place of a
//! grid the possible (x, u) form a convex polygon. A backward pass finds the largest x from which the rest of the
//! leg can still be followed, a forward pass takes the largest u that stays under it (reachability analysis; Pham &
//! Pham, *A New Approach to Time-Optimal Path Parameterization*, IEEE T-RO 2018, §III).

use tracelight_aim::JointPath;
use tracelight_rig::{Joint, PanTilt};

use crate::leg::Leg;
use crate::{Machine, PlanError};

/// Distance of grid places, m, and their least number on a leg.
const GRID_M: f64 = 5e-4;
const FEWEST: f64 = 16.0;
/// A bound on their number: 50 m at the finest.
const MOST: f64 = 1e5;

/// p x + q u ≤ r.
#[derive(Clone, Copy, Debug)]
struct HalfPlane {
    p: f64,
    q: f64,
    r: f64,
}

/// What is possible at one place of the grid.
#[derive(Clone, Debug)]
struct Place {
    limits: Vec<HalfPlane>,
    /// Bound on x from speeds.
    x_most: f64,
}

/// Speed profile of a leg: x at every place of an even grid, u constant between two.
#[derive(Clone, Debug)]
pub(crate) struct Grid {
    places: Vec<Place>,
    step_m: f64,
}

impl Grid {
    /// Samples a leg and what the motors can do along it. `stroke` is for messages.
    pub(crate) fn new(
        machine: &Machine,
        leg: &Leg,
        speed_m_s: f64,
        stroke: usize,
    ) -> Result<Self, PlanError> {
        let length = leg.length_m();
        let count = (length / GRID_M).ceil().clamp(FEWEST, MOST);
        let step_m = length / count;
        let place = |i: usize| {
            let (_, joints) = leg
                .joints_at(machine, i as f64 * step_m)
                .map_err(|source| PlanError::Aim { stroke, source })?;
            place_limits(machine, &joints, speed_m_s)
        };
        let places = (0..=count as usize).map(place).collect::<Result<Vec<_>, _>>()?;
        let mut grid = Self { places, step_m };
        for &(at_m, speed) in leg.breaks() {
            grid.cap(at_m, step_m, speed * speed);
        }
        Ok(grid)
    }

    /// Bounds x near a place.
    pub(crate) fn cap(&mut self, at_m: f64, reach_m: f64, x: f64) {
        let (first, last) = self.range(at_m, reach_m);
        for place in &mut self.places[first..=last] {
            place.x_most = place.x_most.min(x);
        }
    }

    fn range(&self, at_m: f64, reach_m: f64) -> (usize, usize) {
        let last = self.places.len() - 1;
        let index = |s: f64| (s / self.step_m).clamp(0.0, last as f64);
        (index(at_m - reach_m).floor() as usize, index(at_m + reach_m).ceil() as usize)
    }

    /// The fastest possible x at every place, zero at both ends.
    pub(crate) fn fastest(&self) -> Vec<f64> {
        let ceiling = self.controllable();
        let mut x = vec![0.0; ceiling.len()];
        for i in 0..ceiling.len() - 1 {
            let most = self.largest_next(&self.places[i], x[i], ceiling[i + 1]);
            x[i + 1] = most.clamp(0.0, ceiling[i + 1]);
        }
        x
    }

    /// Largest x at every place from which the end can still be reached at rest.
    fn controllable(&self) -> Vec<f64> {
        let last = self.places.len() - 1;
        let mut ceiling = vec![0.0; last + 1];
        for i in (0..last).rev() {
            ceiling[i] = self.largest_here(&self.places[i], ceiling[i + 1]);
        }
        ceiling
    }

    /// max x with some u such that all limits hold and 0 ≤ x + 2Δu ≤ next.
    fn largest_here(&self, place: &Place, next: f64) -> f64 {
        let twice = 2.0 * self.step_m;
        let mut planes = place.limits.clone();
        planes.push(HalfPlane { p: 1.0, q: twice, r: next });
        planes.push(HalfPlane { p: -1.0, q: -twice, r: 0.0 });
        planes.push(HalfPlane { p: 1.0, q: 0.0, r: place.x_most });
        largest_x(&planes)
    }

    /// The x at the next place for the largest u possible at `x` here.
    fn largest_next(&self, place: &Place, x: f64, next: f64) -> f64 {
        let twice = 2.0 * self.step_m;
        let mut u = (next - x) / twice;
        for plane in place.limits.iter().filter(|p| p.q > 0.0) {
            u = u.min((plane.r - plane.p * x) / plane.q);
        }
        x + twice * u
    }

    pub(crate) const fn step_m(&self) -> f64 {
        self.step_m
    }
}

/// The largest x of the polygon, 0 if it is empty: the optimum of a linear program lies where two edges meet, and
/// with a dozen edges trying every pair is the simplest exact method.
fn largest_x(planes: &[HalfPlane]) -> f64 {
    let mut best: f64 = 0.0;
    for (i, a) in planes.iter().enumerate() {
        for b in &planes[i + 1..] {
            let det = a.p * b.q - b.p * a.q;
            if det.abs() < 1e-12 {
                continue;
            }
            let x = (a.r * b.q - b.r * a.q) / det;
            let u = (a.p * b.r - b.p * a.r) / det;
            let slack = 1e-9 * (1.0 + x.abs() + u.abs());
            if x > best && planes.iter().all(|h| h.p * x + h.q * u <= h.r + slack) {
                best = x;
            }
        }
    }
    best
}

fn place_limits(machine: &Machine, joints: &JointPath, speed_m_s: f64) -> Result<Place, PlanError> {
    let tilt = joints.angle_rad.tilt;
    let gravity = machine.lumped.gravity(tilt);
    let mass = machine.lumped.mass(tilt);
    let along = mass.times(joints.first);
    let bent = mass.times(joints.second);
    let swing = machine.lumped.bias(tilt, joints.first);
    let mut limits = Vec::with_capacity(12);
    let mut x_most = speed_m_s * speed_m_s;
    for j in Joint::BOTH {
        let torque = machine.torque_share * machine.motors[j].torque_limit_nm();
        let (a, b) = (along[j], bent[j] + swing[j] - gravity[j]);
        // the joint never turns faster than its limit, however fast the spot may be asked to go
        let limit = machine.speed_limit_rad_s[j];
        let fastest = (joints.first[j] * speed_m_s).max(-limit).min(limit);
        for friction in friction_range(machine, j, fastest) {
            let c = gravity[j] + friction;
            if c.abs() >= torque {
                return Err(PlanError::TooWeak { joint: j, needed_nm: c.abs(), available_nm: torque });
            }
            band(&mut limits, b, a, -torque - c, torque - c);
        }
        let wish = machine.acceleration_limit_rad_s2[j];
        band(&mut limits, joints.second[j], joints.first[j], -wish, wish);
        let rate = machine.speed_limit_rad_s[j] / joints.first[j].abs().max(1e-12);
        x_most = x_most.min(rate * rate);
    }
    Ok(Place { limits, x_most })
}

/// low ≤ p x + q u ≤ high.
fn band(limits: &mut Vec<HalfPlane>, p: f64, q: f64, low: f64, high: f64) {
    limits.push(HalfPlane { p, q, r: high });
    limits.push(HalfPlane { p: -p, q: -q, r: -low });
}

/// Friction torques to reckon with: one where the joint's direction is clear, both where it turns round.
fn friction_range(machine: &Machine, joint: Joint, rate_rad_s: f64) -> Vec<f64> {
    const TURNING_RAD_S: f64 = 0.01;
    let friction = &machine.friction[joint];
    if rate_rad_s.abs() > TURNING_RAD_S {
        vec![friction.torque(rate_rad_s)]
    } else {
        vec![friction.torque(TURNING_RAD_S), friction.torque(-TURNING_RAD_S)]
    }
}

/// Place, speed and acceleration along a leg over time, rounded into an S: the mean of the fastest motion over a
/// window of `ramp_s` behind. Averaging a motion whose acceleration jumps gives one whose acceleration is
/// continuous, with jerk at most the jump over the window.
#[derive(Clone, Debug)]
pub(crate) struct TimeLaw {
    /// Time at each place of the grid, s.
    times_s: Vec<f64>,
    /// √x there, m/s.
    speeds: Vec<f64>,
    /// ∫ s dt up to there, m s.
    integrals: Vec<f64>,
    step_m: f64,
    ramp_s: f64,
}

impl TimeLaw {
    pub(crate) fn new(x: &[f64], step_m: f64, ramp_s: f64) -> Self {
        let speeds: Vec<f64> = x.iter().map(|x| x.max(0.0).sqrt()).collect();
        let mut law = Self { times_s: vec![0.0], speeds, integrals: vec![0.0], step_m, ramp_s };
        for i in 0..law.speeds.len() - 1 {
            // a grid cell entered and left at rest cannot be crossed; the passes never leave one
            let mean = 0.5 * (law.speeds[i] + law.speeds[i + 1]);
            let time = step_m / mean.max(1e-9);
            law.times_s.push(law.times_s[i] + time);
            let integral = law.integrals[i] + law.cell(i, time).0;
            law.integrals.push(integral);
        }
        law
    }

    pub(crate) fn duration_s(&self) -> f64 {
        self.fast_duration_s() + self.ramp_s
    }

    fn fast_duration_s(&self) -> f64 {
        self.times_s.last().copied().unwrap_or(0.0)
    }

    /// Integral, place and speed of the fastest motion `t` after entering cell `i`.
    fn cell(&self, i: usize, t: f64) -> (f64, f64, f64) {
        let (v0, v1) = (self.speeds[i], self.speeds[i + 1]);
        let u = (v1 * v1 - v0 * v0) / (2.0 * self.step_m);
        let s0 = i as f64 * self.step_m;
        (s0 * t + v0 * t * t / 2.0 + u * t * t * t / 6.0, s0 + v0 * t + 0.5 * u * t * t, v0 + u * t)
    }

    /// Integral, place and speed of the fastest motion at time `t`; at rest before and after.
    fn fast(&self, t: f64) -> (f64, f64, f64) {
        let (end, last) = (self.fast_duration_s(), self.speeds.len() - 1);
        if t <= 0.0 {
            return (0.0, 0.0, 0.0);
        }
        if t >= end {
            let length = last as f64 * self.step_m;
            return (self.integrals[last] + length * (t - end), length, 0.0);
        }
        let i = self.times_s.partition_point(|&start| start <= t).clamp(1, last) - 1;
        let (integral, place, speed) = self.cell(i, t - self.times_s[i]);
        (self.integrals[i] + integral, place, speed)
    }

    /// Arc length, speed and acceleration at time `t`.
    pub(crate) fn at(&self, t: f64) -> Along {
        let (now, then) = (self.fast(t), self.fast(t - self.ramp_s));
        let mean = |a: f64, b: f64| (a - b) / self.ramp_s;
        Along { s: mean(now.0, then.0), v: mean(now.1, then.1), a: mean(now.2, then.2) }
    }
}

/// Motion along the path: m, m/s, m/s².
#[derive(Clone, Copy, Debug)]
pub(crate) struct Along {
    pub(crate) s: f64,
    pub(crate) v: f64,
    pub(crate) a: f64,
}

/// Joint motion of a spot that moves along a leg: q̇ = q′ṡ, q̈ = q″ṡ² + q′s̈.
pub(crate) fn chain(joints: &JointPath, along: &Along) -> (PanTilt<f64>, PanTilt<f64>) {
    let rate = joints.first.map(|d| d * along.v);
    let acceleration = PanTilt::from_fn(|j| joints.second[j] * along.v * along.v + joints.first[j] * along.a);
    (rate, acceleration)
}
