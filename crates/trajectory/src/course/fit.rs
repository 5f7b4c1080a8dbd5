//! Finds the fastest profile of a given shape that the motors can follow.
//!
//! Run w times as fast, a motion asks of a motor A·w² + D·w + C: inertia and the bend's forces, viscous friction,
//! gravity and Coulomb friction. So at each place the highest w is a root, and the least of them all makes the shape as
//! fast as it can be. Only for shapes with phases something is left to choose, how long each of them is; that is
//! searched for.

use tracelight_rig::PanTilt;

use super::{Course, CourseError, DENSE, Pace};
use crate::error::PlanError;
use crate::profile::limits::MoveLimits;
use crate::profile::{Profile, Shape};
use crate::retime::{PathSample, most_pace};
use crate::travel;

/// Times at which a motion is looked at while its phases are searched for.
const COARSE: usize = 200;

impl Course<'_> {
    /// By the fastest profile of a shape within the limits that the motors can follow: every joint's torque stays within
    /// the share a plan may use, its speed and acceleration within what the rig allows. Where a trapezoid or S-curve
    /// has to give way, how its time is shared out between speeding up, cruising and braking is chosen for the shortest
    /// time.
    ///
    /// # Errors
    /// [`PlanError::TooWeak`] where a motor cannot even hold or start its joint.
    pub fn shaped_for_motors(&self, shape: Shape, limits: &MoveLimits) -> Result<Pace, CourseError> {
        fit(self, shape, limits).map(Pace::shaped)
    }
}

fn fit(course: &Course<'_>, shape: Shape, limits: &MoveLimits) -> Result<Profile, CourseError> {
    let asked = Profile::new(shape, course.length_m(), limits);
    let dense = DENSE.max(course.samples.len());
    if fastest_pace(course, &asked, dense)? >= 1.0 {
        return Ok(asked);
    }
    let shares = match shape {
        Shape::Ramped(_) => best_shares(course, shape, limits)?,
        _ => [0.5, 0.5],
    };
    let profile = Profile::unit(shape, shares).over(course.length_m());
    let fitted = profile.lasting(shortest_s(course, &profile, limits, dense)?);
    if fitted.duration_s().is_finite() { Ok(fitted) } else { Err(too_weak(course).into()) }
}

/// The shortest time in which a motion of one second can be made within limits and motors.
fn shortest_s(
    course: &Course<'_>,
    profile: &Profile,
    limits: &MoveLimits,
    count: usize,
) -> Result<f64, CourseError> {
    let peaks = profile.peaks();
    let pace = fastest_pace(course, profile, count)?
        .min(limits.speed / peaks.speed)
        .min((limits.acceleration / peaks.acceleration).sqrt())
        .min((limits.deceleration / peaks.deceleration).sqrt());
    Ok(1.0 / pace)
}

/// How many times as fast the motors can follow a motion.
fn fastest_pace(course: &Course<'_>, profile: &Profile, count: usize) -> Result<f64, CourseError> {
    let mut pace = f64::INFINITY;
    for t_s in Pace::shaped(*profile).times_s(count) {
        let at = profile.at(t_s);
        let (_, joints) = course.joints_at(at.position)?;
        let sample = PathSample { s: at.position, joints, cap: f64::INFINITY };
        pace = pace.min(most_pace(course.machine, &sample, at.velocity, at.acceleration));
    }
    Ok(pace)
}

/// How much of its time a motion had best speed up and brake: a grid, then steps from its best point, halved until
/// they no longer matter.
fn best_shares(course: &Course<'_>, shape: Shape, limits: &MoveLimits) -> Result<[f64; 2], CourseError> {
    const GRID: u32 = 10;
    const FINEST: f64 = 1e-5;
    let duration = |shares: [f64; 2]| {
        let profile = Profile::unit(shape, shares).over(course.length_m());
        shortest_s(course, &profile, limits, COARSE)
    };
    let on_grid = |i: u32| (f64::from(i) + 0.5) / f64::from(GRID);
    let mut best = ([0.5, 0.5], duration([0.5, 0.5])?);
    for shares in (0..GRID).flat_map(|i| (0..GRID - i).map(move |k| [on_grid(i), on_grid(k)])) {
        better(&mut best, within_one(shares), &duration)?;
    }
    let mut step = 0.5 / f64::from(GRID);
    while step > FINEST {
        let [up, down] = best.0;
        let around = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (1.0, -1.0), (-1.0, 1.0)];
        let mut moved = false;
        for (along, across) in around {
            moved |= better(&mut best, within_one([up + step * along, down + step * across]), &duration)?;
        }
        if !moved {
            step *= 0.5;
        }
    }
    Ok(best.0)
}

fn better(
    best: &mut ([f64; 2], f64),
    shares: [f64; 2],
    duration: &dyn Fn([f64; 2]) -> Result<f64, CourseError>,
) -> Result<bool, CourseError> {
    let duration_s = duration(shares)?;
    // what rounding makes of equals is no gain
    let is_better = duration_s < (1.0 - 1e-12) * best.1;
    if is_better {
        *best = (shares, duration_s);
    }
    Ok(is_better)
}

/// Both phases at least a little long, and together not more than all.
fn within_one([up, down]: [f64; 2]) -> [f64; 2] {
    const LEAST: f64 = 1e-3;
    let (up, down) = (up.clamp(LEAST, 1.0 - LEAST), down.clamp(LEAST, 1.0 - LEAST));
    let most = (up + down).max(1.0);
    [up / most, down / most]
}

fn too_weak(course: &Course<'_>) -> PlanError {
    let at = course.samples.first().map_or(PanTilt::new(0.0, 0.0), |sample| sample.joints.angle_rad);
    travel::too_weak(course.machine, at)
}
