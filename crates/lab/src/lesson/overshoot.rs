use tracelight_rig::Joint;
use tracelight_sim::{ObserverName, RigConfig};

use super::check::Check;
use super::experiment::{Experiment, Quantity};
use super::question::Lesson;
use super::rigs::{KP, driven, jump, linear_jump, pid};

/// How far a spring with too little of a damper overshoots.
pub(super) const LESSON: Lesson = Lesson {
    number: 2,
    title: "Overshoot: what a damping ratio says, and what the amplifier makes of it",
    asks: &[KP],
    examples: &[("kp = 8", &[8.0]), ("kp = 40", &[40.0])],
    panels: &[(0, Quantity::Angle), (1, Quantity::Angle), (1, Quantity::Command)],
    rig: None,
    run,
    check,
};

const KD: f64 = 1.0;
const SMALL_DEG: f64 = 1.0;
const LARGE_DEG: f64 = 15.0;

fn run(values: &[f64]) -> Vec<Experiment> {
    let kp = values.first().copied().unwrap_or_default();
    let mut rig = driven(RigConfig::report(), Joint::Pan, pid(kp, 0.0, KD));
    let real = [LARGE_DEG].map(|degrees| jump(&rig, Joint::Pan, degrees));
    // the linearized head's encoder is so fine that one tick's difference is its speed
    rig.control.observer = Some(ObserverName::Counts);
    std::iter::once(linear_jump(&rig, Joint::Pan, SMALL_DEG)).chain(real).collect()
}

fn check(_: &[f64], experiments: &[Experiment]) -> Vec<Check> {
    let linear =
        experiments.first().map_or(f64::NAN, |e| e.figures(SMALL_DEG.to_radians()).overshoot_percent);
    vec![Check {
        what: "overshoot of the linearized head".into(),
        unit: "%",
        value: linear,
        least: 19.0,
        most: 21.0,
        if_less: "too well damped: more kp with the same kd lowers the damping ratio",
        if_more: "too little damped: less kp with the same kd raises the damping ratio",
    }]
}
