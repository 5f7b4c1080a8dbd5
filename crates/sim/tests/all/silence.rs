//! A host that falls silent: dark and waited for, then lost.

#![allow(clippy::print_stdout, reason = "a test shows figures")]

use tracelight_rig::{Command, Darkness, Fault, Phase, Rig};
use tracelight_session::Feeder;
use tracelight_sim::{RigConfig, Run, Simulated, SimulatedRig, arm};
use tracelight_trajectory::Plan;

use crate::dice::Dice;
use crate::shapes::ink::{Ink, ink};
use crate::shapes::{POSE, circle, house, off_mm, plan_of, plan_of_all, star};

/// Ticks of silence that are borne, of silence that is waited for, and of silence that is a fault.
const SILENT: u32 = 50;
const LOST: u32 = 1000;

/// A run whose host says nothing for so many ticks from a tick on.
fn stalled(plan: &Plan, when: u32, silent: u32, seed: u64) -> Run {
    let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, seed);
    let mut feeder = Feeder::new(plan.segments.as_slice(), false);
    let mut ran = Run::default();
    assert!(arm(&mut rig));
    let most = plan.points.len() + silent as usize + 4000;
    while !ran.is_done() && ran.ticks.len() < most {
        if !(when..when + silent).contains(&(ran.ticks.len() as u32)) {
            rig.send(Command::KeepAlive).unwrap();
            feeder.feed(&mut rig);
        }
        ran.ticks.push(rig.step());
        if ran.fault().is_some() && ran.ticks.len() as u32 > when + silent {
            break;
        }
    }
    ran
}

#[test]
fn a_host_that_falls_silent_is_waited_for_in_the_dark_after_50_ms_and_lost_after_a_second() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    let mut dice = Dice::of_seed(5);
    for seed in 0..100 {
        let when = 200 + dice.below(plan.points.len() - 400) as u32;
        let ran = stalled(&plan, when, 1500, seed);
        let (last, silent, lost) = ((when - 1) as usize, SILENT as usize, LOST as usize);
        let told: Vec<_> = ran.ticks.iter().map(|tick| tick.telemetry).collect();
        assert!(told[..last + silent].iter().all(|t| !t.darkness.contains(Darkness::HostSilent)));
        for (at, told) in told[last + silent..(when + 1500) as usize].iter().enumerate() {
            assert!(!told.actuation.gate, "seed {seed}: lit {at} ticks after that");
            assert!(told.darkness.contains(Darkness::HostSilent), "seed {seed}: {at}");
            let lost = at >= lost - silent;
            assert_eq!(told.fault(), lost.then_some(Fault::HostLost), "seed {seed}: {at}");
            assert_eq!(told.actuation.enable, !lost, "seed {seed}: {at}");
            let phases: &[Phase] = if lost { &[Phase::Faulted] } else { &[Phase::Holding, Phase::Testing] };
            assert!(phases.contains(&told.phase), "seed {seed}: {:?} at {at}", told.phase);
        }
    }
}

#[test]
fn who_comes_back_in_time_finds_the_job_going_on_where_its_light_was() {
    let config = RigConfig::report();
    let mut dice = Dice::of_seed(6);
    let plans = [
        ("circle", plan_of(&config, circle(0.2))),
        ("house", plan_of_all(&config, house())),
        ("star", plan_of(&config, star(0.2))),
    ];
    for (name, plan) in plans {
        let before = ink(&plan, &stalled(&plan, 0, 0, 1));
        for silent in [40, 80, 500, 999] {
            let mut worst = Ink::default();
            for seed in 0..25 {
                let when = 200 + dice.below(plan.points.len() - 300) as u32;
                let what = format!("{name}, {silent} ms from {when} on");
                let ran = stalled(&plan, when, silent, seed);
                assert!(ran.is_done() && ran.fault().is_none(), "{what}: {:?}", ran.fault());
                let held = ran.ticks.iter().filter(|t| t.telemetry.phase == Phase::Holding).count();
                assert_eq!(held > 0, silent > SILENT, "{what}: held for {held} ticks");
                let ink = ink(&plan, &ran);
                worst = worst.or_worse(&ink);
                let off = ran.ticks.iter().filter(|t| t.light).map(off_mm).fold(0.0, f64::max);
                assert!(off < 1.0, "{what}: {off} mm");
            }
            println!("{name}, silent for {silent} ms: worst {worst:?}, undisturbed {before:?}");
            assert!(worst.missing_mm <= before.missing_mm + 0.2, "{name}, {silent}: {worst:?} {before:?}");
            assert!(worst.doubled_mm <= 0.5, "{name}, {silent}: {worst:?}");
            assert!(worst.off_mm <= before.off_mm + 0.1, "{name}, {silent}: {worst:?} {before:?}");
        }
    }
}

/// Waiting for a host is no time that a head needs to come back to its stroke.
#[test]
fn who_waits_for_its_host_is_not_late() {
    let mut config = RigConfig::report();
    config.control.hold_limit_s = 0.3;
    let plan = plan_of(&config, circle(0.2));
    let mut rig = SimulatedRig::new(&config, POSE, 0);
    let mut feeder = Feeder::new(plan.segments.as_slice(), false);
    assert!(arm(&mut rig));
    for tick in 0..2500 {
        if !(400..1300).contains(&tick) {
            rig.send(Command::KeepAlive).unwrap();
            feeder.feed(&mut rig);
        }
        let told = rig.step().telemetry;
        assert_eq!(told.fault(), None, "{tick}");
    }
}
