//! A head that was just powered up is homed by its end stops, and one that is homed finds where they are.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on may panic, and shows figures"
)]

use tracelight_aim::HeadPose;
use tracelight_job::{Mover, Place};
use tracelight_pipeline::{Asked, Driving, request_of};
use tracelight_rig::{Joint, PanTilt};
use tracelight_sim::{Observed, RigConfig, SimulatedRig};
use tracelight_task::{Failure, NoProgress, Stop, Task};

const POSE: HeadPose = HeadPose::square_on(0.9144);
/// How far a simulated head's stops lie beyond its range, rad.
const BEYOND_RAD: f64 = 0.0175;
const RANGE_RAD: PanTilt<(f64, f64)> = PanTilt::new((-1.2, 1.25), (-0.9, 0.8));

/// A rig that is told to have these stops.
fn rig_of(name: &str, stops_rad: PanTilt<(f64, f64)>) -> RigConfig {
    let mut rig = RigConfig::preset(name).unwrap();
    (rig.model.geometry.range_rad, rig.truth.model.geometry.range_rad) = (RANGE_RAD, RANGE_RAD);
    rig.stops_rad = stops_rad.map(|(lower, upper)| (Some(lower), Some(upper)));
    rig
}

/// What is done with a head that was powered up at an angle, and how many counts it is off then.
fn moved<T>(
    config: &RigConfig,
    angle_rad: PanTilt<f64>,
    seed: u64,
    what: impl FnOnce(&mut Mover<'_>) -> Result<T, Failure>,
) -> (Result<T, Failure>, PanTilt<f64>, bool) {
    let driving = Driving::new(config.clone(), POSE, request_of(config), Asked::default());
    let stop = Stop::default();
    let task = Task { progress: &NoProgress, stop: &stop };
    let mut rig = SimulatedRig::unhomed(config, POSE, angle_rad, seed);
    let done = what(&mut Mover::new(&mut rig, &driving, task).unwrap());
    let now = rig.observe().unwrap();
    let count_rad = config.model.encoder.count_rad();
    let off = PanTilt::from_fn(|j| (f64::from(now.telemetry.position_rad[j]) - now.angle_rad[j]) / count_rad);
    (done, off, now.telemetry.homed)
}

#[test]
fn a_head_is_homed_by_its_end_stops_wherever_it_was_powered_up() {
    for (preset, most_counts) in [("report", 0.5), ("worn", 1.6)] {
        // a belt gives, either way alike: what is measured once by a head is found again by it
        let (measured, ..) = moved(&rig_of(preset, RANGE_RAD), PanTilt::default(), 9, |mover| {
            mover.home(PanTilt::default())?;
            mover.find_stops()
        });
        let config = rig_of(preset, measured.unwrap());
        for (seed, angle_rad) in (0..).zip([(0.0, 0.0), (0.9, -0.5), (-1.1, 0.7), (1.2, -0.88)]) {
            let angle_rad = PanTilt::new(angle_rad.0, angle_rad.1);
            let (place, off, homed) = moved(&config, angle_rad, seed, |mover| mover.home_by_stops());
            let place: Place = place.unwrap();
            assert!(place.homed && homed, "{preset} {seed}: {place:?}");
            assert!(place.angle_rad.pan.abs() < 5e-3 && place.angle_rad.tilt.abs() < 5e-3, "{place:?}");
            println!("{preset} {angle_rad:?}: {off:?} counts off");
            assert!(off.pan.abs().max(off.tilt.abs()) < most_counts, "{preset} {seed}: {off:?} counts off");
        }
    }
}

#[test]
fn a_homed_head_finds_its_stops_and_keeps_its_zero() {
    let at = PanTilt::new(0.3, -0.2);
    let (found, off, homed) = moved(&rig_of("report", RANGE_RAD), at, 3, |mover| {
        mover.home(at)?;
        let found = mover.find_stops()?;
        Ok((found, mover.place()))
    });
    let (found, place) = found.unwrap();
    assert!(homed && place.homed);
    for j in Joint::BOTH {
        let (lower, upper) = (RANGE_RAD[j].0 - BEYOND_RAD, RANGE_RAD[j].1 + BEYOND_RAD);
        assert!((found[j].0 - lower).abs() < 4e-3 && (found[j].1 - upper).abs() < 4e-3, "{found:?}");
        // it was homed to the nearest count where it was powered up within one
        assert!(off[j].abs() < 1.6, "{off:?}");
    }
}

#[test]
fn stops_that_are_others_than_the_rig_file_says_home_nothing() {
    let said = PanTilt::new((-1.2, 1.1), RANGE_RAD.tilt);
    let (done, _, homed) =
        moved(&rig_of("report", said), PanTilt::default(), 1, |mover| mover.home_by_stops());
    let failure = done.unwrap_err();
    assert!(failure.code == "stops" && failure.message.contains("pan turns 142"), "{}", failure.message);
    assert!(!homed);
    let none = RigConfig::report();
    let (done, _, homed) = moved(&none, PanTilt::default(), 1, |mover| mover.home_by_stops());
    assert!(done.unwrap_err().message.contains("--find-stops") && !homed);
}

#[test]
fn a_head_that_is_not_homed_or_has_no_encoders_measures_no_stops() {
    let rig = rig_of("report", RANGE_RAD);
    let (done, _, homed) = moved(&rig, PanTilt::default(), 1, |mover| mover.find_stops());
    assert!(done.unwrap_err().code == "unhomed" && !homed);
    let stepper = rig_of("stepper", RANGE_RAD);
    let (done, ..) = moved(&stepper, PanTilt::default(), 1, |mover| {
        mover.home(PanTilt::default())?;
        mover.find_stops()
    });
    assert!(done.unwrap_err().message.contains("without encoders"));
}

#[test]
fn a_joint_without_stops_is_said_to_have_none() {
    let mut rig = rig_of("report", RANGE_RAD);
    // its stops are further out than anybody says
    rig.truth.model.geometry.range_rad.pan = (-2.9, 2.9);
    let (done, _, homed) = moved(&rig, PanTilt::default(), 1, |mover| mover.home_by_stops());
    let failure = done.unwrap_err();
    assert!(
        failure.code == "no-stop" && failure.message.contains("pan was turned by 151"),
        "{}",
        failure.message
    );
    assert!(!homed);
}
