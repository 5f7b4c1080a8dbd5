//! What forbids light from outside, at a hundred seeded moments of a circle: dark in the tick in which it is seen, until it is
//! over and somebody arms; and the second switch, by which a laser goes dark whose relay is stuck.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on may panic, and shows figures"
)]

use tracelight_rig::{Command, Fault, Input, InputState, Motors, PanTilt, Phase, Rig};
use tracelight_session::Feeder;
use tracelight_sim::{RigConfig, Simulated, SimulatedRig, Tick, Trouble};
use tracelight_trajectory::Plan;

use crate::shapes::{POSE, alive, circle, lit_ticks, off_mm, plan_of};

const MOMENTS: u64 = 100;

/// A lit moment of the first half of a plan, drawn from a seed.
fn moment(plan: &Plan, seed: u64) -> u32 {
    let mut dice = oorandom::Rand64::new(u128::from(seed));
    let lit = lit_ticks(plan);
    lit[dice.rand_range(0..lit.len() as u64 / 2) as usize] as u32
}

/// A run on which `meddle` acts after every tick, to its end or for `most` ticks.
fn run_with(
    plan: &Plan,
    seed: u64,
    most: usize,
    mut meddle: impl FnMut(&mut SimulatedRig, &Tick),
) -> Vec<Tick> {
    let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, seed);
    let mut feeder = Feeder::new(plan.segments.as_slice(), false);
    let mut ticks: Vec<Tick> = Vec::new();
    rig.send(Command::KeepAlive).unwrap();
    rig.send(Command::Arm { acknowledges: 0 }).unwrap();
    while ticks.len() < most && ticks.last().is_none_or(|t| t.telemetry.phase != Phase::Done) {
        rig.send(Command::KeepAlive).unwrap();
        feeder.feed(&mut rig);
        let tick = rig.step();
        meddle(&mut rig, &tick);
        ticks.push(tick);
    }
    ticks
}

/// Arms by whoever has read that tick.
fn arm_after(tick: &Tick) -> Command {
    Command::Arm { acknowledges: tick.telemetry.fault_number }
}

/// Opens an input at a moment, arms while it is open, closes it, and arms again.
fn opened(plan: &Plan, seed: u64, input: Input) -> Vec<Tick> {
    let when = moment(plan, seed);
    run_with(plan, seed, 20_000, |rig, tick| match tick.telemetry.tick.wrapping_sub(when) {
        0 => rig.suffer(Trouble::Input(input, InputState::Open)),
        100 | 200 => rig.send(arm_after(tick)).unwrap(),
        250 => rig.suffer(Trouble::Input(input, InputState::Fine)),
        400 => rig.send(arm_after(tick)).unwrap(),
        _ => {}
    })
}

#[test]
fn an_input_that_opens_darkens_in_the_tick_until_it_is_fine_and_somebody_arms() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    for seed in 0..MOMENTS {
        let input = Input::ALL[seed as usize % Input::ALL.len()];
        let (when, what) = (moment(&plan, seed) as usize, format!("{input:?}, seed {seed}"));
        let ticks = opened(&plan, seed, input);
        let open = |t: &Tick| t.telemetry.inputs.state(input) == InputState::Open;
        let seen = ticks.iter().position(open).unwrap();
        assert!(seen <= when + 2, "{what}: seen {} ticks after", seen - when);
        assert!(ticks[seen - 1].telemetry.fault().is_none() && ticks[when].light, "{what}");
        // from its tick on until somebody arms after it, over 150 ticks of which it is fine again
        let (during, after) = ticks[seen..].split_at(when + 401 - seen);
        for tick in during {
            let now = &tick.telemetry;
            assert_eq!((now.phase, now.fault()), (Phase::Faulted, Some(input.fault())), "{what}");
            assert!(!now.actuation.gate && !now.actuation.enable, "{what}, tick {}", now.tick);
            let off = input.fault().row().motors == Motors::Off;
            assert_eq!(off, now.actuation.command_v == PanTilt::default(), "{what}, tick {}", now.tick);
        }
        assert!(during[1..].iter().all(|t| !t.light), "{what}: light after the tick");
        // then the stroke goes on where it stopped
        assert_eq!(
            after.last().map(|t| (t.telemetry.phase, t.telemetry.fault())),
            Some((Phase::Done, None)),
            "{what}"
        );
        assert!(after.iter().any(|t| t.light), "{what}: no light again");
        let far = ticks.iter().filter(|t| t.light).map(off_mm).fold(0.0, f64::max);
        assert!(far < 3.0, "{what}: light {far} mm off");
    }
}

#[test]
fn the_names_of_two_inputs_that_open_at_once_do_not_hide_what_the_second_means_for_the_motors() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    let when = moment(&plan, 0);
    let ticks = run_with(&plan, 0, when as usize + 50, |rig, tick| {
        if tick.telemetry.tick == when {
            rig.suffer(Trouble::Input(Input::Lid, InputState::Open));
            rig.suffer(Trouble::Input(Input::Supply, InputState::Open));
        }
    });
    let last = ticks.last().unwrap().telemetry;
    assert_eq!((last.fault(), last.actuation.command_v), (Some(Fault::InterlockOpen), PanTilt::default()));
}

#[test]
fn a_rig_that_is_powered_up_with_an_open_lid_cannot_be_armed() {
    let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, 0);
    rig.suffer(Trouble::Input(Input::Lid, InputState::Open));
    rig.suffer(Trouble::PowerLoss);
    let mut last = rig.step();
    for _ in 0..10 {
        rig.send(Command::KeepAlive).unwrap();
        rig.send(arm_after(&last)).unwrap();
        last = rig.step();
        let now = last.telemetry;
        assert_eq!((now.phase, now.fault()), (Phase::Faulted, Some(Fault::InterlockOpen)));
    }
}

#[test]
fn a_tick_that_comes_too_late_darkens_in_it_and_a_little_jitter_does_not() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    for seed in 0..MOMENTS {
        let (when, late) = (moment(&plan, seed), if seed.is_multiple_of(2) { 0.6 } else { 3.0 });
        let late_at = |at: u32, by: f64| {
            run_with(&plan, seed, at as usize + 200, |rig, tick| {
                if tick.telemetry.tick == at {
                    rig.suffer(Trouble::TickLate(by));
                }
            })
        };
        let ticks = late_at(when, late);
        let seen = ticks.iter().position(|t| t.telemetry.fault().is_some()).unwrap();
        // the tick after the moment is held up, the next one sees it
        assert_eq!(seen, when as usize + 2, "seed {seed}");
        let after = &ticks[seen..];
        assert!(after.iter().all(|t| t.telemetry.fault() == Some(Fault::TickLate)), "seed {seed}");
        assert!(after.iter().all(|t| !t.telemetry.actuation.gate && !t.telemetry.actuation.enable));
        assert!(after.iter().all(|t| t.telemetry.actuation.command_v != PanTilt::default()), "held");
        assert!(late_at(when, 0.4).iter().all(|t| t.telemetry.fault().is_none()), "seed {seed}: jitter");
    }
}

/// The gate can do nothing; the enable falls in the tick in which it is seen.
#[test]
fn a_laser_whose_relay_is_stuck_goes_dark_by_the_second_switch() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    let mut longest = 0;
    for seed in 0..MOMENTS {
        let when = moment(&plan, seed);
        let ticks = run_with(&plan, seed, 20_000, |rig, tick| match tick.telemetry.fault() {
            None if tick.telemetry.tick == when => rig.suffer(Trouble::LaserStuck),
            // whoever arms again gets no light by it either
            Some(_) => rig.send(arm_after(tick)).unwrap(),
            None => {}
        });
        let gate = |t: &Tick| t.telemetry.actuation.gate;
        let could = when as usize + ticks[when as usize..].iter().position(|t| !gate(t)).unwrap();
        let seen = ticks.iter().position(|t| t.telemetry.fault().is_some()).unwrap();
        assert_eq!(ticks[seen].telemetry.fault(), Some(Fault::LaserStuck), "seed {seed}");
        let dark = ticks.iter().rposition(|t| t.light).unwrap();
        assert_eq!(dark, seen, "seed {seed}: it is dark from the next tick on");
        longest = longest.max(dark - could);
    }
    println!("stuck laser: light for at most {longest} ms after the gate fell");
    assert!(longest <= 200, "{longest} ms of light after it could be seen");
}

#[test]
fn the_second_switch_is_open_unless_somebody_armed_or_a_dot_is_wanted() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    let ticks = run_with(&plan, 0, 20_000, |_, _| {});
    for tick in &ticks {
        let now = &tick.telemetry;
        let armed = matches!(now.phase, Phase::Armed | Phase::Tracing | Phase::Holding);
        assert!(armed || !now.actuation.enable, "tick {}", now.tick);
        // before that it is tried, and the gate's switch without it
        assert!(now.actuation.enable == armed || now.tick < 30, "tick {}", now.tick);
    }
    let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, 0);
    assert!((0..50).all(|_| !rig.step().telemetry.actuation.enable), "nobody armed");
    let mut rig = SimulatedRig::unhomed(&RigConfig::report(), POSE, PanTilt::new(0.1, 0.05), 0);
    let rest = (0..300).map(|_| rig.step()).last().unwrap();
    assert!(!rest.telemetry.actuation.enable);
    rig.send(Command::KeepAlive).unwrap();
    rig.send(Command::Point(100)).unwrap();
    let dot: Vec<Tick> = (0..200).map(|_| alive(&mut rig)).collect();
    assert_eq!(dot.iter().filter(|t| t.telemetry.actuation.enable).count(), 99);
    assert!(dot.iter().any(|t| t.light) && !dot.last().unwrap().light);
}
