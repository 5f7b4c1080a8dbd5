use tracelight_maths::powi;
use tracelight_rig::{Joint, PanTilt, TICK_F64_S};
use tracelight_sim::{Between, MotionArray, ObserverName, RigConfig, follow_array};

use super::check::Check;
use super::experiment::{Experiment, Quantity};
use super::question::{Ask, Lesson};
use super::rigs::{driven, jump, pid};

/// Speed from counts: too short a look is noise, too long a one is late.
pub(super) const LESSON: Lesson = Lesson {
    number: 5,
    title: "Counts: speed that comes in steps",
    asks: &[Ask {
        name: "interval",
        unit: "ms",
        bounds: (1.0, 64.0),
        meaning: "over how many whole milliseconds counts are compared",
    }],
    examples: &[("1 ms", &[1.0]), ("40 ms", &[40.0])],
    panels: &[(0, Quantity::Speed), (0, Quantity::Command), (5, Quantity::Angle)],
    rig: None,
    run,
    check,
};

const KP: f64 = 100.0;
const KD: f64 = 3.0;
/// 1 ft/s on a target 3 ft away, rad/s, and a little more and less: at one speed alone counts and looks may come in step.
const SPEEDS_RAD_S: [f64; 5] = [1.0 / 3.0, 0.29, 0.31, 0.36, 0.38];
const RAMP_S: f64 = 0.6;
const STEP_DEG: f64 = 0.5;

fn run(values: &[f64]) -> Vec<Experiment> {
    let interval_ms = values.first().copied().unwrap_or(1.0);
    let mut rig = driven(RigConfig::report(), Joint::Pan, pid(KP, 0.0, KD));
    rig.control.observer = Some(ObserverName::Differences);
    rig.control.observer_interval_s = interval_ms * TICK_F64_S;
    let ramp = |speed_rad_s: f64| {
        let rows = [(0.0, PanTilt::default()), (RAMP_S, PanTilt::new(RAMP_S * speed_rad_s, 0.0))];
        let ticks = MotionArray::new(&rows, Between::Lines).map(|ramp| follow_array(&rig, &ramp, 0.2, 0));
        let name = format!("pan, {:.2} ft/s", 3.0 * speed_rad_s);
        Experiment { name, joint: Joint::Pan, ticks: ticks.unwrap_or_default() }
    };
    SPEEDS_RAD_S.into_iter().map(ramp).chain([jump(&rig, Joint::Pan, STEP_DEG)]).collect()
}

fn check(_: &[f64], experiments: &[Experiment]) -> Vec<Check> {
    let [ramps @ .., step] = experiments else { return Vec::new() };
    let jumps_v = (ramps.iter().map(|ramp| powi(jumps_v(ramp), 2)).sum::<f64>() / ramps.len() as f64).sqrt();
    vec![
        Check::at_most(
            "pan, about 1 ft/s: command jumps by, rms",
            jumps_v,
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
