use tracelight_rig::{Joint, PanTilt, TICK_F64_S};

use crate::plan::JointMotion;
use crate::profile::{MoveLimits, Profile};
use crate::{Machine, PlanError, Shape};

/// A dark move that takes longer means that a motor can hardly hold its joint, s.
const LONGEST_S: f64 = 60.0;

/// A shorter way is none, rad.
const NOTHING_RAD: f64 = 1e-9;

/// Whether there is no way from one pose to the other.
pub(crate) fn touches(from: PanTilt<f64>, to: PanTilt<f64>) -> bool {
    let span = |j: Joint| (to[j] - from[j]).abs();
    span(Joint::Pan).max(span(Joint::Tilt)) < NOTHING_RAD
}

/// Both joints tick by tick along a dark move from rest to rest, the start left out, the end included.
///
/// The joints are synchronised: each covers its own distance with the same profile of the shared parameter from 0
/// to 1. Its limits are what the motors have left after friction, gravity and coupling at any place of the move,
/// found by shrinking them until a check of the torque of every tick passes.
pub(crate) fn travel(
    machine: &Machine,
    shape: Shape,
    from: PanTilt<f64>,
    to: PanTilt<f64>,
) -> Result<Vec<PanTilt<JointMotion>>, PlanError> {
    if touches(from, to) {
        return Ok(Vec::new());
    }
    let span = PanTilt::new(to.pan - from.pan, to.tilt - from.tilt);
    let mut limits = first_limits(machine, from, span)?;
    // each round takes at least 3 % off: 200 rounds are a factor of 400, and 20 in time
    for _ in 0..200 {
        let profile = Profile::new(shape, 1.0, &limits);
        if !profile.duration_s().is_finite() || profile.duration_s() > LONGEST_S {
            break;
        }
        let motion = sample(&profile, from, span);
        let worst = worst_fractions(machine, &motion, limits.acceleration);
        if worst.speeding_up <= machine.torque_share && worst.braking <= machine.torque_share {
            return Ok(motion);
        }
        limits.acceleration *= shrink(machine.torque_share, worst.speeding_up);
        limits.deceleration *= shrink(machine.torque_share, worst.braking);
    }
    Err(too_weak(machine, from))
}

/// About how long such a move takes, s; what gravity and coupling cost is left out.
pub(crate) fn travel_estimate_s(
    machine: &Machine,
    shape: Shape,
    from: PanTilt<f64>,
    to: PanTilt<f64>,
) -> f64 {
    let span = PanTilt::new(to.pan - from.pan, to.tilt - from.tilt);
    match first_limits(machine, from, span) {
        Ok(limits) if limits.speed < f64::MAX => Profile::new(shape, 1.0, &limits).duration_s(),
        Ok(_) => 0.0,
        Err(_) => LONGEST_S,
    }
}

fn shrink(allowed: f64, got: f64) -> f64 {
    if got <= allowed { 1.0 } else { (allowed / got).clamp(0.5, 0.97) }
}

/// Limits of the shared parameter from what each motor has at the start, friction helping to brake; optimistic about
/// gravity.
fn first_limits(machine: &Machine, from: PanTilt<f64>, span: PanTilt<f64>) -> Result<MoveLimits, PlanError> {
    let mut limits = MoveLimits { speed: f64::MAX, acceleration: f64::MAX, deceleration: f64::MAX };
    for joint in Joint::BOTH {
        let share = span[joint].abs();
        if share < NOTHING_RAD {
            continue;
        }
        let inertia = machine.own_inertia(joint, from.tilt);
        let coulomb = machine.friction[joint].torque(span[joint].signum() * 1e-9).abs();
        let helped = machine.lumped.gravity(from.tilt)[joint].abs();
        let torque = machine.torque_share * machine.motors[joint].torque_limit_nm() + helped;
        let wish = machine.acceleration_limit_rad_s2[joint];
        let least = |now: f64, new: f64| now.min(new / share);
        limits.speed = least(limits.speed, machine.speed_limit_rad_s[joint]);
        limits.acceleration = least(limits.acceleration, ((torque - coulomb) / inertia).min(wish));
        limits.deceleration = least(limits.deceleration, ((torque + coulomb) / inertia).min(wish));
    }
    let possible = limits.acceleration > 0.0 && limits.deceleration > 0.0;
    if possible { Ok(limits) } else { Err(too_weak(machine, from)) }
}

pub(crate) fn too_weak(machine: &Machine, at: PanTilt<f64>) -> PlanError {
    let gravity = machine.lumped.gravity(at.tilt);
    let need = |j: Joint| gravity[j].abs() + machine.friction[j].coulomb_pos_nm;
    let have = |j: Joint| machine.torque_share * machine.motors[j].torque_limit_nm();
    let tilt_is_worse = need(Joint::Tilt) / have(Joint::Tilt) > need(Joint::Pan) / have(Joint::Pan);
    let joint = if tilt_is_worse { Joint::Tilt } else { Joint::Pan };
    PlanError::TooWeak { joint, needed_nm: need(joint), available_nm: have(joint) }
}

fn sample(profile: &Profile, from: PanTilt<f64>, span: PanTilt<f64>) -> Vec<PanTilt<JointMotion>> {
    let ticks = (profile.duration_s() / TICK_F64_S).ceil() as usize;
    let point = |tick: usize| {
        let p = profile.at(tick as f64 * TICK_F64_S);
        PanTilt::from_fn(|j| JointMotion {
            position_rad: from[j] + span[j] * p.position,
            velocity_rad_s: span[j] * p.velocity,
            acceleration_rad_s2: span[j] * p.acceleration,
        })
    };
    (1..=ticks.max(1)).map(point).collect()
}

/// Largest shares of the motors' torque in each half of a move.
struct Worst {
    speeding_up: f64,
    braking: f64,
}

fn worst_fractions(machine: &Machine, motion: &[PanTilt<JointMotion>], acceleration: f64) -> Worst {
    let mut worst = Worst { speeding_up: 0.0, braking: 0.0 };
    let floor = 1e-6 * acceleration;
    for joints in motion {
        let fraction = machine.fraction_of(joints).map(f64::abs);
        let most = fraction.pan.max(fraction.tilt);
        let push = |j: Joint| joints[j].acceleration_rad_s2 * joints[j].velocity_rad_s;
        let sense = push(Joint::Pan) + push(Joint::Tilt);
        if sense >= -floor {
            worst.speeding_up = most.max(worst.speeding_up);
        }
        if sense <= floor {
            worst.braking = most.max(worst.braking);
        }
    }
    worst
}
