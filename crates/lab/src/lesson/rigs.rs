//! What the lessons' experiments have in common.

use tracelight_rig::Joint;
use tracelight_sim::{
    BenchTick, Feedforward, HandTuned, LawName, ObserverName, RigConfig, StepReference, StepResponse,
    step_response,
};

use super::experiment::Experiment;
use super::question::Ask;

pub(super) const KP: Ask =
    Ask { name: "kp", unit: "N m/rad", bounds: (0.0, 1e4), meaning: "torque per angle: the spring" };
pub(super) const KI: Ask = Ask {
    name: "ki",
    unit: "N m/(rad s)",
    bounds: (0.0, 1e5),
    meaning: "torque per angle and time: the integral",
};
pub(super) const KD: Ask =
    Ask { name: "kd", unit: "N m s/rad", bounds: (0.0, 1e3), meaning: "torque per speed: the damper" };

/// A PID without anything else.
pub(super) const fn pid(kp: f64, ki: f64, kd: f64) -> HandTuned {
    HandTuned {
        kp,
        ki,
        kd,
        position_weight: 1.0,
        velocity_weight: 1.0,
        anti_windup: true,
        feedforward: Feedforward::None,
    }
}

/// The rig driven by that, its edges timed.
pub(super) fn driven(mut rig: RigConfig, joint: Joint, by: HandTuned) -> RigConfig {
    rig.control.law = LawName::HandTuned;
    rig.control.observer = Some(ObserverName::EdgeTimes);
    rig.control.hand_tuned[joint] = by;
    rig
}

fn response(rig: &RigConfig, joint: Joint, to_rad: f64) -> StepResponse {
    // a jump is refused only out of the joint's range, and no lesson goes there
    let none = StepResponse { nonlinear: Vec::new(), linear: Vec::new() };
    step_response(rig, joint, to_rad, StepReference::Jump, 0).unwrap_or(none)
}

/// A jump of the setpoint by so many degrees.
pub(super) fn jump(rig: &RigConfig, joint: Joint, to_deg: f64) -> Experiment {
    of(joint, to_deg, "jump", response(rig, joint, to_deg.to_radians()).nonlinear)
}

/// The same of the head linearized.
pub(super) fn linear_jump(rig: &RigConfig, joint: Joint, to_deg: f64) -> Experiment {
    of(joint, to_deg, "jump, linearized", response(rig, joint, to_deg.to_radians()).linear)
}

fn of(joint: Joint, to_deg: f64, what: &str, ticks: Vec<BenchTick>) -> Experiment {
    Experiment { name: format!("{joint}, {to_deg}° {what}"), joint, ticks }
}
