//! `homed` and `armed` are evidence: what was not read is not acknowledged, counts that were lost are not believed, and nothing is armed
//! or lit for a host that is not there. Ticks wrap without a gap.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on may panic, and shows figures"
)]

use std::ops::ControlFlow;

use tracelight_rig::{Command, Darkness, Fault, Joint, PanTilt, Phase, Rig, Segment, Telemetry};
use tracelight_session::Feeder;
use tracelight_sim::{RigConfig, Simulated, SimulatedRig, Tick, Trouble, arm, run};
use tracelight_trajectory::Plan;

use crate::shapes::{POSE, alive, circle, lit_ticks, off_mm, plan_of, true_counts};

/// Ticks before their number wraps.
const BEFORE_WRAP: u32 = 500;

/// Lit moments of the first half of a plan, drawn from a seed, and joints.
fn moments(plan: &Plan, seed: u64, count: usize) -> Vec<(u32, Joint)> {
    let mut dice = oorandom::Rand64::new(u128::from(seed));
    let lit = lit_ticks(plan);
    let mut moment = |number: usize| {
        let when = lit[dice.rand_range(0..lit.len() as u64 / 2) as usize] as u32;
        (when, Joint::BOTH[number % 2])
    };
    (0..count).map(&mut moment).collect()
}

/// A rig on its way along a plan, up to a tick of it.
fn under_way(plan: &Plan, ticks: u32, from_tick: u32, seed: u64) -> (SimulatedRig, Feeder<&[Segment]>) {
    let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, seed).counting_from(from_tick);
    let mut feeder = Feeder::new(plan.segments.as_slice(), false);
    assert!(arm(&mut rig));
    for _ in 0..ticks {
        fed(&mut rig, &mut feeder);
    }
    (rig, feeder)
}

fn fed(rig: &mut SimulatedRig, feeder: &mut Feeder<&[Segment]>) -> Tick {
    feeder.feed(rig);
    alive(rig)
}

/// Lets ticks pass with a host that is there.
fn pass(rig: &mut SimulatedRig, ticks: u32) {
    for _ in 0..ticks {
        alive(rig);
    }
}

/// Ticks in which a rig that is fed no more gets through a segment, and takes another.
const ROOM_TICKS: u32 = 40;

fn make_room(rig: &mut SimulatedRig) {
    pass(rig, ROOM_TICKS);
}

/// A segment that no joint can follow.
fn wild(plan: &Plan) -> Command {
    Command::Append(Segment { ticks: 0, ..plan.segments[0] })
}

#[test]
fn arming_acknowledges_the_faults_there_were_and_no_others() {
    let plan = plan_of(&RigConfig::report(), circle(0.1));
    let (mut rig, _) = under_way(&plan, 300, 0, 0);
    make_room(&mut rig);
    rig.send(Command::Disarm).unwrap();
    for acknowledges in [1, 2, u32::MAX] {
        rig.send(Command::Arm { acknowledges }).unwrap();
        assert_eq!(
            alive(&mut rig).telemetry.phase,
            Phase::Dark,
            "{acknowledges} faults, before there was one"
        );
    }
    for number in 1..4 {
        rig.send(wild(&plan)).unwrap();
        let now = alive(&mut rig).telemetry;
        assert_eq!((now.fault(), now.fault_number), (Some(Fault::SetpointInvalid), number));
        for acknowledges in [0, number - 1, number + 1, u32::MAX] {
            rig.send(Command::Arm { acknowledges }).unwrap();
            let after = alive(&mut rig).telemetry;
            assert_eq!(
                (after.fault(), after.phase),
                (now.fault(), Phase::Faulted),
                "{acknowledges} of {number}"
            );
        }
        rig.send(Command::Arm { acknowledges: number }).unwrap();
        let after = alive(&mut rig).telemetry;
        assert!(after.fault().is_none() && after.phase != Phase::Faulted && after.fault_number == number);
        rig.send(Command::Disarm).unwrap();
    }
}

#[test]
fn a_fault_that_lasts_counts_once_and_another_kind_counts_too() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    let (mut rig, _) = under_way(&plan, 300, 0, 0);
    // silence trips in every tick from the thousandth on
    let numbers: Vec<u32> = (0..1200).map(|_| rig.step().telemetry.fault_number).collect();
    assert_eq!((numbers[900], numbers[1199]), (0, 1));
    rig.suffer(Trouble::EncoderJump(Joint::Pan, 40));
    let after: Vec<Telemetry> = (0..200).map(|_| rig.step().telemetry).collect();
    let last = after.last().unwrap();
    assert_eq!((last.fault(), last.homed), (Some(Fault::HostLost), false));
    assert!(after.windows(2).all(|pair| pair[0].fault_number <= pair[1].fault_number));
    let kinds = last.fault_number;
    assert!((2..5).contains(&kinds), "{kinds}");
    // who has read of the first only does not arm
    rig.send(Command::KeepAlive).unwrap();
    rig.send(Command::Arm { acknowledges: 1 }).unwrap();
    assert_eq!(rig.step().telemetry.phase, Phase::Faulted);
}

/// After an encoder's fault nobody knows where light would fall, whoever arms.
#[test]
fn after_an_encoder_jumped_arming_alone_never_lights_again() {
    let config = RigConfig::report();
    let plan = plan_of(&config, circle(0.2));
    let mut dark_ticks = 0;
    for (seed, (when, joint)) in moments(&plan, 5, 100).into_iter().enumerate() {
        let (mut rig, mut feeder) = under_way(&plan, when, 0, seed as u64);
        rig.suffer(Trouble::EncoderJump(joint, if seed % 3 == 0 { -40 } else { 6 }));
        for _ in 0..12 {
            fed(&mut rig, &mut feeder);
        }
        assert_eq!(rig.told().fault(), Some(Fault::EncoderJumped), "seed {seed}");
        assert!(arm(&mut rig));
        for number in 0..5000 {
            let Tick { telemetry, light, .. } = fed(&mut rig, &mut feeder);
            // somebody arms again and again
            if number % 100 == 0 {
                arm(&mut rig);
            }
            assert!(!light && !telemetry.actuation.gate, "seed {seed}: lit {number} ticks after it");
            assert!(!telemetry.homed && telemetry.darkness.contains(Darkness::Unhomed), "seed {seed}");
            dark_ticks += 1;
            if telemetry.phase == Phase::Done {
                break;
            }
        }
    }
    println!("Arm after lost counts: 0 of {dark_ticks} ticks lit");
}

#[test]
fn a_head_that_lost_counts_draws_again_once_it_was_homed() {
    let config = RigConfig::report();
    let plan = plan_of(&config, circle(0.2));
    let (mut rig, _) = under_way(&plan, lit_ticks(&plan)[200] as u32, 0, 3);
    rig.suffer(Trouble::EncoderJump(Joint::Tilt, 25));
    pass(&mut rig, 200);
    assert!(arm(&mut rig));
    rig.send(Command::Abandon).unwrap();
    let rests = (0..4000).map(|_| alive(&mut rig)).last().unwrap();
    rig.send(Command::Home(true_counts(&config, &rests))).unwrap();
    rig.send(Command::Abandon).unwrap();
    pass(&mut rig, 3000);
    let again = run(&mut rig, &plan, false, |_, _| ControlFlow::Continue(()));
    let off = again.ticks.iter().filter(|t| t.light).map(off_mm).fold(0.0, f64::max);
    assert!(again.is_done() && again.ticks.iter().filter(|t| t.light).count() > 1000);
    assert!(off < 1.5, "{off} mm");
}

/// What stops a job in its tick: a count that jumps, or a segment that is refused.
#[derive(Clone, Copy, Debug)]
enum Stops {
    Encoder(Joint),
    Segment,
}

/// A rig that is stopped at a moment of its plan, and an `Arm` that was on its way since before and arrives in a tick. What followed.
fn with_an_arm_on_its_way(plan: &Plan, at: (u32, u32), stops: Stops, arrives: Option<u32>) -> Vec<Telemetry> {
    let (when, from_tick) = at;
    let (mut rig, _) = under_way(plan, when - ROOM_TICKS, from_tick, 1);
    make_room(&mut rig);
    let step = |number: u32| {
        match stops {
            Stops::Encoder(joint) if number == 6 => rig.suffer(Trouble::EncoderJump(joint, 5)),
            Stops::Segment if number == 8 => rig.send(wild(plan)).unwrap(),
            _ => {}
        }
        if arrives == Some(number) {
            rig.send(Command::Arm { acknowledges: 0 }).unwrap();
        }
        alive(&mut rig).telemetry
    };
    (0..400).map(step).collect()
}

#[test]
fn an_arm_that_was_on_its_way_when_a_fault_came_neither_wipes_it_nor_lights() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    let mut tried = 0;
    for (number, (when, joint)) in moments(&plan, 9, 20).into_iter().enumerate() {
        // half of them about where the number of a tick wraps
        let from_tick = if number % 2 == 0 { 0 } else { 0u32.wrapping_sub(when + 8) };
        for stops in [Stops::Encoder(joint), Stops::Segment] {
            let seen = with_an_arm_on_its_way(&plan, (when, from_tick), stops, None);
            let seen = seen.iter().position(|told| told.fault().is_some()).unwrap();
            for offset in -5..=5 {
                let arrives = (seen as i32 + offset) as u32;
                let told = with_an_arm_on_its_way(&plan, (when, from_tick), stops, Some(arrives));
                let is_dark = |told: &Telemetry| !told.actuation.gate && told.phase == Phase::Faulted;
                assert!(told[seen..].iter().all(is_dark), "{stops:?} at {when}, {offset} ms: lit or wiped");
                tried += 1;
            }
        }
    }
    println!("Arm on its way, -5 to +5 ms about a fault: 0 of {tried} lit, 0 wiped it");
}

#[test]
fn nothing_is_armed_for_a_host_that_is_not_there() {
    let plan = plan_of(&RigConfig::report(), circle(0.1));
    let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, 0);
    for _ in 0..100 {
        rig.send(Command::Arm { acknowledges: 0 }).unwrap();
        let now = rig.step().telemetry;
        assert!(now.phase == Phase::Dark && now.darkness.contains(Darkness::HostSilent));
    }
    let (mut rig, _) = under_way(&plan, 200, 0, 0);
    assert!((0..1100).map(|_| rig.step()).last().unwrap().telemetry.fault() == Some(Fault::HostLost));
    let number = rig.told().fault_number;
    rig.send(Command::Arm { acknowledges: number }).unwrap();
    assert_eq!(rig.step().telemetry.phase, Phase::Faulted);
    assert!(arm(&mut rig));
    let now = rig.step().telemetry;
    assert!(now.phase != Phase::Faulted && !now.darkness.contains(Darkness::HostSilent));
}

#[test]
fn a_dot_is_dark_without_a_host_and_ends_with_it() {
    let config = RigConfig::report();
    let plan = plan_of(&config, circle(0.2));
    let middle = lit_ticks(&plan)[300] as u32;
    let (mut homed, _) = under_way(&plan, middle, 0, 0);
    homed.send(Command::Disarm).unwrap();
    pass(&mut homed, 300);
    let mut unhomed = SimulatedRig::unhomed(&config, POSE, PanTilt::new(0.1, 0.1), 0);
    // never heard of anybody
    for _ in 0..200 {
        unhomed.step();
    }
    unhomed.send(Command::Point(900)).unwrap();
    for _ in 0..1000 {
        let now = unhomed.step();
        assert!(
            !now.light
                && now.telemetry.fault().is_none()
                && now.telemetry.darkness.contains(Darkness::HostSilent)
        );
    }
    unhomed.send(Command::KeepAlive).unwrap();
    for mut rig in [homed, unhomed] {
        rig.send(Command::Point(900)).unwrap();
        let dot: Vec<Tick> = (0..1000).map(|_| rig.step()).collect();
        let gate = |t: &Tick| t.telemetry.actuation.gate;
        let bound = config.control_config().host_silence_ticks as usize;
        let lit = dot.iter().filter(|t| gate(t)).count();
        assert!((bound - 2..=bound).contains(&lit), "{lit} ticks of light, and silence may last {bound}");
        assert!(dot[bound..].iter().all(|t| !gate(t)));
    }
}

#[test]
fn who_stops_a_run_leaves_a_gate_that_is_shut() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    for (seed, (when, _)) in moments(&plan, 21, 20).into_iter().enumerate() {
        let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, seed as u64);
        let stops = |_: &mut SimulatedRig, tick: &Tick| match tick.telemetry.tick == when {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        };
        let run = run(&mut rig, &plan, false, stops);
        assert!(run.ticks[when as usize].telemetry.actuation.gate, "seed {seed}: nothing to see");
        assert_eq!(run.ticks.len(), when as usize + 2, "seed {seed}");
        assert!(!run.ticks[when as usize + 1].telemetry.actuation.gate, "seed {seed}");
        let later = (0..300).filter(|_| rig.step().telemetry.actuation.gate).count();
        assert_eq!(later, 0, "seed {seed}: ticks of light after it");
    }
}

#[test]
fn a_run_through_the_wrap_of_its_ticks_is_as_any_other() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    let drawn = |from: u32| {
        let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, 2).counting_from(from);
        run(&mut rig, &plan, false, |_, _| ControlFlow::Continue(())).ticks
    };
    let from = u32::MAX - BEFORE_WRAP;
    let (usual, wrapped) = (drawn(0), drawn(from));
    assert!(usual.len() > 2 * BEFORE_WRAP as usize && usual.len() == wrapped.len());
    for (a, b) in usual.iter().zip(&wrapped) {
        assert_eq!(a.telemetry.tick, b.telemetry.tick.wrapping_sub(from));
        let telemetry = Telemetry { tick: a.telemetry.tick, ..b.telemetry };
        assert_eq!(*a, Tick { telemetry, ..*b });
    }
}

#[test]
fn a_fault_about_the_wrap_of_ticks_is_seen_as_soon_as_any_other() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    let begins = lit_ticks(&plan)[100] as u32;
    for ticks in begins..begins + 12 {
        let (mut rig, mut feeder) = under_way(&plan, ticks, 0u32.wrapping_sub(begins + 6), 4);
        rig.suffer(Trouble::EncoderJump(Joint::Pan, 40));
        let told: Vec<Telemetry> = (0..4).map(|_| fed(&mut rig, &mut feeder).telemetry).collect();
        // what is read at the end of a tick is seen in the next
        assert_eq!(told[1].fault(), Some(Fault::EncoderJumped), "{}", told[1].tick);
        assert!(!told[1].actuation.gate);
    }
}
