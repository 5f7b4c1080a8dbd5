//! How much faster than planned the plan's clock may run.

use tracelight_rig::{Joint, PanTilt, RateLimit, SPEED_RANGE, Segment};

use crate::machine::Machine;
use crate::motion::JointMotion;
use crate::plan::PlanPoint;

/// Steps between the plan's own rate and the most a host may ask for, in which the largest rate of a tick is sought: of 2 %.
const STEPS: u32 = 64;

/// Sets each segment's limit on the rate of the plan's clock: what the motors, joint speeds and accelerations of its ticks allow, and slow enough that the clock
/// comes down in time for what follows.
pub(crate) fn limit_rates(segments: &mut [Segment], points: &[PlanPoint], machine: &Machine) {
    let mut next = 1.0_f32;
    for segment in segments.iter_mut().rev() {
        let ticks = segment.start_tick as usize..=segment.end_tick() as usize;
        let points = points.get(ticks).unwrap_or_default();
        let steps = points.iter().fold(STEPS, |steps, point| most_steps(machine, point, steps));
        let own = rate_of(steps).min(kinematic_rate(machine, segment));
        let fastest = points.iter().map(speed_rad_s).fold(0.0, f64::max) as f32;
        let end = own.min(next);
        let start = own.min(segment.braked_from_squared(end, fastest).sqrt());
        segment.rate_limit = RateLimit { start, end };
        next = start;
    }
}

/// The largest rate at which a segment keeps to the bounds on joint speeds and accelerations between its ticks too; 1 at least.
fn kinematic_rate(machine: &Machine, segment: &Segment) -> f32 {
    const PER_TICK: u32 = 4;
    /// What is left for what lies between the places that are looked at.
    const SHARE: f64 = 0.95;
    let rate = |i: u32| {
        let planned = segment.sample(i as f32 / PER_TICK as f32);
        let of_joint = |j: Joint| {
            let (speed, acceleration) =
                (f64::from(planned[j].velocity_rad_s.abs()), f64::from(planned[j].acceleration_rad_s2.abs()));
            let by_speed = SHARE * machine.speed_limit_rad_s[j] / speed;
            by_speed.min((SHARE * machine.acceleration_limit_rad_s2[j] / acceleration).sqrt())
        };
        of_joint(Joint::Pan).min(of_joint(Joint::Tilt))
    };
    let least = (0..=PER_TICK * u32::from(segment.ticks)).map(rate).fold(f64::from(SPEED_RANGE.1), f64::min);
    least.max(1.0) as f32
}

fn speed_rad_s(point: &PlanPoint) -> f64 {
    point.joints.pan.velocity_rad_s.abs().max(point.joints.tilt.velocity_rad_s.abs())
}

fn rate_of(steps: u32) -> f32 {
    1.0 + (SPEED_RANGE.1 - 1.0) * steps as f32 / STEPS as f32
}

/// The most steps up to so many with which a tick keeps to the limits that it was planned for; none at least.
fn most_steps(machine: &Machine, point: &PlanPoint, most: u32) -> u32 {
    if most == 0 || is_within(machine, point, f64::from(rate_of(most))) {
        return most;
    }
    let (mut within, mut beyond) = (0, most);
    while beyond - within > 1 {
        let middle = within.midpoint(beyond);
        if is_within(machine, point, f64::from(rate_of(middle))) {
            within = middle;
        } else {
            beyond = middle;
        }
    }
    within
}

/// Whether a tick keeps to the limits on torque and acceleration when the clock runs at a rate, and may be changing it. [`kinematic_rate`] bounds the speed.
fn is_within(machine: &Machine, point: &PlanPoint, rate: f64) -> bool {
    let joints = point.joints.map(|joint| JointMotion {
        position_rad: joint.position_rad,
        velocity_rad_s: joint.velocity_rad_s * rate,
        acceleration_rad_s2: joint.acceleration_rad_s2 * rate * rate,
    });
    // torque and acceleration are linear in the change of the rate: what both ends allow, all between do
    [-1.0, 1.0].into_iter().all(|ease| {
        let joints = eased(&joints, &point.joints, ease);
        let share = machine.fraction_of(&joints);
        Joint::BOTH.into_iter().all(|j| {
            share[j].abs() <= machine.torque_share
                && joints[j].acceleration_rad_s2.abs() <= machine.acceleration_limit_rad_s2[j]
        })
    })
}

/// Motion of joints while the rate of the clock rises (1) or falls (−1): each joint in proportion to its planned speed.
fn eased(joints: &PanTilt<JointMotion>, planned: &PanTilt<JointMotion>, ease: f64) -> PanTilt<JointMotion> {
    let fastest = planned.pan.velocity_rad_s.abs().max(planned.tilt.velocity_rad_s.abs());
    if fastest == 0.0 {
        return *joints;
    }
    let ease_per_s = ease * f64::from(tracelight_rig::ease_per_s(fastest as f32));
    PanTilt::from_fn(|j| JointMotion {
        acceleration_rad_s2: joints[j].acceleration_rad_s2 + planned[j].velocity_rad_s * ease_per_s,
        ..joints[j]
    })
}
