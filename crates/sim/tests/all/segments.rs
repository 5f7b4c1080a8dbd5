//! Segments are checked, not believed: whatever leaves its bounds anywhere is refused before it is run, and no plan ever is.

#![allow(clippy::print_stdout, reason = "a test shows figures")]

use std::ops::ControlFlow;

use tracelight_rig::{Command, Fault, Joint, PanTilt, Rig, Segment};
use tracelight_sim::{RigConfig, Simulated, SimulatedRig, Tick, arm};
use tracelight_stroke::{Drawing, Path, Stroke};
use tracelight_trajectory::{DarkMove, LitSpeed, Plan, PlanRequest, Ramps, Shape, plan};

use crate::shapes::{POSE, alive, circle, line, plan_of, star};

/// From zero to an angle and back in so many ticks, lit.
fn there_and_back(to_rad: f32, ticks: u16) -> Segment {
    let n = f32::from(ticks);
    let bend = to_rad / (n * n);
    Segment {
        start_tick: 0,
        ticks,
        coefficients: PanTilt::new([0.0, 4.0 * bend * n, -4.0 * bend, 0.0, 0.0, 0.0], [0.0; 6]),
        tolerance_rad: PanTilt::new(0.003, 0.003),
        gate: true,
        rate_limit: tracelight_rig::RateLimit::PLANNED,
    }
}

/// What a rig makes of a segment.
fn sent(segment: Segment) -> Vec<Tick> {
    let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, 0);
    assert!(arm(&mut rig));
    rig.send(Command::Append(segment)).unwrap();
    rig.send(Command::Finish).unwrap();
    (0..400).map(|_| alive(&mut rig)).collect()
}

fn check_refused(segment: Segment, what: &str) {
    let ticks = sent(segment);
    assert!(ticks.iter().all(|t| t.telemetry.fault() == Some(Fault::SetpointInvalid)), "{what}");
    assert!(ticks.iter().all(|t| !t.telemetry.actuation.gate && !t.light), "{what}: lit");
    let most_v = ticks.iter().map(|t| t.telemetry.actuation.command_v.pan.abs()).fold(0.0, f32::max);
    assert!(most_v < 1.0, "{what}: {most_v} V");
}

#[test]
fn what_is_wild_between_its_ends_is_refused() {
    for to_rad in [1.0, 3.0, 100.0, 1e30] {
        check_refused(there_and_back(to_rad, 100), &format!("to {to_rad} rad in 50 ms"));
    }
    // slow, and out of its range halfway
    let (_, upper) = RigConfig::report().model.geometry.range_rad.pan;
    check_refused(there_and_back(upper as f32 + 0.05, 8000), "out of its range");
    assert_eq!(sent(there_and_back(0.01, 400))[0].telemetry.fault(), None);
}

#[test]
fn what_may_stray_as_it_likes_is_refused() {
    for tolerance in [1e30, 1.0, 0.11, f32::INFINITY, f32::NAN, 0.0, -1.0] {
        for both in [PanTilt::new(tolerance, 0.003), PanTilt::new(0.003, tolerance)] {
            let segment = Segment { tolerance_rad: both, ..there_and_back(0.01, 400) };
            check_refused(segment, &format!("{tolerance} rad"));
        }
    }
    let plan = plan_of(&RigConfig::report(), circle(0.1));
    let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, 0);
    assert!(arm(&mut rig));
    rig.send(Command::Append(Segment { tolerance_rad: PanTilt::new(1e30, 1e30), ..plan.segments[0] }))
        .unwrap();
    assert_eq!(rig.step().telemetry.fault(), Some(Fault::SetpointInvalid));
}

fn planned(config: &RigConfig, path: Path, speed_m_s: f64, lit_speed: LitSpeed, travel: DarkMove) -> Plan {
    let request = PlanRequest {
        speed_m_s,
        lit_speed,
        travel,
        ramp_s: config.motion.ramp_s,
        settle_s: config.motion.settle_s,
        tolerance_m: config.control.tolerance_m,
        corner_m: 0.0,
    };
    let strokes = vec![Stroke::new(path), Stroke::new(line(-0.1)), Stroke::new(line(0.2))];
    plan(&Drawing { strokes }, &config.machine(POSE), &request).unwrap()
}

/// The most of its bounds on speed and on acceleration that a plan takes up.
fn most_taken_up(config: &RigConfig, plan: &Plan) -> (f32, f32) {
    let axes = config.control_config().axes;
    let (mut speed, mut acceleration) = (0.0f32, 0.0f32);
    for segment in &plan.segments {
        for i in 0..=4 * segment.ticks {
            let at = segment.sample(f32::from(i) / 4.0);
            for j in Joint::BOTH {
                speed = speed.max(at[j].velocity_rad_s.abs() / axes[j].limits.speed_rad_s);
                acceleration =
                    acceleration.max(at[j].acceleration_rad_s2.abs() / axes[j].limits.acceleration_rad_s2);
            }
        }
    }
    (speed, acceleration)
}

/// The rig takes every segment of a plan: it is moved through them as fast as it takes them, whatever becomes of its head.
fn check_taken(config: &RigConfig, plan: &Plan, what: &str) {
    let mut rig = SimulatedRig::new(config, POSE, 0);
    let run = tracelight_sim::run(&mut rig, plan, true, |_, _| ControlFlow::Continue(()));
    assert_ne!(run.fault(), Some(Fault::SetpointInvalid), "{what}");
}

#[test]
fn no_plan_is_refused() {
    let mut tight = RigConfig::report();
    tight.motion.speed_limit_rad_s = PanTilt::new(1.5, 1.0);
    tight.motion.acceleration_limit_rad_s2 = PanTilt::new(8.0, 6.0);
    let mut strong = RigConfig::report();
    strong.model.motors = strong.model.motors.map(|mut motor| {
        motor.torque_nm_per_v *= 12.0;
        motor
    });
    strong.truth.model.motors = strong.model.motors;
    let rigs = [
        ("report", RigConfig::report()),
        ("worn", RigConfig::worn()),
        ("tight limits", tight),
        ("strong motors", strong),
    ];
    for (name, config) in rigs {
        let mut most = (0.0f32, 0.0f32);
        for travel in [DarkMove::Shaped(Shape::Ramped(Ramps::REPORT)), DarkMove::Optimal] {
            for lit_speed in [LitSpeed::Exact, LitSpeed::Fastest] {
                for speed_m_s in [0.05, 0.3048, 2.0] {
                    for path in [circle(0.2), star(0.2)] {
                        let plan = planned(&config, path, speed_m_s, lit_speed, travel);
                        let now = most_taken_up(&config, &plan);
                        most = (most.0.max(now.0), most.1.max(now.1));
                        check_taken(&config, &plan, &format!("{name}, {speed_m_s} m/s, {lit_speed:?}"));
                    }
                }
            }
        }
        println!("{name}: up to {:.4} of the speed bound, {:.4} of the acceleration bound", most.0, most.1);
    }
}
