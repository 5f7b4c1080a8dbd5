use tracelight_rig::Joint;
use tracelight_sim::RigConfig;

use super::check::Check;
use super::experiment::{Experiment, Quantity, mm};
use super::question::Lesson;
use super::rigs::{KD, KP, driven, jump, pid};

/// A spring and a damper, for small jumps and large ones.
pub(super) const LESSON: Lesson = Lesson {
    number: 3,
    title: "PD: a spring and a damper",
    asks: &[KP, KD],
    examples: &[("kp = 20, kd = 1", &[20.0, 1.0]), ("kp = 20, kd = 4", &[20.0, 4.0])],
    panels: &[(0, Quantity::Angle), (1, Quantity::Angle), (1, Quantity::Command)],
    rig: None,
    run,
    check,
};

const STEPS_DEG: [f64; 2] = [5.0, 30.0];

fn run(values: &[f64]) -> Vec<Experiment> {
    let &[kp, kd] = values else { return Vec::new() };
    let rig = driven(RigConfig::report(), Joint::Pan, pid(kp, 0.0, kd));
    STEPS_DEG.map(|degrees| jump(&rig, Joint::Pan, degrees)).to_vec()
}

fn check(_: &[f64], experiments: &[Experiment]) -> Vec<Check> {
    let all = experiments.iter().zip(STEPS_DEG);
    let of = |(experiment, degrees): (&Experiment, f64)| {
        let figures = experiment.figures(degrees.to_radians());
        let name = &experiment.name;
        [
            Check::at_most(
                format!("{name}: overshoot"),
                figures.overshoot_percent,
                2.0,
                "%",
                "the damper gives way, or the amplifier cannot brake as hard as kp and kd want: more kd, or less kp",
            ),
            Check::at_most(
                format!("{name}: settled"),
                figures.settle_s.unwrap_or(f64::NAN),
                0.8,
                "s",
                "it creeps, or what friction leaves is more than 2 % of the jump: more kp, or less kd",
            ),
            Check::at_most(
                format!("{name}: left at rest"),
                mm(figures.final_error),
                1.5,
                "mm",
                "friction holds the joint where kp times the error is less: more kp",
            ),
        ]
    };
    all.flat_map(of).collect()
}
