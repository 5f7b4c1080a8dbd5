use tracelight_rig::Joint;
use tracelight_sim::{HandTuned, RigConfig};

use super::check::Check;
use super::experiment::{Experiment, Quantity, mm};
use super::question::{Ask, Lesson};
use super::rigs::{KD, KI, KP, driven, jump, pid};

/// An integral takes away what is left, and winds up.
pub(super) const LESSON: Lesson = Lesson {
    number: 4,
    title: "PID: what is left, and windup",
    asks: &[
        KP,
        KI,
        KD,
        Ask {
            name: "anti_windup",
            unit: "",
            bounds: (0.0, 1.0),
            meaning: "1: the integral waits while the amplifier is at its limit; 0: it does not",
        },
    ],
    examples: &[
        ("PD: kp = 40, kd = 5", &[40.0, 0.0, 5.0, 1.0]),
        ("ki = 100, winding up", &[40.0, 100.0, 5.0, 0.0]),
        ("ki = 300, waiting", &[40.0, 300.0, 5.0, 1.0]),
    ],
    panels: &[(0, Quantity::Error), (1, Quantity::Angle), (1, Quantity::Command)],
    rig: None,
    run,
    check,
};

const STEPS_DEG: [f64; 2] = [5.0, 40.0];

fn run(values: &[f64]) -> Vec<Experiment> {
    let &[kp, ki, kd, anti_windup] = values else { return Vec::new() };
    let by = HandTuned { anti_windup: anti_windup >= 0.5, ..pid(kp, ki, kd) };
    let rig = driven(RigConfig::report(), Joint::Tilt, by);
    STEPS_DEG.map(|degrees| jump(&rig, Joint::Tilt, degrees)).to_vec()
}

fn check(_: &[f64], experiments: &[Experiment]) -> Vec<Check> {
    let of = |(experiment, degrees): (&Experiment, f64)| {
        let figures = experiment.figures(degrees.to_radians());
        let name = &experiment.name;
        [
            Check::at_most(
                format!("{name}: left at rest"),
                mm(figures.final_error),
                0.8,
                "mm",
                "gravity and friction hold out against kp: a larger ki takes that away sooner; too large a ki never comes to rest",
            ),
            Check::at_most(
                format!("{name}: overshoot"),
                figures.overshoot_percent,
                15.0,
                "%",
                "what the integral gathered on the way has to be undone beyond the goal: let it wait (anti_windup=1), a smaller \
                 ki, or more kd",
            ),
        ]
    };
    experiments.iter().zip(STEPS_DEG).flat_map(of).collect()
}
