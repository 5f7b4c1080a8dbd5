//! Somebody bumps into what the head stands on: with a gyroscope on the foot no light falls astray, whatever the bump; without one encoders feel the
//! large ones.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on may panic, and shows figures"
)]

use std::ops::ControlFlow;

use tracelight_plant::FootConfig;
use tracelight_rig::{Darkness, Fault, PanTilt, Phase};
use tracelight_sim::{RigConfig, Run, SimulatedRig, Spread, Trouble, run};
use tracelight_trajectory::Plan;

use crate::shapes::{POSE, circle, lit_ticks, off_mm, plan_of, star};

const MOMENTS: u64 = 50;

fn with_gyroscope() -> RigConfig {
    let mut rig = RigConfig::report();
    rig.truth.gyroscope.fitted = true;
    rig
}

/// The same on a light tripod that swings eight times a second, which is believed to be a little different.
fn on_a_tripod() -> RigConfig {
    let mut rig = with_gyroscope();
    rig.truth.model.foot = FootConfig { resonance_hz: 8.0, ..FootConfig::FIRM };
    rig.model.foot = FootConfig { resonance_hz: 7.5, inertia_kg_m2: 0.055, ..FootConfig::FIRM };
    rig
}

/// A run in which something happens at a lit moment drawn from a seed; every other head differs from the model. Moment and run.
fn suffered(rig: &RigConfig, plan: &Plan, seed: u64, trouble: Option<Trouble>) -> (u32, Run) {
    let head = if seed % 2 == 1 { Spread::USUAL.draw(rig, seed) } else { rig.clone() };
    let mut dice = oorandom::Rand64::new(u128::from(seed));
    let lit = lit_ticks(plan);
    let when = lit[dice.rand_range(0..lit.len() as u64 * 3 / 4) as usize] as u32;
    let mut simulated = SimulatedRig::new(&head, POSE, seed);
    let ran = run(&mut simulated, plan, false, |simulated, tick| {
        if tick.telemetry.tick == when {
            trouble.into_iter().for_each(|trouble| simulated.suffer(trouble));
        }
        ControlFlow::Continue(())
    });
    (when, ran)
}

fn bump(degrees: f64) -> Trouble {
    let rad = degrees.to_radians();
    Trouble::Bump(PanTilt::new(0.8 * rad, 0.6 * rad))
}

fn furthest_mm(ran: &Run) -> f64 {
    ran.ticks.iter().filter(|tick| tick.light).map(off_mm).fold(0.0, f64::max)
}

#[test]
fn with_a_gyroscope_no_bump_lets_light_fall_astray() {
    for (name, rig) in [("firm", with_gyroscope()), ("tripod", on_a_tripod())] {
        for path in [circle(0.2), star(0.2)] {
            let plan = plan_of(&rig, path);
            for degrees in [0.2, 0.5, 1.0, 2.0, 5.0, 10.0] {
                let mut worst_mm = 0.0f64;
                for seed in 0..MOMENTS {
                    let (_, ran) = suffered(&rig, &plan, seed, Some(bump(degrees)));
                    worst_mm = worst_mm.max(furthest_mm(&ran));
                    let fault = ran.fault();
                    assert!(
                        fault.is_some() && !ran.is_done(),
                        "{name}, {degrees}°, seed {seed}: as if nothing were"
                    );
                }
                println!("{name}, {degrees}° in 30 ms: light at most {worst_mm:.2} mm off");
                assert!(worst_mm <= 3.0, "{name}, {degrees}°: {worst_mm} mm");
            }
        }
    }
}

#[test]
fn what_the_gyroscope_saw_is_told_with_the_fault() {
    let rig = with_gyroscope();
    let plan = plan_of(&rig, circle(0.2));
    let (when, ran) = suffered(&rig, &plan, 4, Some(bump(1.0)));
    let dark =
        ran.ticks.iter().find(|t| t.telemetry.darkness.contains(Darkness::Jolted) && t.telemetry.tick > when);
    let dark = dark.unwrap().telemetry;
    assert!(dark.tick - when <= 5 && !dark.actuation.enable, "{} ms", dark.tick - when);
    let told = ran.ticks.iter().find(|t| t.telemetry.fault() == Some(Fault::Bumped)).unwrap().telemetry;
    let [_, down, left] = told.foot_turned_rad.unwrap().map(|rad| f64::from(rad).to_degrees());
    assert!((left - 0.8).abs() < 0.02 && (down - 0.6).abs() < 0.02, "{left}° {down}°");
}

#[test]
fn somebody_who_pushes_the_head_does_not_bump_its_foot() {
    let push = Trouble::Push(PanTilt::new(0.3, 0.2));
    for rig in [with_gyroscope(), on_a_tripod()] {
        let plan = plan_of(&rig, circle(0.2));
        let bumped = |seed| {
            let lasts = 30 + 5 * seed as u32;
            let mut simulated = SimulatedRig::new(&rig, POSE, seed);
            let from = 1500 + 70 * seed as u32;
            let ran = run(&mut simulated, &plan, false, |simulated, tick| {
                match tick.telemetry.tick {
                    tick if tick == from => simulated.suffer(push),
                    tick if tick == from + lasts => simulated.suffer(Trouble::Push(PanTilt::default())),
                    _ => {}
                }
                ControlFlow::Continue(())
            });
            ran.fault() == Some(Fault::Bumped)
        };
        assert_eq!((0..MOMENTS).filter(|&seed| bumped(seed)).count(), 0);
    }
}

/// One that stands firm, one that swings by its own motion, and one that is worn; drawing and not.
#[test]
fn nobody_bumps_into_a_healthy_head() {
    let mut worn = RigConfig::worn();
    worn.truth.gyroscope.fitted = true;
    for rig in [with_gyroscope(), on_a_tripod(), worn, RigConfig::report(), RigConfig::worn()] {
        let plan = plan_of(&rig, star(0.2));
        for seed in 0..MOMENTS {
            let (_, ran) = suffered(&rig, &plan, seed, None);
            assert_eq!(ran.ticks.last().unwrap().telemetry.phase, Phase::Done, "{} {seed}", rig.name);
        }
    }
}

/// A joint is thrown by little more than a count for 5°, as its rotor weighs so much more than what it carries: where it stands still, no edge
/// may come. Who shakes or pushes a head in less time than a bump takes is taken for one sometimes, which only a gyroscope or a camera can tell.
#[test]
fn without_one_encoders_feel_the_large_ones() {
    for (rig, degrees, least) in
        [(RigConfig::report(), 5.0, 28), (RigConfig::report(), 10.0, 45), (RigConfig::worn(), 5.0, 38)]
    {
        for path in [circle(0.2), star(0.2)] {
            let plan = plan_of(&rig, path);
            let dark = |seed: &u64| suffered(&rig, &plan, *seed, Some(bump(degrees))).1.fault().is_some();
            let felt = (0..MOMENTS).filter(dark).count();
            println!("{}, {degrees}°, by encoders alone: {felt} of {MOMENTS} end in the dark", rig.name);
            assert!(felt >= least, "{} {degrees}°: {felt}", rig.name);
        }
    }
}
