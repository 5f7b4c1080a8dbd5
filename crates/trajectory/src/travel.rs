use tracelight_maths::{cbrt, powi};
use tracelight_rig::{Joint, PanTilt, TICK_F64_S};

use crate::error::PlanError;
use crate::machine::Machine;
use crate::motion::JointMotion;
use crate::profile::limits::MoveLimits;
use crate::profile::{Profile, Shape};

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
    let mut slower = 1.0;
    for round in 0..ROUNDS {
        let profile = Profile::new(shape, 1.0, &limits);
        let profile = profile.lasting(slower * profile.duration_s());
        if !profile.duration_s().is_finite() || profile.duration_s() > LONGEST_S {
            break;
        }
        let motion = sample(&profile, from, span);
        let excess = Excess::of(machine, &motion, span);
        if excess.speeding_up <= 0.0 && excess.braking <= 0.0 {
            let jerk = worst_jerk(machine, from, &motion);
            if jerk <= 1.0 {
                return Ok(motion);
            }
            // jerk goes with the third power of the time; between ticks, where the acceleration jumps, with the second
            slower *= cbrt(jerk).max(1.002);
            continue;
        }
        let least = least_shrink(round);
        limits.acceleration *= kept_share(limits.acceleration, excess.speeding_up, least);
        limits.deceleration *= kept_share(limits.deceleration, excess.braking, least);
    }
    Err(too_weak(machine, from))
}

/// Largest share of the highest jerk on a move that begins at rest.
fn worst_jerk(machine: &Machine, from: PanTilt<f64>, motion: &[PanTilt<JointMotion>]) -> f64 {
    let start = from.map(JointMotion::at_rest);
    let befores = std::iter::once(&start).chain(motion);
    let shares = befores.zip(motion).map(|(before, after)| machine.jerk_share(before, after));
    shares.map(|share| share.pan.max(share.tilt)).fold(0.0, f64::max)
}

/// Each round takes what is too much off a limit, and at least this share of it, more with every round: 200 rounds are a
/// factor of 400 at least.
pub(crate) const ROUNDS: usize = 200;

/// See [`ROUNDS`].
pub(crate) fn least_shrink(round: usize) -> f64 {
    const FIRST: f64 = 0.002;
    const MOST: f64 = 0.03;
    (FIRST * powi(1.5, round.min(10) as i32)).min(MOST)
}

/// What is left of a limit that is too high by `excess`, as a share of it: half at least.
pub(crate) fn kept_share(limit: f64, excess: f64, least_shrink: f64) -> f64 {
    if excess <= 0.0 { 1.0 } else { (1.0 - excess / limit).clamp(0.5, 1.0 - least_shrink) }
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

/// Limits of the shared parameter from what each motor has at the start, friction helping to brake; optimistic about
/// gravity.
fn first_limits(machine: &Machine, from: PanTilt<f64>, span: PanTilt<f64>) -> Result<MoveLimits, PlanError> {
    let mut limits = MoveLimits { speed: f64::MAX, acceleration: f64::MAX, deceleration: f64::MAX };
    for joint in Joint::BOTH {
        let share = span[joint].abs();
        if share < NOTHING_RAD {
            continue;
        }
        let coulomb = machine.friction[joint].torque(span[joint].signum() * 1e-9).abs();
        let helped = machine.lumped.gravity(from.tilt)[joint].abs();
        let torque = machine.usable_nm(joint) + helped;
        let most = |torque_nm: f64| machine.acceleration_rad_s2(joint, from.tilt, torque_nm);
        let least = |now: f64, new: f64| now.min(new / share);
        limits.speed = least(limits.speed, machine.speed_limit_rad_s[joint]);
        limits.acceleration = least(limits.acceleration, most(torque - coulomb));
        limits.deceleration = least(limits.deceleration, most(torque + coulomb));
    }
    let possible = limits.acceleration > 0.0 && limits.deceleration > 0.0;
    if possible { Ok(limits) } else { Err(too_weak(machine, from)) }
}

pub(crate) fn too_weak(machine: &Machine, at: PanTilt<f64>) -> PlanError {
    let gravity = machine.lumped.gravity(at.tilt);
    let need = |j: Joint| gravity[j].abs() + machine.friction[j].coulomb_pos_nm;
    let have = |j: Joint| machine.usable_nm(j);
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

/// A joint that takes less torque for each of the parameter's acceleration is not what asks too much, N m s².
const LEAST_NM_S2: f64 = 1e-9;

/// How much too high the acceleration of the shared parameter is in each half of a move, 1/s².
struct Excess {
    speeding_up: f64,
    braking: f64,
}

impl Excess {
    fn of(machine: &Machine, motion: &[PanTilt<JointMotion>], span: PanTilt<f64>) -> Self {
        let mut excess = Self { speeding_up: 0.0, braking: 0.0 };
        for joints in motion {
            let fraction = machine.fraction_of(joints).map(f64::abs);
            // torque goes with the acceleration of the parameter, and with its speed's square, which goes with it too
            let (mass, swing) = machine.lumped.mass_and_bias(joints.tilt.position_rad, span);
            let along = mass.times(span);
            let too_much = |j: Joint| {
                let torque = (fraction[j] - machine.torque_share) * machine.motors[j].torque_limit_nm();
                torque / (along[j].abs() + swing[j].abs()).max(LEAST_NM_S2)
            };
            let most = too_much(Joint::Pan).max(too_much(Joint::Tilt));
            // the joints go together: one tells for both
            let leading = if span.pan.abs() >= span.tilt.abs() { Joint::Pan } else { Joint::Tilt };
            let sense = joints[leading].acceleration_rad_s2 * joints[leading].velocity_rad_s;
            if sense >= 0.0 {
                excess.speeding_up = most.max(excess.speeding_up);
            }
            if sense <= 0.0 {
                excess.braking = most.max(excess.braking);
            }
        }
        excess
    }
}
