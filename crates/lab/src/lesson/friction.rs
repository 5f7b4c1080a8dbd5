use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_sim::{RigConfig, StepReference, step_response};

use super::check::Check;
use super::experiment::{Experiment, Quantity};
use super::question::{Ask, Lesson};
use super::rigs::{driven, pid};

/// A joint that sticks, and an integral that waits for it.
pub(super) const LESSON: Lesson = Lesson {
    number: 6,
    title: "Friction: it sticks, it slips, it hunts",
    asks: &[
        Ask {
            name: "waits",
            unit: "s",
            bounds: (0.0, 10.0),
            meaning: "how long the joint stands before it breaks away",
        },
        Ask {
            name: "level",
            unit: "N m",
            bounds: (0.0, 10.0),
            meaning: "the command's torque at that moment",
        },
    ],
    examples: &[("what happens", &[0.0, 0.0])],
    panels: &[(0, Quantity::Error), (0, Quantity::Command)],
    rig: Some(sticky),
    run,
    check,
};

const KP: f64 = 5.0;
const KI: f64 = 40.0;
const KD: f64 = 0.3;
/// Two counts.
const STEP_RAD: f64 = 3e-3;

/// The rig with pan's friction half as much again at standstill.
fn sticky() -> RigConfig {
    let mut rig = RigConfig::report();
    rig.name = "sticky".into();
    rig.description =
        "the rig of the 2006 report, with friction that is half as much again at standstill".into();
    rig.truth.wear.stribeck_ratio = 1.5;
    rig
}

fn run(_: &[f64]) -> Vec<Experiment> {
    let rig = driven(sticky(), Joint::Pan, pid(KP, KI, KD));
    let response = step_response(&rig, Joint::Pan, STEP_RAD, StepReference::Jump, 0);
    let ticks = response.map(|response| response.nonlinear).unwrap_or_default();
    vec![Experiment { name: "pan, 3 mrad jump".into(), joint: Joint::Pan, ticks }]
}

fn check(values: &[f64], experiments: &[Experiment]) -> Vec<Check> {
    let (&[waits_s, level_nm], [experiment]) = (values, experiments) else { return Vec::new() };
    let stood_rad = experiment.ticks.first().map_or(0.0, |tick| tick.angle_rad.pan);
    let broke = experiment.ticks.iter().position(|tick| (tick.angle_rad.pan - stood_rad).abs() > 1e-7);
    let measured_s = broke.map_or(f64::NAN, |tick| tick as f64 * TICK_F64_S);
    let torque_nm_per_v = sticky().model.motors.pan.torque_nm_per_v;
    let command_v = broke.and_then(|tick| experiment.ticks.get(tick)).map(|tick| tick.command_v.pan);
    let measured_nm = command_v.map_or(f64::NAN, |v| f64::from(v) * torque_nm_per_v);
    let share = |what: &str, said: f64, is: f64, if_less, if_more| Check {
        what: what.into(),
        unit: "%",
        value: 100.0 * said / is,
        least: 95.0,
        most: 105.0,
        if_less,
        if_more,
    };
    vec![
        share(
            "waits, of what was simulated",
            waits_s,
            measured_s,
            "it stands longer: kp e + ki e t has to reach break-away friction",
            "it does not stand that long: kp e is there at once, ki e t adds to it",
        ),
        share(
            "level, of what was simulated",
            level_nm,
            measured_nm,
            "it takes more to break away than to slide: Coulomb friction times the ratio at standstill",
            "that is more than friction has at standstill",
        ),
    ]
}
