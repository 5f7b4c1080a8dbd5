//! A board behind a wire: the same controller, whatever the wire does to what is said.

#![allow(clippy::print_stdout, reason = "a test shows figures")]

use std::ops::ControlFlow;

use tracelight_device::{Host, Stage};
use tracelight_rig::{Command, Fault, Phase, Rig};
use tracelight_session::Feeder;
use tracelight_sim::{LinkSettings, RigConfig, Run, Simulated, SimulatedRig, Tick, Trouble, arm, run};
use tracelight_trajectory::Plan;

use crate::dice::Dice;
use crate::shapes::ink::{Ink, ink};
use crate::shapes::{POSE, circle, house, off_mm, plan_of, plan_of_all, star};

const GOOD: LinkSettings = LinkSettings { loss: 0.0, corrupt: 0.0, delay_ms: 0.0, jitter_ms: 0.0 };

fn wired(config: &RigConfig, link: LinkSettings, seed: u64) -> SimulatedRig {
    let mut rig = SimulatedRig::new(config, POSE, seed).behind_wire(link, seed);
    rig.step();
    rig
}

/// A controller in this process that has had a tick before anything is asked of it, as one behind a wire has.
fn here(config: &RigConfig, seed: u64) -> SimulatedRig {
    let mut rig = SimulatedRig::new(config, POSE, seed);
    rig.step();
    rig
}

fn to_the_end(rig: &mut SimulatedRig, plan: &Plan) -> Run {
    run(rig, plan, false, |_, _| ControlFlow::Continue(()))
}

#[test]
fn what_is_drawn_through_a_wire_is_what_is_drawn_without_it_in_every_bit() {
    for name in ["report", "worn", "stepper", "servo"] {
        let config = RigConfig::preset(name).unwrap();
        for (seed, plan) in [plan_of_all(&config, house()), plan_of(&config, star(0.2))].iter().enumerate() {
            let seed = seed as u64;
            let here = to_the_end(&mut here(&config, seed), plan);
            let mut behind = wired(&config, GOOD, seed);
            let there = to_the_end(&mut behind, plan);
            assert_eq!(behind.host().unwrap().stage(), Stage::Running, "{name}");
            assert!(there.is_done(), "{name}: {:?}", there.fault());
            let first = here.ticks.iter().zip(&there.ticks).position(|(a, b)| a != b);
            assert_eq!(first.map(|at| (at, &here.ticks[at], &there.ticks[at])), None, "{name}, {seed}");
            assert_eq!(here.ticks.len(), there.ticks.len(), "{name}");
        }
    }
}

/// A run that goes on whatever becomes of the wire: whoever stands there arms again when it is dark and was not told to be. What happens at its ticks is told.
fn drawn(rig: &mut SimulatedRig, plan: &Plan, mut at: impl FnMut(&mut SimulatedRig, u32)) -> Run {
    /// How long it takes somebody to arm again, ticks.
    const SOON: u32 = 300;
    let mut feeder = Feeder::new(plan.segments.as_slice(), false);
    let mut ran = Run::default();
    let (mut dark, most) = (SOON, 20 * plan.points.len());
    while !ran.is_done() && ran.ticks.len() < most {
        rig.send(Command::KeepAlive).unwrap();
        // what was sent before may be refused while it greets
        if dark >= SOON && arm(rig) {
            dark = 0;
        }
        feeder.feed(rig);
        let tick = rig.step();
        dark = if tick.telemetry.phase == Phase::Dark { dark + 1 } else { 0 };
        ran.ticks.push(tick);
        if matches!(rig.host().map(Host::stage), Some(Stage::Failed(_))) {
            break;
        }
        at(rig, ran.ticks.len() as u32);
    }
    ran
}

fn check_ink(name: &str, ran: &Run, plan: &Plan, before: &Ink) -> Ink {
    assert!(ran.is_done() && ran.fault().is_none(), "{name}: {:?}", ran.fault());
    let ink = ink(plan, ran);
    assert!(ink.missing_mm <= before.missing_mm + 0.2, "{name}: {ink:?} {before:?}");
    assert!(ink.doubled_mm <= 0.5, "{name}: {ink:?}");
    let off = ran.ticks.iter().filter(|t| t.light).map(off_mm).fold(0.0, f64::max);
    assert!(off < 1.0, "{name}: {off} mm");
    ink
}

#[test]
fn through_a_bad_wire_all_is_drawn_and_nothing_else() {
    let config = RigConfig::report();
    for (name, plan) in [("house", plan_of_all(&config, house())), ("star", plan_of(&config, star(0.2)))] {
        let before = ink(&plan, &to_the_end(&mut here(&config, 1), &plan));
        let mut worst = Ink::default();
        for (seed, link) in [
            LinkSettings { loss: 0.01, corrupt: 1e-3, ..GOOD },
            LinkSettings { loss: 0.1, corrupt: 0.02, ..GOOD },
            LinkSettings { delay_ms: 2.0, jitter_ms: 6.0, ..GOOD },
            LinkSettings { loss: 0.03, corrupt: 0.01, delay_ms: 5.0, jitter_ms: 15.0 },
        ]
        .into_iter()
        .cycle()
        .take(12)
        .enumerate()
        {
            let mut rig = wired(&config, link, seed as u64);
            let ran = drawn(&mut rig, &plan, |_, _| {});
            let host = rig.host().unwrap();
            assert_eq!(host.stage(), Stage::Running, "{name}, {link:?}: {} ticks", ran.ticks.len());
            let ink = check_ink(&format!("{name}, {link:?}"), &ran, &plan, &before);
            worst = worst.or_worse(&ink);
            let held = ran.ticks.iter().filter(|t| t.telemetry.phase == Phase::Holding).count();
            println!(
                "{name}, {link:?}: {} ticks, held {held}, {} packets spoilt, {ink:?}",
                ran.ticks.len(),
                host.spoilt()
            );
        }
        println!("{name}: worst {worst:?}, undisturbed {before:?}");
    }
}

#[test]
fn a_host_that_hangs_is_waited_for_or_lost() {
    let config = RigConfig::report();
    let plan = plan_of(&config, circle(0.2));
    let before = ink(&plan, &to_the_end(&mut here(&config, 1), &plan));
    let mut dice = Dice::of_seed(8);
    for ms in [40, 80, 500, 2000] {
        for seed in 0..15 {
            let when = 100 + dice.below(plan.points.len() - 300) as u32;
            let mut rig = wired(&config, GOOD, seed);
            let ran = drawn(&mut rig, &plan, |rig, tick| {
                if tick == when {
                    rig.suffer(Trouble::HostStall(ms));
                }
            });
            let what = format!("{ms} ms from {when} on");
            let held = ran.ticks.iter().filter(|t| t.telemetry.phase == Phase::Holding).count();
            let fault = ran.ticks.iter().find_map(|t| t.telemetry.fault());
            if ms == 2000 {
                assert_eq!(fault, Some(Fault::HostLost), "{what}");
                let last = ran.ticks.iter().rposition(|t| t.telemetry.actuation.gate);
                assert!(last.is_none_or(|last| last < when as usize + 60), "{what}: lit until {last:?}");
                continue;
            }
            assert_eq!(held > 20, ms > 60, "{what}: held for {held} ticks");
            check_ink(&what, &ran, &plan, &before);
        }
    }
}

#[test]
fn a_cable_that_is_pulled_is_put_in_again_and_the_rest_is_drawn() {
    let config = RigConfig::report();
    let plan = plan_of_all(&config, house());
    let before = ink(&plan, &to_the_end(&mut here(&config, 1), &plan));
    for seed in 0..6 {
        let mut dice = Dice::of_seed(seed.into());
        let mut rig = wired(&config, LinkSettings { delay_ms: 1.0, jitter_ms: 2.0, ..GOOD }, seed);
        let mut next = 500;
        let mut pulled = 0;
        let ran = drawn(&mut rig, &plan, |rig, tick| {
            if tick >= next && pulled < 10 {
                pulled += 1;
                next = tick + 1200 + dice.below(900) as u32;
                rig.suffer(Trouble::Unplug(30 + dice.below(900) as u32));
            }
        });
        assert_eq!((rig.host().unwrap().stage(), pulled), (Stage::Running, 10), "{seed}");
        let ink = check_ink(&format!("seed {seed}"), &ran, &plan, &before);
        println!("seed {seed}: {} ticks, {ink:?}", ran.ticks.len());
    }
}

/// A board whose memory fails goes on by another law: its host sees it in the first tick that is another, and disarms.
#[test]
fn a_bit_of_the_boards_configuration_that_turns_is_seen_and_it_is_dark() {
    let config = RigConfig::report();
    let plan = plan_of(&config, circle(0.2));
    let good = to_the_end(&mut wired(&config, GOOD, 3), &plan);
    let mut dice = Dice::of_seed(9);
    let (mut seen, mut without_effect) = (0, 0);
    for _ in 0..400 {
        let when = 300 + dice.below(plan.points.len() - 600) as u32;
        let (word, bit) = (dice.below(150), dice.below(32) as u32);
        let mut rig = wired(&config, GOOD, 3);
        let ran = drawn(&mut rig, &plan, |rig, tick| {
            if tick == when {
                rig.suffer(Trouble::BitFlip(word, bit));
            }
        });
        let other = |(a, b): (&Tick, &Tick)| a.telemetry.actuation != b.telemetry.actuation;
        let other = ran.ticks.iter().zip(&good.ticks).position(other);
        if let Stage::Failed(trouble) = rig.host().unwrap().stage() {
            seen += 1;
            let told =
                ran.ticks.iter().position(|t| t.telemetry.fault() == Some(Fault::TwinDiverged)).unwrap();
            assert!(told >= when as usize, "word {word}, bit {bit}: {trouble}");
            // the host's word is there a tick later
            for _ in 0..2 {
                rig.step();
            }
            let lit = (0..300).filter(|_| rig.step().light).count();
            let relay = 3;
            assert!(
                lit <= relay,
                "word {word}, bit {bit}: {lit} ticks of light after it was seen: {trouble}"
            );
        } else {
            without_effect += 1;
            assert_eq!(other, None, "word {word}, bit {bit}: it did something else, and nobody saw it");
        }
    }
    println!("of 400 bits {seen} seen, {without_effect} without effect");
    assert!(seen > 60, "{seen}");
}

/// Where a light's switch may still be closing after a Disarm was asked: on its way there and back, lost now and then, and repeated every 5 ms; and the cable may be out
/// for 120 ms just then.
const DISARMED_TICKS: u32 = 200;

/// Somebody arms, disarms and asks for dots as he likes, through a wire that loses, delays and is pulled: some time after he disarmed it is dark until he arms again.
#[test]
fn whatever_becomes_of_the_wire_nothing_is_lit_after_a_disarm() {
    let config = RigConfig::report();
    let plan = plan_of_all(&config, house());
    let (mut disarms, mut lit) = (0, 0);
    for seed in 0..30 {
        let mut dice = Dice::of_seed(1000 + u128::from(seed));
        let link = LinkSettings {
            loss: 0.15 * f64::from(dice.below(3) as u32),
            corrupt: 0.02,
            delay_ms: dice.below(15) as f64,
            jitter_ms: dice.below(15) as f64,
        };
        let mut rig = wired(&config, link, seed);
        let mut feeder = Feeder::new(plan.segments.as_slice(), false);
        // ticks since he disarmed; none while he may have light
        let (mut disarmed, mut ticks) = (None::<u32>, 0);
        while ticks < 15_000 && matches!(rig.host().unwrap().stage(), Stage::Running | Stage::Greeting) {
            ticks += 1;
            rig.send(Command::KeepAlive).unwrap();
            match dice.below(2500) {
                0..3 => {
                    rig.send(Command::Disarm).unwrap();
                    disarmed = disarmed.or(Some(0));
                    disarms += 1;
                }
                3..6 if arm(&mut rig) => disarmed = None,
                6 if rig.send(Command::Point(300)).is_ok() => disarmed = None,
                7 => {
                    // both in a tick, and once more
                    if arm(&mut rig) {
                        disarmed = Some(0);
                    }
                    rig.send(Command::Disarm).unwrap();
                }
                8 if dice.one_in(3) => rig.suffer(Trouble::Unplug(1 + dice.below(120) as u32)),
                9 => rig.suffer(Trouble::HostStall(1 + dice.below(30) as u32)),
                _ => {}
            }
            feeder.feed(&mut rig);
            let tick = rig.step();
            disarmed = disarmed.map(|since| since + 1);
            let is_lit = tick.telemetry.actuation.lights();
            lit += usize::from(is_lit);
            let since = disarmed.unwrap_or(0);
            assert!(
                !is_lit || since <= DISARMED_TICKS,
                "seed {seed}, {link:?}: lit {since} ticks after it was disarmed"
            );
        }
        if let Stage::Failed(trouble) = rig.host().unwrap().stage() {
            panic!("seed {seed}, {link:?}: {trouble}");
        }
    }
    println!("{disarms} Disarms, {lit} lit ticks");
    assert!(disarms > 300 && lit > 20_000, "{disarms} {lit}");
}

/// A host that is killed at any moment leaves a head that is dark within 51 ms; one that begins anew finds it homed where it stands, with motors as hot as they were
/// and a light budget that is spent, and draws again.
#[test]
fn a_host_that_is_killed_leaves_it_dark_and_the_next_one_draws_again() {
    /// A budget that is spent is whole again after ten times what it is.
    const RECOVERY_TICKS: u32 = 10_500;
    let config = RigConfig::report();
    let plan = plan_of(&config, star(0.2));
    let before = ink(&plan, &to_the_end(&mut here(&config, 1), &plan));
    let mut dice = Dice::of_seed(12);
    for seed in 0..25 {
        let when = 100 + dice.below(plan.points.len() - 200) as u32;
        let mut rig = wired(&config, GOOD, seed);
        let mut feeder = Feeder::new(plan.segments.as_slice(), false);
        assert!(arm(&mut rig));
        for _ in 0..when {
            rig.send(Command::KeepAlive).unwrap();
            feeder.feed(&mut rig);
            rig.step();
        }
        let hot = rig.told().actuation.command_v;
        rig.suffer(Trouble::HostKilled(1 + dice.below(2500) as u32));
        let first = rig.step();
        let told = first.telemetry;
        assert!(told.homed && told.phase == Phase::Dark, "{when}: {:?} {}", told.phase, told.homed);
        assert!(hot != told.actuation.command_v || when < 200);
        rig.send(Command::Abandon).unwrap();
        for _ in 0..RECOVERY_TICKS {
            rig.send(Command::KeepAlive).unwrap();
            assert!(!rig.step().light, "{when}");
        }
        let ran = drawn(&mut rig, &plan, |_, _| {});
        check_ink(&format!("killed at {when}"), &ran, &plan, &before);
    }
}

/// What has stood does not stand anew because somebody began anew.
#[test]
fn a_dot_does_not_stand_longer_for_a_host_that_begins_again_and_again() {
    let mut rig =
        SimulatedRig::unhomed(&RigConfig::report(), POSE, Default::default(), 3).behind_wire(GOOD, 3);
    let lit = |rig: &mut SimulatedRig, ticks: u32| {
        let mut lit = 0;
        for tick in 0..ticks {
            rig.send(Command::KeepAlive).unwrap();
            if tick == ticks.saturating_sub(1300) {
                rig.send(Command::Point(1000)).unwrap();
            }
            lit += u32::from(rig.step().telemetry.actuation.lights());
        }
        lit
    };
    let first = lit(&mut rig, 1500);
    assert!((900..=1000).contains(&first), "{first} ticks of light");
    for _ in 0..5 {
        rig.suffer(Trouble::HostKilled(20));
        assert_eq!(lit(&mut rig, 1500), 0, "a second in any ten seconds");
    }
    let later = lit(&mut rig, 12_000);
    assert!((900..=1000).contains(&later), "{later} ticks of light after ten dark seconds");
}

/// A day of drawing the house again and again, with 1 % of all packets lost, 0.1 % spoilt, and the cable pulled ten times.
#[test]
#[ignore = "half an hour: `bash .ci/run long`; its short twins always run"]
fn a_day_of_a_bad_wire_draws_every_house_whole() {
    /// How long it takes the head to go back to where a drawing begins, ticks.
    const BACK_TICKS: u32 = 2500;
    let hours: u64 =
        std::env::var("TRACELIGHT_HOURS").ok().and_then(|hours| hours.parse().ok()).unwrap_or(24);
    let ticks_in_all = 3_600_000 * hours;
    let config = RigConfig::report();
    let plan = plan_of_all(&config, house());
    let before = ink(&plan, &to_the_end(&mut here(&config, 1), &plan));
    let mut rig = wired(&config, LinkSettings { loss: 0.01, corrupt: 1e-3, ..GOOD }, 1);
    let (mut ticks, mut pulled, mut houses, mut worst) = (0_u64, 0, 0, Ink::default());
    let mut dice = Dice::of_seed(24);
    while ticks < ticks_in_all {
        let begun = ticks;
        let ran = drawn(&mut rig, &plan, |rig, tick| {
            ticks = begun + u64::from(tick);
            if ticks > (2 * pulled + 1) * ticks_in_all / 20 {
                pulled += 1;
                rig.suffer(Trouble::Unplug(5 + dice.below(900) as u32));
            }
        });
        let ink = check_ink(&format!("house {houses}"), &ran, &plan, &before);
        worst = worst.or_worse(&ink);
        houses += 1;
        rig.send(Command::Disarm).unwrap();
        rig.step();
        rig.send(Command::Abandon).unwrap();
        for _ in 0..BACK_TICKS {
            rig.send(Command::KeepAlive).unwrap();
            assert!(!rig.step().light, "house {houses}: light on its way back");
        }
        ticks += u64::from(BACK_TICKS);
    }
    let host = rig.host().unwrap();
    println!(
        "{hours} h: {houses} houses, {pulled} times pulled, {} packets spoilt: worst {worst:?}, undisturbed {before:?}",
        host.spoilt()
    );
    assert_eq!((host.stage(), pulled), (Stage::Running, 10));
}

/// What was sent behind an Arm that the wire lost with it belongs to a job that has not begun: it waits for the next Arm.
#[test]
fn a_cable_that_is_pulled_as_a_job_begins_takes_nothing_of_it() {
    let config = RigConfig::report();
    let plan = plan_of(&config, star(0.2));
    let before = ink(&plan, &to_the_end(&mut here(&config, 1), &plan));
    for when in 1..60 {
        let link = LinkSettings { delay_ms: f64::from(when % 5), jitter_ms: 3.0, ..GOOD };
        let mut rig = wired(&config, link, when.into());
        let mut again = false;
        for job in ["first", "second"] {
            let what = format!("{job} job, pulled at tick {when}");
            let ran = drawn(&mut rig, &plan, |rig, tick| {
                if tick == when && (job == "second") == (when % 2 == 0) {
                    again = true;
                    rig.suffer(Trouble::Unplug(40));
                }
            });
            check_ink(&what, &ran, &plan, &before);
            rig.send(Command::Disarm).unwrap();
            rig.step();
            rig.send(Command::Abandon).unwrap();
            for _ in 0..2500 {
                rig.send(Command::KeepAlive).unwrap();
                rig.step();
            }
        }
        assert!(again);
    }
}
