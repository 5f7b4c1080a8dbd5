use std::f64::consts::PI;

use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_sim::{RigConfig, StepReference, step_response};

use super::check::Check;
use super::experiment::{Experiment, Quantity};
use super::question::{Ask, Lesson};
use super::rigs::{KP, driven, jump, pid};

/// A proportional gain is a spring.
pub(super) const LESSON: Lesson = Lesson {
    number: 1,
    title: "P only: a spring",
    asks: &[
        KP,
        Ask {
            name: "sticks",
            unit: "mrad",
            bounds: (0.0, 1e3),
            meaning: "the largest error at which friction holds the joint",
        },
    ],
    examples: &[("kp = 5", &[5.0, 0.0]), ("kp = 60", &[60.0, 0.0])],
    panels: &[(0, Quantity::Angle), (0, Quantity::Command)],
    rig: None,
    run,
    check,
};

const STEP_DEG: f64 = 1.5;
const PERIOD_S: f64 = 0.4;

fn run(values: &[f64]) -> Vec<Experiment> {
    let kp = values.first().copied().unwrap_or_default();
    vec![jump(&driven(RigConfig::report(), Joint::Pan, pid(kp, 0.0, 0.0)), Joint::Pan, STEP_DEG)]
}

fn check(values: &[f64], experiments: &[Experiment]) -> Vec<Check> {
    let &[kp, sticks_mrad] = values else { return Vec::new() };
    let period_s = experiments.first().map_or(f64::NAN, |e| period_s(&e.angles_rad(), STEP_DEG.to_radians()));
    let held_mrad = 1e3 * largest_held_rad(kp);
    vec![
        Check {
            what: "period of the swing".into(),
            unit: "s",
            value: period_s,
            least: 0.97 * PERIOD_S,
            most: 1.03 * PERIOD_S,
            if_less: "it swings too fast: a softer spring, less kp",
            if_more: "it swings too slowly, or sticks at once: a stiffer spring, more kp",
        },
        Check {
            what: format!("sticks, of the {held_mrad:.3} mrad that friction holds it at"),
            unit: "%",
            value: 100.0 * sticks_mrad / held_mrad,
            least: 97.0,
            most: 103.0,
            if_less: "friction holds it at more: where kp times the error is just its Coulomb friction",
            if_more: "friction holds it at less: where kp times the error is just its Coulomb friction",
        },
    ]
}

/// Mean time between crossings of the goal the same way, over the first two periods; NaN if there are none.
fn period_s(angles_rad: &[f64], goal_rad: f64) -> f64 {
    let crossing = |(k, pair): (usize, &[f64])| {
        let (before, after) = (pair[0] - goal_rad, pair[1] - goal_rad);
        (before < 0.0 && after >= 0.0).then(|| (k as f64 - before / (after - before)) * TICK_F64_S)
    };
    let times: Vec<f64> = angles_rad.windows(2).enumerate().filter_map(crossing).take(3).collect();
    match (times.first(), times.last()) {
        (Some(first), Some(last)) if times.len() > 1 => (last - first) / (times.len() - 1) as f64,
        _ => f64::NAN,
    }
}

/// The largest jump that does not move pan, rad, by simulated jumps.
fn largest_held_rad(kp: f64) -> f64 {
    let rig = driven(RigConfig::report(), Joint::Pan, pid(kp, 0.0, 0.0));
    let moves = |to_rad: f64| {
        let response = step_response(&rig, Joint::Pan, to_rad, StepReference::Jump, 0);
        let ticks = response.map(|response| response.nonlinear).unwrap_or_default();
        let ends = ticks.first().zip(ticks.last());
        ends.is_some_and(|(first, last)| (last.angle_rad.pan - first.angle_rad.pan).abs() > 1e-6)
    };
    let (mut held, mut moved) = (0.0, PI);
    // to a thousandth of what it is
    while moved - held > 1e-3 * moved && moved > 1e-6 {
        let middle = if held == 0.0 { 0.3 * moved } else { 0.5 * (held + moved) };
        if moves(middle) { moved = middle } else { held = middle }
    }
    held
}
