//! Heads without encoders: they follow their pulses, lose steps unseen, and stop for safety as others do.

#![allow(clippy::print_stdout, reason = "a test shows figures")]

use std::ops::ControlFlow;

use tracelight_dynamics::Friction;
use tracelight_rig::{Command, Fault, Input, InputState, Joint, PanTilt, Rig};
use tracelight_sim::{RigConfig, Run, Simulated, SimulatedRig, Trouble, arm, run, score};
use tracelight_trajectory::Plan;

use crate::dice::Dice;
use crate::paces::{at_speeds, stopped_at};
use crate::shapes::{POSE, circle, house, plan_of, plan_of_all, star};

fn ran(rig: &RigConfig, plan: &Plan) -> (Run, SimulatedRig) {
    let mut simulated = SimulatedRig::new(rig, POSE, 1);
    let run = run(&mut simulated, plan, false, |_, _| ControlFlow::Continue(()));
    (run, simulated)
}

#[test]
fn a_stepper_head_draws_to_a_microstep_and_loses_none() {
    let rig = RigConfig::stepper();
    for path in [star(0.2), circle(0.2)] {
        let plan = plan_of(&rig, path);
        let (run, simulated) = ran(&rig, &plan);
        assert!(run.is_done(), "{:?}", run.fault());
        assert_eq!(simulated.lost_steps(), PanTilt::default());
        let tracking = score(&plan, &run, plan.set_speed_m_s);
        println!("stepper: {tracking:?}");
        let microstep_mm = 1e3 * POSE.distance_m * rig.drive.stepper.microstep_rad();
        // load turns the rotor, and a joint away from the middle moves the spot by more
        assert!(tracking.rms_mm > 0.1 * microstep_mm && tracking.rms_mm < 2.0 * microstep_mm, "{tracking:?}");
        assert!(tracking.max_mm < 5.0 * microstep_mm, "{tracking:?}");
    }
}

#[test]
fn a_servo_head_draws_with_errors_of_its_dead_band() {
    let rig = RigConfig::servo();
    let plan = plan_of(&rig, circle(0.2));
    let (run, _) = ran(&rig, &plan);
    assert!(run.is_done(), "{:?}", run.fault());
    let dead_mm = 1e3 * POSE.distance_m * rig.drive.servo.resolution_rad();
    let tracking = score(&plan, &run, plan.set_speed_m_s);
    println!("servo, dead band {dead_mm:.2} mm: {tracking:?}");
    // each joint is off by its dead band and half of its play, and by nothing for being late: its pulses are sent early
    let expected_mm = dead_mm + 0.5e3 * POSE.distance_m * rig.drive.servo.play_rad;
    assert!(tracking.rms_mm > dead_mm && tracking.max_mm < 1.42 * expected_mm, "{tracking:?} {expected_mm}");
    // the controller sees the commanded angle, which is where it wants it
    let far = run
        .ticks
        .iter()
        .map(|tick| (f64::from(tick.telemetry.setpoint.pan.position_rad) - tick.angle_rad.pan).abs());
    assert!(far.fold(0.0, f64::max) > rig.drive.servo.resolution_rad());
}

#[test]
fn too_much_torque_loses_steps_and_the_telemetry_does_not_know() {
    let rig = RigConfig::stepper();
    let mut weak = rig.clone();
    // a driver whose current was set far too low
    weak.drive.stepper.holding_torque_nm *= 0.03;
    let plan = plan_of(&rig, star(0.2));
    let (run, simulated) = ran(&weak, &plan);
    let lost = simulated.lost_steps();
    assert!(lost.pan != 0 || lost.tilt != 0, "{lost:?}");
    assert!(run.is_done() && run.fault().is_none(), "no head without encoders can tell: {:?}", run.fault());
    let tracking = score(&plan, &run, plan.set_speed_m_s);
    assert!(
        tracking.final_error_mm > 1e3 * POSE.distance_m * 0.5 * rig.drive.stepper.full_step_rad(),
        "{tracking:?}"
    );
    for tick in &run.ticks[1..] {
        for joint in Joint::BOTH {
            let counted = f64::from(tick.telemetry.measured[joint].count) * rig.model.encoder.count_rad();
            let asked = f64::from(tick.telemetry.setpoint[joint].position_rad);
            assert!((counted - asked).abs() < 0.03, "counts are of the commanded angle: {counted} {asked}");
        }
    }
}

#[test]
fn a_head_that_is_leant_on_beyond_its_torque_loses_steps_and_one_that_is_not_does_not() {
    let rig = RigConfig::stepper();
    let plan = plan_of(&rig, circle(0.2));
    // 1.08 N m at the joint
    for (push_nm, loses) in [(0.8, false), (1.3, true)] {
        let mut simulated = SimulatedRig::new(&rig, POSE, 1);
        let run = run(&mut simulated, &plan, false, |rig, tick| {
            let pushed = (600..700).contains(&tick.telemetry.plan_tick);
            rig.suffer(Trouble::Push(PanTilt::new(if pushed { push_nm } else { 0.0 }, 0.0)));
            ControlFlow::Continue(())
        });
        assert!(run.is_done());
        assert_eq!(simulated.lost_steps().pan != 0, loses, "{push_nm} N m");
    }
}

/// How far behind its pulses a head ends, full steps: what is lost stays.
fn lost_by_the_end(rig: &RigConfig, run: &Run) -> f64 {
    let last = run.ticks.last().unwrap();
    let off = |j: Joint| f64::from(last.telemetry.setpoint[j].position_rad) - last.angle_rad[j];
    off(Joint::Pan).abs().max(off(Joint::Tilt).abs()) / rig.drive.stepper.full_step_rad()
}

#[test]
fn stopped_at_any_moment_it_slows_down_loses_no_step_and_goes_on_where_the_light_was() {
    let rig = RigConfig::stepper();
    let plan = plan_of_all(&rig, house());
    let mut dice = Dice::of_seed(5);
    for k in 0..40 {
        let when = 100 + dice.below(plan.points.len() - 700) as u32;
        let stopped = stopped_at(&rig, &plan, when, Command::Disarm, k);
        assert!(stopped.ran.is_done() && stopped.dark_after <= 1, "{when}: {} ticks", stopped.dark_after);
        assert!(lost_by_the_end(&rig, &stopped.ran) < 1.0, "at {when}");
        let tracking = score(&plan, &stopped.ran, plan.set_speed_m_s);
        assert!(tracking.off_stroke_max_mm < 3.0, "at {when}: {tracking:?}");
    }
}

#[test]
fn at_any_speed_of_the_plan_it_loses_no_step() {
    let rig = RigConfig::stepper();
    let plan = plan_of_all(&rig, house());
    let length = plan.points.len() as u32;
    let sweep: Vec<(u32, f32)> = (0..20).map(|k| (k * length / 20, [0.1, 2.0][k as usize % 2])).collect();
    for speeds in [vec![(0, 0.1)], vec![(0, 2.0)], sweep] {
        let ran = at_speeds(&rig, &plan, &speeds);
        assert!(ran.is_done() && lost_by_the_end(&rig, &ran) < 1.0, "{speeds:?}: {:?}", ran.fault());
    }
}

#[test]
fn homed_elsewhere_it_draws_there_and_keeps_its_place_meanwhile() {
    let rig = RigConfig::stepper();
    let start = PanTilt::new(0.05, -0.4);
    let mut simulated = SimulatedRig::unhomed(&rig, POSE, start, 3);
    simulated.step();
    let before = simulated.step().angle_rad;
    let counts = simulated.true_counts();
    simulated.send(Command::Home(counts)).unwrap();
    let after = simulated.step();
    let step_rad = rig.drive.stepper.microstep_rad();
    for j in Joint::BOTH {
        assert!((after.angle_rad[j] - before[j]).abs() < 1e-9, "a new name for a place moves nothing");
        let believed = f64::from(after.telemetry.position_rad[j]);
        assert!((believed - after.angle_rad[j]).abs() < step_rad, "{believed} {after:?}");
    }
    simulated.send(Command::Abandon).unwrap();
    let last = (0..2000).map(|_| simulated.step()).last().unwrap();
    for j in Joint::BOTH {
        assert!(last.telemetry.position_rad[j].abs() < 1e-4, "{last:?}");
        assert!(last.angle_rad[j].abs() < 2.0 * step_rad, "{last:?}");
    }
}

#[test]
fn what_cuts_the_motors_leaves_nobody_who_knows_where_the_joints_are() {
    for rig in [RigConfig::stepper(), RigConfig::servo()] {
        let plan = plan_of(&rig, circle(0.2));
        let mut simulated = SimulatedRig::new(&rig, POSE, 1);
        let mut stopped = None;
        let run = run(&mut simulated, &plan, false, |rig, tick| {
            if tick.light && stopped.is_none() && tick.telemetry.plan_tick > 500 {
                rig.suffer(Trouble::Input(Input::EmergencyStop, InputState::Open));
                stopped = Some(tick.telemetry.tick);
            }
            ControlFlow::Continue(())
        });
        let at = stopped.expect("it was lit");
        assert_eq!(run.fault(), Some(Fault::EmergencyStop), "{}", rig.name);
        let late = run.ticks.iter().filter(|tick| tick.telemetry.tick > at + 8 && tick.light).count();
        assert_eq!(late, 0, "{}", rig.name);
        // arming alone brings no light back
        simulated.suffer(Trouble::Input(Input::EmergencyStop, InputState::Fine));
        simulated.step();
        assert!(arm(&mut simulated));
        for _ in 0..2000 {
            simulated.send(Command::KeepAlive).unwrap();
            let tick = simulated.step();
            assert!(!tick.light && !tick.telemetry.homed, "{}: {tick:?}", rig.name);
        }
    }
}

#[test]
fn a_head_near_its_limit_comes_back_without_a_lost_step() {
    let mut rig = RigConfig::stepper();
    for model in [&mut rig.model, &mut rig.truth.model] {
        model.friction = PanTilt::from_fn(|_| Friction::symmetric(0.001, 0.7));
    }
    rig.motion.torque_share = 0.95;
    rig.motion.acceleration_limit_rad_s2 = PanTilt::new(1e4, 1e4);
    let plan = plan_of_all(&rig, house());
    let mut dice = Dice::of_seed(9);
    for k in 0..30 {
        let when = 100 + dice.below(plan.points.len() - 300) as u32;
        let mut simulated = SimulatedRig::new(&rig, POSE, k);
        let mut told = false;
        run(&mut simulated, &plan, false, |rig, tick| {
            if !told && tick.telemetry.plan_tick >= when {
                told = true;
                // forgets everything and goes home
                rig.send(if k % 2 == 0 { Command::Abandon } else { Command::Disarm }).unwrap();
            }
            ControlFlow::Continue(())
        });
        for _ in 0..3000 {
            simulated.step();
        }
        assert_eq!(simulated.lost_steps(), PanTilt::default(), "at {when}");
    }
}

#[test]
fn a_joint_that_never_moves_is_told_of() {
    let rig = RigConfig::stepper();
    let mut stuck = rig.clone();
    stuck.truth.model.friction.tilt = Friction::symmetric(0.0, 5.0);
    let plan = plan_of(&rig, star(0.2));
    let mut simulated = SimulatedRig::new(&stuck, POSE, 1);
    let mut furthest = 0;
    run(&mut simulated, &plan, false, |rig, _| {
        furthest = furthest.max(rig.lost_steps().tilt.abs());
        ControlFlow::Continue(())
    });
    assert!(furthest >= 4, "{furthest}");
}

#[test]
fn the_expected_error_grows_with_the_distance() {
    assert!(RigConfig::worn().open_loop_remarks(1.0, 0.3).is_empty());
    let [believed, near] = &RigConfig::servo().open_loop_remarks(1.0, 0.3)[..] else { panic!("two remarks") };
    assert!(believed.contains("nobody measured"), "{believed}");
    // 5 us of 2000 over 180 degrees are 0.45 degrees, 7.85 mm at a metre; 20 ms at 0.3 m/s are 6 mm
    assert!(near.contains("7.9 mm (0.45 degrees)") && near.contains("3.0 mm half of the way"), "{near}");
    assert!(near.contains("expect up to 15.2 mm"), "{near}");
    let far = &RigConfig::servo().open_loop_remarks(2.0, 0.3)[1];
    assert!(far.contains("15.7 mm (0.45 degrees)"), "{far}");
    // 360 / (200 × 16 × 3) degrees are 0.65 mm
    let stepper = &RigConfig::stepper().open_loop_remarks(1.0, 0.3)[1];
    assert!(stepper.contains("0.33 mm is half a microstep"), "{stepper}");
}

#[test]
fn no_spot_is_further_off_than_was_expected() {
    for (rig, friction_nm) in
        [(RigConfig::stepper(), 0.03), (RigConfig::stepper(), 0.5), (RigConfig::servo(), 0.03)]
    {
        let mut rig = rig;
        for model in [&mut rig.model, &mut rig.truth.model] {
            model.friction = PanTilt::from_fn(|_| Friction::symmetric(0.001, friction_nm));
        }
        let plan = plan_of(&rig, star(0.2));
        let (run, _) = ran(&rig, &plan);
        let remark = &rig.open_loop_remarks(POSE.distance_m, plan.set_speed_m_s)[1];
        let told = remark.split_whitespace().nth(3).unwrap();
        let told_mm: f64 = told.parse().unwrap();
        // of both joints, and away from the middle a joint moves the spot by more
        let tracking = score(&plan, &run, plan.set_speed_m_s);
        assert!(tracking.max_mm < 1.6 * told_mm && tracking.max_mm > 0.3 * told_mm, "{remark}: {tracking:?}");
    }
}
