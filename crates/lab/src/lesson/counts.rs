use tracelight_rig::{Joint, PanTilt, TICK_F64_S};
use tracelight_sim::{Between, MotionArray, ObserverName, RigConfig, follow_array};

use super::rigs::{driven, jump, pid};
use super::{Ask, Check, Experiment, Lesson, Quantity};

/// Speed from counts: too short a look is noise, too long a one is late.
pub(super) const LESSON: Lesson = Lesson {
    number: 5,
    title: "Counts: speed that comes in steps",
    asks: &[Ask {
        name: "interval",
        unit: "ms",
        bounds: (1.0, 64.0),
        meaning: "over how many milliseconds counts are compared",
    }],
    examples: &[("1 ms", &[1.0]), ("40 ms", &[40.0])],
    panels: &[(0, Quantity::Speed), (0, Quantity::Command), (1, Quantity::Angle)],
    rig: None,
    run,
    check,
};

const KP: f64 = 100.0;
const KD: f64 = 3.0;
/// 1 ft/s on a target 3 ft away, rad/s.
const SPEED_RAD_S: f64 = 1.0 / 3.0;
const RAMP_S: f64 = 0.6;
const STEP_DEG: f64 = 0.5;

fn run(values: &[f64]) -> Vec<Experiment> {
    let interval_ms = values.first().copied().unwrap_or(1.0);
    let mut rig = driven(RigConfig::report(), Joint::Pan, pid(KP, 0.0, KD));
    rig.control.observer = Some(ObserverName::Differences);
    rig.control.observer_interval_s = interval_ms * TICK_F64_S;
    let rows = [(0.0, PanTilt::default()), (RAMP_S, PanTilt::new(RAMP_S * SPEED_RAD_S, 0.0))];
    let ticks = MotionArray::new(&rows, Between::Lines).map(|ramp| follow_array(&rig, &ramp, 0.2, 0));
    let ramp = Experiment { name: "pan, 1 ft/s".into(), joint: Joint::Pan, ticks: ticks.unwrap_or_default() };
    vec![ramp, jump(&rig, Joint::Pan, STEP_DEG)]
}

fn check(_: &[f64], experiments: &[Experiment]) -> Vec<Check> {
    let [ramp, step] = experiments else { return Vec::new() };
    vec![
        Check::at_most(
            format!("{}: command jumps by, rms", ramp.name),
            jumps_v(ramp),
            3.0,
            "V",
            "one count more or less is a jump of the speed: look back longer",
        ),
        Check::at_most(
            format!("{}: overshoot", step.name),
            step.figures(STEP_DEG.to_radians()).overshoot_percent,
            8.0,
            "%",
            "a speed that is old damps too late: look back less long",
        ),
    ]
}

/// How far the command goes from tick to tick while the joint turns evenly, root mean square, V.
fn jumps_v(ramp: &Experiment) -> f64 {
    const FROM_S: f64 = 0.2;
    let (from, to) = ((FROM_S / TICK_F64_S) as usize, (RAMP_S / TICK_F64_S) as usize);
    let even = ramp.ticks.get(from..to).unwrap_or_default();
    let squares = even.windows(2).map(|pair| {
        let jump = f64::from(pair[1].command_v[ramp.joint] - pair[0].command_v[ramp.joint]);
        jump * jump
    });
    (squares.sum::<f64>() / even.len().max(1) as f64).sqrt()
}
