use tracelight_aim::HeadPose;
use tracelight_control::Reference;
use tracelight_rig::{Joint, PanTilt, Setpoint, TICK_F64_S, TICK_S};
use tracelight_trajectory::{JointMotion, rest_to_rest};

use crate::array::MotionArray;
use crate::bench::{Bench, BenchTick};
use crate::compensator::CompensatorLaw;
use crate::config::RigConfig;
use crate::laws::{LawName, ObserverName, StepReference};
use crate::pid_law::{PidLaw, PidMemory};
use crate::truth::Truth;

/// What a joint does when it is sent somewhere else, for [`StepResponse::LENGTH_S`].
#[derive(Clone, Debug)]
pub struct StepResponse {
    /// The head as it truly is.
    pub nonlinear: Vec<BenchTick>,
    /// The linearization where the step ends.
    pub linear: Vec<BenchTick>,
}

impl StepResponse {
    /// How long a step is watched, s.
    pub const LENGTH_S: f64 = 3.0;
}

/// Sends one joint from rest at zero to `to_rad`, the other is held at zero. `None` if the motors are too weak for a move, or
/// it ends out of the joint's range.
pub fn step_response(
    rig: &RigConfig,
    joint: Joint,
    to_rad: f64,
    reference: StepReference,
    seed: u64,
) -> Option<StepResponse> {
    let mut to = PanTilt::default();
    to[joint] = to_rad;
    let references = match reference {
        StepReference::Jump => jump(rig, to)?,
        StepReference::Move => shaped(rig, to)?,
    };
    Some(StepResponse {
        nonlinear: follow(Bench::nonlinear(rig, seed), &references),
        linear: follow(Bench::linear(rig, to), &references),
    })
}

/// Simulates a setpoint step with another law for the joint and with quantized positions.
pub fn step_response_by(
    rig: &RigConfig,
    joint: Joint,
    law: &CompensatorLaw,
    to_rad: f64,
    seed: u64,
) -> Option<StepResponse> {
    let (rig, to) = on_counts(rig, joint, to_rad);
    let references = jump(&rig, to)?;
    let law = law.config();
    Some(StepResponse {
        nonlinear: follow(Bench::nonlinear(&rig, seed).driven_by(joint, law), &references),
        linear: follow(Bench::linear(&rig, to).driven_by(joint, law), &references),
    })
}

/// Simulates a setpoint step with a designed PID for the joint and with quantized positions.
pub fn step_response_by_pid(
    rig: &RigConfig,
    joint: Joint,
    law: &PidLaw,
    to_rad: f64,
    seed: u64,
) -> Option<StepResponse> {
    let (rig, to) = on_counts(rig, joint, to_rad);
    let references = jump(&rig, to)?;
    // gravity alone
    let nothing = CompensatorLaw::NOTHING.config();
    let (nonlinear, linear) = (
        Bench::nonlinear(&rig, seed).driven_by(joint, nothing),
        Bench::linear(&rig, to).driven_by(joint, nothing),
    );
    Some(StepResponse {
        nonlinear: follow_by_pid(nonlinear, joint, law, &references),
        linear: follow_by_pid(linear, joint, law, &references),
    })
}

/// The rig with a law to be replaced, which sees counts alone; and the setpoint of a step of one joint, rad.
fn on_counts(rig: &RigConfig, joint: Joint, to_rad: f64) -> (RigConfig, PanTilt<f64>) {
    let mut rig = rig.clone();
    (rig.control.law, rig.control.observer) = (LawName::LeadLag, Some(ObserverName::Counts));
    let mut to = PanTilt::default();
    to[joint] = to_rad;
    (rig, to)
}

fn follow_by_pid<H: Truth>(
    mut bench: Bench<H>,
    joint: Joint,
    law: &PidLaw,
    references: &[Reference],
) -> Vec<BenchTick> {
    let mut memory = PidMemory::default();
    references.iter().map(|reference| bench.step_by_pid(reference, joint, (law, &mut memory))).collect()
}

/// Follows an array with the rig's law from rest where it begins, and stays at its end for `rest_s`; a tick each.
pub fn follow_array(rig: &RigConfig, array: &MotionArray, rest_s: f64, seed: u64) -> Vec<BenchTick> {
    let ticks = ((array.length_s() + rest_s) / TICK_F64_S).round() as usize;
    let mut bench = Bench::nonlinear_at(rig, array.start_rad(), seed);
    let at = |time_s: f64| array.at(time_s).map(|motion| setpoint(&motion));
    let reference = |tick: usize| {
        let time_s = tick as f64 * TICK_F64_S;
        Reference { now: at(time_s), ahead: at(time_s + 0.5 * TICK_F64_S) }
    };
    (0..=ticks).map(|tick| bench.step(&reference(tick))).collect()
}

/// A push at a joint: N m from one moment to another, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// N m.
    pub torque_nm: f64,
    /// Start, s.
    pub from_s: f64,
    /// End, s.
    pub until_s: f64,
}

/// What the rig's law does for [`StepResponse::LENGTH_S`] at rest at zero about a push at one joint.
pub fn push_response(rig: &RigConfig, joint: Joint, push: &Push, seed: u64) -> Vec<BenchTick> {
    let mut bench = Bench::nonlinear(rig, seed);
    let still = PanTilt::default();
    let reference = Reference { now: still, ahead: still };
    let tick = |number: usize| {
        let time_s = number as f64 * TICK_F64_S;
        let mut torque_nm = PanTilt::default();
        if (push.from_s..push.until_s).contains(&time_s) {
            torque_nm[joint] = push.torque_nm;
        }
        bench.push(torque_nm);
        bench.step(&reference)
    };
    (0..ticks()).map(tick).collect()
}

fn follow<H: Truth>(mut bench: Bench<H>, references: &[Reference]) -> Vec<BenchTick> {
    references.iter().map(|reference| bench.step(reference)).collect()
}

fn ticks() -> usize {
    (StepResponse::LENGTH_S / TICK_F64_S).round() as usize
}

fn jump(rig: &RigConfig, to_rad: PanTilt<f64>) -> Option<Vec<Reference>> {
    let in_range = |j: Joint| {
        let (lower, upper) = rig.model.geometry.range_rad[j];
        lower <= to_rad[j] && to_rad[j] <= upper
    };
    let there = to_rad.map(|at| setpoint(&JointMotion::at_rest(at)));
    Joint::BOTH.into_iter().all(in_range).then(|| vec![Reference { now: there, ahead: there }; ticks()])
}

fn shaped(rig: &RigConfig, to_rad: PanTilt<f64>) -> Option<Vec<Reference>> {
    // where the head stands does not matter: no point of a target is aimed at
    let machine = rig.machine(HeadPose::square_on(1.0));
    let start = PanTilt::default();
    let way = rest_to_rest(&machine, start, to_rad, rig.motion.ramp_s)?;
    let points: Vec<PanTilt<Setpoint>> = std::iter::once(start.map(JointMotion::at_rest))
        .chain(way)
        .map(|joints| joints.map(|j| setpoint(&j)))
        .collect();
    let last = *points.last()?;
    let at = |tick: usize| *points.get(tick).unwrap_or(&last);
    Some((0..ticks()).map(|tick| between(at(tick), at(tick + 1))).collect())
}

fn setpoint(motion: &JointMotion) -> Setpoint {
    Setpoint {
        position_rad: motion.position_rad as f32,
        velocity_rad_s: motion.velocity_rad_s as f32,
        acceleration_rad_s2: motion.acceleration_rad_s2 as f32,
    }
}

/// The setpoint of a tick, and the one halfway to the next.
fn between(now: PanTilt<Setpoint>, next: PanTilt<Setpoint>) -> Reference {
    let ahead = PanTilt::from_fn(|j| {
        let (a, b) = (&now[j], &next[j]);
        // the middle of the cubic through both ends with their velocities
        let bend = TICK_S / 8.0 * (a.velocity_rad_s - b.velocity_rad_s);
        Setpoint {
            position_rad: 0.5 * (a.position_rad + b.position_rad) + bend,
            velocity_rad_s: 0.5 * (a.velocity_rad_s + b.velocity_rad_s),
            acceleration_rad_s2: 0.5 * (a.acceleration_rad_s2 + b.acceleration_rad_s2),
        }
    });
    Reference { now, ahead }
}
