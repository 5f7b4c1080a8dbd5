//! The plan's clock at other speeds, paused and resumed.

#![allow(clippy::print_stdout, reason = "a test shows figures")]

use std::ops::ControlFlow;

use tracelight_rig::{Command, PanTilt, Phase, Rig};
use tracelight_session::Feeder;
use tracelight_sim::{RigConfig, Run, Simulated, SimulatedRig, Tick, arm, run, score};
use tracelight_trajectory::Plan;

use crate::dice::Dice;
use crate::shapes::ink::{Ink, ink};
use crate::shapes::{POSE, SPEED_M_S, alive, circle, house, off_mm, plan_of, plan_of_all, star};

/// The laser changes at a tick, at the nearest to where a line begins or ends: at 1 ft/s that is so far off, mm, and what counts places adds its step.
const HALF_TICK_MM: f64 = 0.18;

fn plans(config: &RigConfig) -> [(&'static str, Plan); 3] {
    [
        ("circle", plan_of(config, circle(0.2))),
        ("house", plan_of_all(config, house())),
        ("star", plan_of(config, star(0.2))),
    ]
}

/// A run whose clock is asked for another rate where it reaches these ticks of the plan; ten times as long as planned at most.
pub(crate) fn at_speeds(config: &RigConfig, plan: &Plan, speeds: &[(u32, f32)]) -> Run {
    let mut rig = SimulatedRig::new(config, POSE, 1);
    let mut feeder = Feeder::new(plan.segments.as_slice(), false);
    assert!(arm(&mut rig));
    let (mut next, mut ran) = (0, Run::default());
    while !ran.is_done() && ran.fault().is_none() && ran.ticks.len() < 11 * plan.points.len() {
        if let Some(&(at, rate)) = speeds.get(next)
            && rig.told().plan_tick >= at
        {
            rig.send(Command::Speed(rate)).unwrap();
            next += 1;
        }
        feeder.feed(&mut rig);
        ran.ticks.push(alive(&mut rig));
    }
    ran
}

/// The largest share of what the plan may use of a motor's torque that a tick asks for.
fn torque_share(config: &RigConfig, ticks: &[Tick]) -> f64 {
    let machine = config.machine(POSE);
    let share = |tick: &Tick| {
        let of = |value: fn(&tracelight_rig::Setpoint) -> f32| {
            let PanTilt { pan, tilt } = &tick.telemetry.setpoint;
            PanTilt::new(f64::from(value(pan)), f64::from(value(tilt)))
        };
        let torque =
            machine.torque(of(|s| s.position_rad), of(|s| s.velocity_rad_s), of(|s| s.acceleration_rad_s2));
        let share = machine.fraction(torque);
        share.pan.abs().max(share.tilt.abs())
    };
    ticks.iter().map(share).fold(0.0, f64::max)
}

#[test]
fn at_any_speed_motors_keep_their_limits_and_light_its_lines() {
    let config = RigConfig::report();
    for (name, plan) in plans(&config) {
        let length = plan.points.len() as u32;
        let usual = at_speeds(&config, &plan, &[]);
        let planned = torque_share(&config, &usual.ticks);
        let (before, usual_s) = (ink(&plan, &usual), usual.ticks.len() as f64 * 1e-3);
        // 10 % to 200 % and back, in twenty steps
        let sweep: Vec<(u32, f32)> =
            (0..20).map(|k| (k * length / 20, 0.1 + 1.9 * (1.0 - (k as f32 - 9.5).abs() / 9.5))).collect();
        for (what, speeds) in [
            ("10 %", vec![(0, 0.1)]),
            ("50 %", vec![(0, 0.5)]),
            ("200 %", vec![(0, 2.0)]),
            ("10 to 200 to 10 %", sweep),
        ] {
            let ran = at_speeds(&config, &plan, &speeds);
            assert!(ran.is_done(), "{name} at {what}: {:?}", ran.fault());
            let rms_mm = score(&plan, &ran, SPEED_M_S).rms_mm;
            let share = torque_share(&config, &ran.ticks);
            let ink = ink(&plan, &ran);
            println!(
                "{name:6} at {what:17}: {:5.1} s ({usual_s:4.1}), torque {:.2} of the limit ({planned:.2} planned), rms {rms_mm:.4} mm, missing {:.2} ({:.2}), off {:.3} mm ({:.3})",
                ran.ticks.len() as f64 * 1e-3,
                share,
                ink.missing_mm,
                before.missing_mm,
                ink.off_mm,
                before.off_mm,
            );
            assert!(share <= 1.0, "{name} at {what}: {share}");
            assert!(rms_mm <= 0.05, "{name} at {what}: {rms_mm} mm");
            assert!(
                ink.missing_mm <= before.missing_mm + 2.0 * HALF_TICK_MM,
                "{name} at {what}: {ink:?} {before:?}"
            );
        }
    }
}

/// How a run that was stopped once went.
pub(crate) struct Stopped {
    pub(crate) ran: Run,
    /// From the command to the first tick whose gate is shut, ticks, and to the stop.
    pub(crate) dark_after: usize,
    /// Where the plan's clock stood.
    at: u32,
}

/// Stops a run by a command where its clock reaches a tick of the plan, and arms it again once it has rested.
pub(crate) fn stopped_at(config: &RigConfig, plan: &Plan, when: u32, stop: Command, seed: u64) -> Stopped {
    const REST_TICKS: usize = 300;
    let mut rig = SimulatedRig::new(config, POSE, seed);
    let (mut told, mut rests, mut ticks, mut dark_after, mut at) = (None, 0, 0, None, 0);
    let ran = run(&mut rig, plan, false, |rig, tick| {
        ticks += 1;
        if told.is_none() && tick.telemetry.plan_tick >= when {
            told = Some(ticks);
            rig.send(stop).unwrap();
        } else if let Some(told) = told {
            let is_stopped = tick.telemetry.phase == Phase::Dark;
            if !tick.telemetry.actuation.gate && dark_after.is_none() {
                dark_after = Some(ticks - told);
            }
            if is_stopped && rests < REST_TICKS {
                rests += 1;
                at = tick.telemetry.plan_tick;
                if rests == REST_TICKS {
                    assert!(arm(rig));
                }
            }
        }
        ControlFlow::Continue(())
    });
    Stopped { ran, dark_after: dark_after.unwrap_or(0), at }
}

fn check_stops(stop: Command, most_dark_after: Option<usize>, times: usize) {
    let config = RigConfig::report();
    let mut dice = Dice::of_seed(42);
    for (name, plan) in plans(&config) {
        let mut rig = SimulatedRig::new(&config, POSE, 1);
        let before = ink(&plan, &run(&mut rig, &plan, false, |_, _| ControlFlow::Continue(())));
        let mut worst = Ink::default();
        for k in 0..times {
            let when = 200 + dice.below(plan.points.len() - 900) as u32;
            let Stopped { ran, dark_after, at } = stopped_at(&config, &plan, when, stop, 1 + (k % 7) as u64);
            assert!(ran.is_done(), "{name} at {when}: {:?}", ran.fault());
            assert!(
                most_dark_after.is_none_or(|most| dark_after <= most),
                "{name} at {when}: {dark_after} ticks"
            );
            let interrupted = most_dark_after.is_none() && plan.points[at as usize].lit;
            assert!(!interrupted, "{name} at {when}: stopped at {at} on a stroke");
            let ink = ink(&plan, &ran);
            worst = worst.or_worse(&ink);
            let off = ran.ticks.iter().filter(|t| t.light).map(off_mm).fold(0.0, f64::max);
            assert!(off < 1.0, "{name} at {when}: {off} mm");
        }
        println!("{name}, {stop:?} {times} times: worst {worst:?}, undisturbed {before:?}");
        assert!(worst.missing_mm <= before.missing_mm + HALF_TICK_MM, "{name}: {worst:?} {before:?}");
        assert!(worst.doubled_mm <= 0.5, "{name}: {worst:?}");
        assert!(worst.off_mm <= before.off_mm + 0.1, "{name}: {worst:?} {before:?}");
    }
}

#[test]
fn stopped_at_once_it_is_dark_in_the_next_tick_and_goes_on_where_the_light_was() {
    check_stops(Command::Disarm, Some(1), 60);
}

#[test]
fn stopped_on_its_way_it_moves_a_little_in_the_dark_before_it_lights_again() {
    let config = RigConfig::report();
    let plan = plan_of(&config, star(0.2));
    for when in [600, 1500, 2400] {
        let Stopped { ran, .. } = stopped_at(&config, &plan, when, Command::Disarm, 3);
        assert!(ran.is_done(), "{when}: {:?}", ran.fault());
        let stopped = ran.ticks.iter().rposition(|tick| tick.telemetry.phase == Phase::Dark).unwrap();
        let rest = &ran.ticks[stopped..];
        let lights = |tick: &Tick| tick.light || tick.telemetry.actuation.lights();
        let lit = rest.iter().position(lights).unwrap();
        let test_move = rest[..lit].iter().filter(|tick| tick.telemetry.phase == Phase::Testing).count();
        assert!(test_move > 100, "{when}: {test_move} ticks of a test move in the {lit} dark ones");
    }
}

#[test]
fn paused_it_draws_its_stroke_to_the_end() {
    check_stops(Command::Pause, None, 40);
}
