//! Encoders that do not show what their joints turn: dark in time, and a fault in the end; and heads whose encoders do are never taken for
//! such.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on may panic, and shows figures"
)]

use std::ops::ControlFlow;

use tracelight_rig::{Fault, Joint, Phase};
use tracelight_sim::{RigConfig, SimulatedRig, Spread, Tick, Trouble, run};

use crate::shapes::{POSE, circle, lit_ticks, plan_of, star};
use crate::troubled::run_with;

const MOMENTS: u64 = 6;

/// The worst of all moments, both joints and two shapes: light off its point, mm; and of those that finished as if nothing were, wrong
/// ticks.
fn worst(trouble: impl Fn(Joint) -> Trouble) -> (f64, usize) {
    let config = RigConfig::report();
    let (mut furthest_mm, mut unseen) = (0.0f64, 0);
    for path in [circle(0.2), star(0.2)] {
        let plan = plan_of(&config, path);
        let lit = lit_ticks(&plan);
        for moment in 0..MOMENTS {
            let when = lit[lit.len() * moment as usize / MOMENTS as usize + 17] as u32;
            for joint in Joint::BOTH {
                let one = run_with(&config, &plan, moment, when, trouble(joint));
                furthest_mm = furthest_mm.max(one.furthest_mm);
                unseen = unseen.max(if one.finished { one.wrong_ticks } else { 0 });
            }
        }
    }
    (furthest_mm, unseen)
}

/// Whatever share of its edges a counter takes: the light is dark before it is 30 mm off, and no run ends as if nothing were.
#[test]
fn a_counter_that_misses_edges_is_seen_whatever_share_it_takes() {
    for step in 0..=20 {
        let share = -1.0 + 0.125 * f64::from(step);
        let (furthest_mm, unseen) = worst(|j| Trouble::EdgesMissed(j, share));
        println!("edges {share:.3}: light at most {furthest_mm:.1} mm off, {unseen} wrong ticks unseen");
        assert!(furthest_mm <= 30.0 && unseen <= 100, "{share}: {furthest_mm} mm, {unseen} ticks");
    }
}

/// A disc that turns by three eighths of its joint or less, or backwards. One that turns by more, and begins to where its joint turns round, moves as a
/// heavier joint would.
#[test]
fn a_disc_that_hardly_turns_is_seen() {
    for step in 0..=11 {
        let share = -1.0 + 0.125 * f64::from(step);
        let (furthest_mm, unseen) = worst(|j| Trouble::EncoderSlip(j, share));
        println!("disc {share:.3}: light at most {furthest_mm:.1} mm off, {unseen} wrong ticks unseen");
        assert!(furthest_mm <= 30.0 && unseen <= 100, "{share}: {furthest_mm} mm, {unseen} ticks");
    }
}

/// Half, double, four times the counts: what is wired or typed wrong is dark from the first tick to the fault.
#[test]
fn an_encoder_of_another_scale_gets_no_light_at_all() {
    for factor in [0.2, 0.25, 0.5, 0.65, 1.5, 2.0, 4.0, 8.0] {
        let mut config = RigConfig::report();
        let counts = f64::from(config.model.encoder.counts_per_rev) * factor;
        config.truth.model.encoder.counts_per_rev = counts.round() as u32;
        for (seed, path) in [(0, circle(0.2)), (1, star(0.2)), (2, circle(0.05))] {
            let plan = plan_of(&config, path);
            let mut rig = SimulatedRig::new(&config, POSE, seed);
            let ran = run(&mut rig, &plan, false, |_, _| ControlFlow::Continue(()));
            let lit = ran.ticks.iter().filter(|t| t.light).count();
            println!("{factor} times the counts: {:?}, {lit} ticks of light", ran.fault());
            assert!(lit == 0 && ran.fault().is_some(), "{factor}: {lit} lit ticks, {:?}", ran.fault());
        }
    }
}

/// Heads that differ from what is believed of them, new and worn: none is taken for a bad one.
#[test]
fn healthy_heads_are_not_taken_for_bad_ones() {
    let mut tests = 0;
    let is_alarm = |fault: Fault| matches!(fault, Fault::EncoderSlipping | Fault::EncoderScale);
    for rig in [RigConfig::report(), RigConfig::worn()] {
        for path in [circle(0.2), star(0.2)] {
            let plan = plan_of(&rig, path);
            for seed in 0..30 {
                let head = Spread::USUAL.draw(&rig, seed);
                let mut simulated = SimulatedRig::new(&head, POSE, seed);
                let ran = run(&mut simulated, &plan, false, |_, _: &Tick| ControlFlow::Continue(()));
                tests += usize::from(ran.ticks.iter().any(|t| t.telemetry.phase == Phase::Testing));
                assert!(
                    ran.ticks.iter().all(|t| !(t.light && t.telemetry.phase == Phase::Testing)),
                    "light in a test"
                );
                assert!(
                    ran.is_done() && !ran.fault().is_some_and(is_alarm),
                    "{} {seed}: {:?}",
                    rig.name,
                    ran.fault()
                );
            }
        }
    }
    assert!(tests > 0, "nothing to see: no head made a test move");
}
