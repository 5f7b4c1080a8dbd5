use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_sim::{HandTuned, Push, RigConfig, push_response};

use super::check::Check;
use super::experiment::{Experiment, Quantity, mm};
use super::question::{Ask, Lesson};
use super::rigs::{KD, KI, KP, driven, jump, pid};

/// What answers a push need not answer a jump of the setpoint.
pub(super) const LESSON: Lesson = Lesson {
    number: 8,
    title: "Two degrees of freedom: stiff against pushes, gentle with setpoints",
    asks: &[
        KP,
        KI,
        KD,
        Ask { name: "b", unit: "", bounds: (0.0, 1.0), meaning: "share of the setpoint that kp sees" },
    ],
    examples: &[("stiff, b = 1", &[90.0, 300.0, 5.0, 1.0])],
    panels: &[(0, Quantity::Error), (1, Quantity::Angle), (1, Quantity::Command)],
    rig: None,
    run,
    check,
};

const PUSH: Push = Push { torque_nm: 0.4, from_s: 0.3, until_s: 1.3 };
const STEP_DEG: f64 = 10.0;

fn run(values: &[f64]) -> Vec<Experiment> {
    let &[kp, ki, kd, b] = values else { return Vec::new() };
    let by = HandTuned { position_weight: b, ..pid(kp, ki, kd) };
    let rig = driven(RigConfig::report(), Joint::Pan, by);
    let pushed = Experiment {
        name: "pan, pushed with 0.4 N m".into(),
        joint: Joint::Pan,
        ticks: push_response(&rig, Joint::Pan, &PUSH, 0),
    };
    vec![pushed, jump(&rig, Joint::Pan, STEP_DEG)]
}

fn check(_: &[f64], experiments: &[Experiment]) -> Vec<Check> {
    let [pushed, step] = experiments else { return Vec::new() };
    let worst = pushed.ticks.iter().map(|tick| tick.angle_rad.pan.abs()).fold(0.0, f64::max);
    let last_s = (PUSH.until_s - 0.2)..PUSH.until_s;
    let late = pushed.ticks.iter().enumerate().filter(|(k, _)| last_s.contains(&(*k as f64 * TICK_F64_S)));
    let still = late.map(|(_, tick)| tick.angle_rad.pan.abs()).fold(0.0, f64::max);
    let figures = step.figures(STEP_DEG.to_radians());
    vec![
        Check::at_most(
            format!("{}: gives way by", pushed.name),
            mm(worst),
            6.0,
            "mm",
            "a stiffer spring gives way less: more kp, and kd to go with it",
        ),
        Check::at_most(
            format!("{}: still off by at the end", pushed.name),
            mm(still),
            2.0,
            "mm",
            "the integral is too slow to take the push's place: more ki",
        ),
        Check::at_most(
            format!("{}: overshoot", step.name),
            figures.overshoot_percent,
            3.0,
            "%",
            "the spring is wound by a setpoint that jumps: let kp see less of it (b)",
        ),
        Check::at_most(
            format!("{}: settled", step.name),
            figures.settle_s.unwrap_or(f64::NAN),
            0.7,
            "s",
            "what is left of the setpoint comes in by the integral alone: more ki, or a larger b",
        ),
    ]
}
