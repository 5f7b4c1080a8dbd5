use tracelight_rig::Joint;
use tracelight_sim::RigConfig;

use super::check::Check;
use super::experiment::{Experiment, Quantity};
use super::jumps::Jumps;
use super::question::Lesson;
use super::rigs::{KD, KP, driven, pid};

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

/// A tenth of a degree is 1.14 counts and half a degree 5.69: seven jumps end in seven parts of a count.
const JUMPS: Jumps<7> = Jumps {
    small_deg: [5.0, 4.9, 4.8, 4.7, 4.6, 4.5, 4.4],
    large_deg: [30.0, 29.5, 29.0, 28.5, 28.0, 27.5, 27.0],
};

fn run(values: &[f64]) -> Vec<Experiment> {
    let &[kp, kd] = values else { return Vec::new() };
    JUMPS.run(&driven(RigConfig::report(), Joint::Pan, pid(kp, 0.0, kd)), Joint::Pan)
}

fn check(_: &[f64], experiments: &[Experiment]) -> Vec<Check> {
    let [small, large] = JUMPS.worst(experiments);
    let overshoot = |what: &str, percent: f64| {
        Check::at_most(
            format!("{what}: overshoot"),
            percent,
            2.0,
            "%",
            "the damper gives way, or the amplifier cannot brake as hard as kp and kd want: more kd, or less kp",
        )
    };
    // friction's share of 1 mm, a count, and a tenth to spare
    let left = |what: &str, left_mm: f64| {
        Check::at_most(
            format!("{what}: left at rest"),
            left_mm,
            2.5,
            "mm",
            "friction holds the joint where kp times the error is less, up to a count (1.4 mm) further than it seems: more kp",
        )
    };
    let (few, many) = ("worst of 7 jumps to 5°", "worst of 7 jumps to 30°");
    vec![
        overshoot(few, small.overshoot_percent),
        left(few, small.left_mm),
        overshoot(many, large.overshoot_percent),
        Check::at_most(
            format!("{many}: settled"),
            large.settle_s,
            0.8,
            "s",
            "it creeps along error = kd/kp times speed, or never comes within 2 %: more kp, or less kd",
        ),
        left(many, large.left_mm),
    ]
}
