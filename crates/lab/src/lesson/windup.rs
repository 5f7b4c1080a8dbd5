use tracelight_rig::Joint;
use tracelight_sim::{HandTuned, RigConfig};

use super::check::Check;
use super::experiment::{Experiment, Quantity};
use super::jumps::{Jumps, Worst};
use super::question::{Ask, Lesson};
use super::rigs::{KD, KI, KP, driven, pid};

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

/// Up and down, as gravity and friction add on the way up; they end in different parts of a count of the encoder.
const JUMPS: Jumps<8> = Jumps {
    small_deg: [5.0, 4.8, 4.6, 4.4, -4.4, -4.6, -4.8, -5.0],
    large_deg: [40.0, 39.5, 39.0, 38.5, -38.5, -39.0, -39.5, -40.0],
};

fn run(values: &[f64]) -> Vec<Experiment> {
    let &[kp, ki, kd, anti_windup] = values else { return Vec::new() };
    let by = HandTuned { anti_windup: anti_windup >= 0.5, ..pid(kp, ki, kd) };
    JUMPS.run(&driven(RigConfig::report(), Joint::Tilt, by), Joint::Tilt)
}

fn check(_: &[f64], experiments: &[Experiment]) -> Vec<Check> {
    let of = |(worst, what): (Worst, &str)| {
        [
            Check::at_most(
                format!("{what}: left at rest"),
                worst.left_mm,
                // a count and a half
                2.1,
                "mm",
                "gravity and friction hold out against kp: a larger ki takes that away sooner, down to a count (1.4 mm), of which the law \
                 sees nothing; too large a ki never comes to rest",
            ),
            Check::at_most(
                format!("{what}: overshoot"),
                worst.overshoot_percent,
                15.0,
                "%",
                "what the integral gathered on the way has to be undone beyond the goal: let it wait (anti_windup=1), a smaller \
                 ki, or more kd",
            ),
        ]
    };
    let names = ["worst of 8 jumps to ±5°", "worst of 8 jumps to ±40°"];
    JUMPS.worst(experiments).into_iter().zip(names).flat_map(of).collect()
}
