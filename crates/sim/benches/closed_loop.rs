//! What a tick costs: the plant's step, the controller's tick, a whole tick of the closed loop.
//!
//! `cargo bench -p tracelight-sim`. Items are steps or ticks, so the last column reads as steps a second.

use std::hint::black_box;

use divan::Bencher;
use divan::counter::ItemsCount;
use tracelight_aim::HeadPose;
use tracelight_control::{Controller, State};
use tracelight_plant::JointState;
use tracelight_rig::{Command, PanTilt, Rig, Sensed};
use tracelight_sim::{RigConfig, Simulated, SimulatedRig, arm};
use tracelight_stroke::{Drawing, Element, Path, Point, Stroke};
use tracelight_trajectory::{DarkMove, LitSpeed, Plan, PlanRequest, Ramps, Shape, plan};

fn main() {
    divan::main();
}

/// Steps in one measurement.
const STEPS: usize = 100_000;
const POSE: HeadPose = HeadPose::square_on(0.9144);

/// One thread, both axes, Coulomb friction, steps of 1 ms. Runs use ten substeps of 0.1 ms a tick.
#[divan::bench]
fn plant_steps_of_1_ms(bencher: Bencher<'_, '_>) {
    steps(bencher, &RigConfig::report(), 1e-3);
}

/// The same with Stribeck's curve and ripple.
#[divan::bench]
fn worn_plant_steps_of_1_ms(bencher: Bencher<'_, '_>) {
    steps(bencher, &RigConfig::worn(), 1e-3);
}

fn steps(bencher: Bencher<'_, '_>, config: &RigConfig, step_s: f64) {
    let stepper = config.plant_config().stepper(PanTilt::default());
    bencher.counter(ItemsCount::new(STEPS)).bench(|| {
        let mut state = JointState { angle_rad: PanTilt::new(0.0, 0.46), ..JointState::default() };
        for k in 0..STEPS {
            // both axes are driven to and fro past their friction, so that they slide and stick
            let torque = if k & 1024 == 0 { 0.1 } else { -0.1 };
            stepper.step(&mut state, black_box(PanTilt::new(torque, torque - 0.13)), step_s);
        }
        state
    });
}

/// The controller alone: observer, law, interlock, both axes, while it follows a circle.
#[divan::bench]
fn control_tick(bencher: Bencher<'_, '_>) {
    let config = RigConfig::report();
    // who is timed has no host
    let host_silence_ticks = u32::MAX;
    let controller =
        Controller::new(tracelight_control::Config { host_silence_ticks, ..config.control_config() });
    let plan = circle(&config);
    let mut rig = SimulatedRig::new(&config, POSE, 0);
    arm(&mut rig);
    for &segment in plan.segments.iter().take(60) {
        rig.send(Command::Append(segment)).ok();
    }
    // the head's answers are recorded once and played back, so that only the controller is timed
    let heard = |encoders| Sensed { encoders, ..Sensed::default() };
    let sensed: Vec<_> = (0..1000)
        .map(|_| {
            rig.send(Command::KeepAlive).ok();
            heard(rig.step().telemetry.measured)
        })
        .collect();
    bencher.counter(ItemsCount::new(sensed.len())).bench(|| {
        let mut state: State = controller.start_homed(&sensed[0]);
        controller.accept(&mut state, Command::KeepAlive).ok();
        controller.accept(&mut state, Command::Arm { acknowledges: 0 }).ok();
        for &segment in plan.segments.iter().take(60) {
            controller.accept(&mut state, Command::Append(segment)).ok();
        }
        sensed.iter().map(|m| controller.tick(&mut state, black_box(m)).actuation.command_v.pan).sum::<f32>()
    });
}

/// Controller and plant together, ten substeps a tick.
#[divan::bench]
fn closed_loop_tick(bencher: Bencher<'_, '_>) {
    let config = RigConfig::report();
    let plan = circle(&config);
    bencher.counter(ItemsCount::new(1000_usize)).bench(|| {
        let mut rig = SimulatedRig::new(&config, POSE, 0);
        arm(&mut rig);
        for &segment in plan.segments.iter().take(60) {
            rig.send(Command::Append(segment)).ok();
        }
        let lit = |_: &i32| {
            rig.send(Command::KeepAlive).ok();
            rig.step().light
        };
        (0..1000).filter(lit).count()
    });
}

fn circle(config: &RigConfig) -> Plan {
    let mut path = Path::new(Point::new(0.2, 0.0));
    path.push(Element::Arc { centre: Point::ORIGIN, sweep: std::f64::consts::TAU });
    path.close();
    let request = PlanRequest {
        speed_m_s: 0.3048,
        lit_speed: LitSpeed::Fastest,
        travel: DarkMove::Shaped(Shape::Ramped(Ramps::REPORT)),
        ramp_s: config.motion.ramp_s,
        settle_s: config.motion.settle_s,
        tolerance_m: config.control.tolerance_m,
        corner_m: 0.0,
    };
    plan(&Drawing { strokes: vec![Stroke::new(path)] }, &config.machine(POSE), &request).unwrap_or_default()
}
