//! A head that was just powered up: nobody knows where it points, and it stays dark but for dots until it was told.

use std::ops::ControlFlow;

use tracelight_rig::{Command, Darkness, Fault, Joint, PanTilt, Phase, Rig, Segment};
use tracelight_sim::{RigConfig, Run, Simulated, SimulatedRig, Tick, Trouble, arm, run_segments};
use tracelight_trajectory::Plan;

use crate::shapes::{POSE, alive, circle, plan_of, true_counts};

/// Poses that heads were left in, rad.
fn poses() -> Vec<PanTilt<f64>> {
    let mut dice = oorandom::Rand64::new(7);
    let mut angle = |most: f64| most * (2.0 * dice.rand_float() - 1.0);
    (0..20).map(|_| PanTilt::new(angle(0.9), angle(0.6))).collect()
}

fn unhomed(config: &RigConfig, angle_rad: PanTilt<f64>) -> SimulatedRig {
    SimulatedRig::unhomed(config, POSE, angle_rad, 3)
}

fn ticks(rig: &mut SimulatedRig, count: u32) -> Vec<Tick> {
    (0..count).map(|_| alive(rig)).collect()
}

fn drawn(rig: &mut SimulatedRig, plan: &Plan) -> Run {
    run_segments(rig, &plan.segments, false, |_, _| ControlFlow::Continue(()))
}

#[test]
fn a_head_is_held_where_it_was_left_and_draws_nothing() {
    let config = RigConfig::report();
    let plan = plan_of(&config, circle(0.2));
    for pose in poses() {
        let mut rig = unhomed(&config, pose);
        let first = ticks(&mut rig, 500);
        let (begun, held) = (first[0].angle_rad, first[499].angle_rad);
        assert!(Joint::BOTH.iter().all(|&j| (held[j] - begun[j]).abs() < 4e-3), "{pose:?} {held:?}");
        assert_eq!(first[0].telemetry.measured.map(|m| m.count), PanTilt::new(0, 0));
        // its encoders are at zero, wherever that is: a job could begin
        let run = drawn(&mut rig, &plan);
        assert!(run.is_done(), "{pose:?} {:?}", run.fault());
        assert!(run.ticks.iter().all(|t| !t.light && t.telemetry.darkness.contains(Darkness::Unhomed)));
    }
}

#[test]
fn a_dot_of_a_second_is_lit_wherever_it_rests_and_none_while_it_moves() {
    let config = RigConfig::report();
    let plan = plan_of(&config, circle(0.2));
    let mut rig = unhomed(&config, PanTilt::new(-0.4, 0.3));
    assert!(ticks(&mut rig, 300).iter().all(|t| !t.light));
    rig.send(Command::Point(60_000)).unwrap();
    let dot = ticks(&mut rig, 3000);
    let lit: Vec<&Tick> = dot.iter().filter(|t| t.light).collect();
    assert!((985..=1010).contains(&lit.len()), "{}", lit.len());
    let (first, last) = (lit[0].spot.unwrap(), lit[lit.len() - 1].spot.unwrap());
    assert!(first.distance(last) < 2e-3, "{first} {last}");
    // somebody who asks in every tick gets no more, and not soon
    let again: Vec<Tick> = (0..15_000)
        .map(|_| {
            rig.send(Command::Point(60_000)).unwrap();
            alive(&mut rig)
        })
        .collect();
    let longest = again.split(|t| !t.light).map(<[Tick]>::len).max().unwrap();
    assert!((985..=1010).contains(&longest), "{longest}");
    // armed it moves, and lights nothing
    ticks(&mut rig, 1100);
    assert!(arm(&mut rig));
    rig.send(Command::Point(1000)).unwrap();
    let run = run_segments(&mut rig, &plan.segments, false, |rig, _| {
        rig.send(Command::Point(1000)).unwrap();
        ControlFlow::Continue(())
    });
    assert!(run.is_done() && run.ticks.iter().all(|t| !t.light));
}

#[test]
fn a_head_that_was_told_where_it_stands_draws_as_one_that_always_knew() {
    let config = RigConfig::report();
    let plan = plan_of(&config, circle(0.2));
    for pose in poses() {
        let mut rig = unhomed(&config, pose);
        let last = *ticks(&mut rig, 300).last().unwrap();
        rig.send(Command::Home(true_counts(&config, &last))).unwrap();
        rig.send(Command::Abandon).unwrap();
        let home = *ticks(&mut rig, 3000).last().unwrap();
        assert!(Joint::BOTH.iter().all(|&j| home.angle_rad[j].abs() < 2e-3), "{pose:?} {:?}", home.angle_rad);
        assert_eq!(home.telemetry.fault(), None);
        let run = drawn(&mut rig, &plan);
        assert!(run.is_done(), "{pose:?} {:?}", run.fault());
        let lit: Vec<&Tick> = run.ticks.iter().filter(|t| t.light).collect();
        let off = lit.iter().map(|t| t.spot.unwrap().distance(t.asked.unwrap())).fold(0.0, f64::max);
        assert!(lit.len() > 1000 && off < 1.5e-3, "{pose:?} {off}");
    }
}

#[test]
fn an_armed_head_is_not_homed_and_counts_go_on_from_where_it_was() {
    let config = RigConfig::report();
    let mut rig = unhomed(&config, PanTilt::new(0.2, -0.1));
    ticks(&mut rig, 100);
    assert!(arm(&mut rig));
    let home = Command::Home(PanTilt::new(100, -50));
    assert_eq!(rig.send(home), Err(home));
    rig.send(Command::Disarm).unwrap();
    rig.send(home).unwrap();
    let now = rig.step().telemetry;
    assert_eq!((now.phase, now.measured.map(|m| m.count)), (Phase::Dark, PanTilt::new(100, -50)));
    assert!(!now.darkness.contains(Darkness::Unhomed) && now.darkness.contains(Darkness::Disarmed));
    // once more, by a count
    rig.send(Command::Home(PanTilt::new(101, -50))).unwrap();
    assert_eq!(rig.step().telemetry.measured.map(|m| m.count), PanTilt::new(101, -50));
    // where no joint can be it is not, and on its way it is nowhere
    for absurd in [PanTilt::new(i32::MAX, 0), PanTilt::new(0, i32::MIN), PanTilt::new(0, 2000)] {
        assert_eq!(rig.send(Command::Home(absurd)), Err(Command::Home(absurd)));
    }
    rig.send(Command::Abandon).unwrap();
    let moving = ticks(&mut rig, 100).last().unwrap().rate_rad_s;
    assert!(moving.pan.abs().max(moving.tilt.abs()) > 0.05, "{moving:?}");
    assert_eq!(rig.send(home), Err(home));
    rig.send(Command::Unhome).unwrap();
    assert!(rig.step().telemetry.darkness.contains(Darkness::Unhomed));
}

#[test]
fn an_unhomed_head_goes_as_far_round_as_its_range_is_wide_and_ends_at_its_stops() {
    let mut config = RigConfig::report();
    let range = PanTilt::new((-0.4, 1.2), (-0.9, 0.9));
    (config.model.geometry.range_rad, config.truth.model.geometry.range_rad) = (range, range);
    let sent = |to_rad: f32| {
        let mut rig = unhomed(&config, PanTilt::new(1.0, 0.0));
        let pan = [0.0, 0.0, 0.0, 10.0 * to_rad / 8e9, -15.0 * to_rad / 16e12, 6.0 * to_rad / 32e15];
        let segment = Segment {
            start_tick: 0,
            ticks: 2000,
            coefficients: PanTilt::new(pan, [0.0; 6]),
            tolerance_rad: PanTilt::new(0.05, 0.05),
            gate: false,
            rate_limit: tracelight_rig::RateLimit::PLANNED,
        };
        run_segments(&mut rig, &[segment], false, |_, _| ControlFlow::Continue(()))
    };
    // from 1.0 to -0.3 rad: by its counts further than its range goes
    let free = sent(-1.3);
    assert!(free.is_done(), "{:?}", free.fault());
    assert!((free.ticks.last().unwrap().angle_rad.pan + 0.3).abs() < 3e-3);
    // to 1.4 rad, where none can be
    let stopped = sent(0.4);
    let furthest = stopped.ticks.iter().map(|t| t.angle_rad.pan).fold(0.0, f64::max);
    assert!(stopped.fault().is_some() && (1.2..1.24).contains(&furthest), "{:?} {furthest}", stopped.fault());
    // to its stops it may go, which lie beyond its range, and further it is not asked to
    assert_ne!(sent(-1.7).fault(), Some(Fault::SetpointInvalid));
    assert_eq!(sent(-1.9).fault(), Some(Fault::SetpointInvalid));
}

#[test]
fn a_rig_that_loses_power_while_it_draws_is_dark_and_says_that_it_is_not_homed() {
    let config = RigConfig::report();
    let plan = plan_of(&config, circle(0.2));
    let mut rig = SimulatedRig::new(&config, POSE, 3);
    let mut lit_before = 0;
    let run = run_segments(&mut rig, &plan.segments, false, |rig, tick| {
        lit_before += usize::from(tick.light && tick.telemetry.homed);
        if lit_before == 200 {
            rig.suffer(Trouble::PowerLoss);
            lit_before += 1;
        }
        ControlFlow::Continue(())
    });
    let lost = run.ticks.iter().position(|t| !t.telemetry.homed).unwrap();
    let (before, after) = run.ticks.split_at(lost);
    assert!(before.iter().all(|t| t.telemetry.homed));
    assert!(after.iter().all(|t| !t.telemetry.homed && !t.telemetry.actuation.gate));
    assert_eq!((after[0].telemetry.tick, after[0].telemetry.measured.pan.count), (0, 0));
    // the relay opens as late as ever, while the head goes on for a moment
    let dark_after = after.iter().rposition(|t| t.light).map_or(0, |last| last + 1);
    assert!(dark_after < 20 && after.len() > 100, "{dark_after} of {}", after.len());
}
