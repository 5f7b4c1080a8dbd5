//! Every fault at a hundred seeded moments of a circle: seen within its bound, dark in that tick, and no light off the
//! stroke by more than its limit.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on may panic, and shows figures"
)]

use std::ops::ControlFlow;

use tracelight_rig::{Command, Fault, Joint, PanTilt, Phase, Rig, Segment};
use tracelight_sim::{LinkSettings, RigConfig, Simulated, SimulatedRig, Tick, Trouble, arm, run};
use tracelight_trajectory::Plan;

use crate::shapes::{self, POSE, alive, circle, lit_ticks, off_mm, plan_of};

const MOMENTS: u64 = 100;
const COUNT_RAD: f64 = std::f64::consts::TAU / 4096.0;

/// What is done to a rig in every tick from a moment on, with the ticks since.
type Mischief = fn(&mut SimulatedRig, Joint, u32);

/// What must follow.
struct Case {
    name: &'static str,
    mischief: Mischief,
    /// One of these is seen,
    faults: &'static [Fault],
    /// so many ticks after the moment, or after what `due` says.
    bound: u32,
    /// From when on it can be seen.
    due: fn(&[Tick], Joint, usize) -> usize,
    /// How far off its stroke light may have fallen by then, mm.
    limit_mm: f64,
}

/// From the moment on.
fn at_once(_: &[Tick], _: Joint, when: usize) -> usize {
    when
}

/// From when the joint has truly moved four counts.
fn after_four_counts(ticks: &[Tick], joint: Joint, when: usize) -> usize {
    let from = ticks[when].angle_rad[joint];
    let moved = |t: &Tick| (t.angle_rad[joint] - from).abs() >= 4.0 * COUNT_RAD;
    when + ticks[when..].iter().position(moved).unwrap_or(0)
}

/// From when the joint's next edge comes.
fn after_an_edge(ticks: &[Tick], joint: Joint, when: usize) -> usize {
    let stamped = |t: &Tick| t.telemetry.measured[joint].edge_age_ticks.is_some();
    // what is read in the next tick was on its way already
    when + 2 + ticks[when + 2..].iter().position(stamped).unwrap_or(0)
}

/// From when the gate next changes.
fn after_a_switch(ticks: &[Tick], _: Joint, when: usize) -> usize {
    let gate = |t: &Tick| t.telemetry.actuation.gate;
    when + ticks[when..].iter().position(|t| gate(t) != gate(&ticks[when])).unwrap_or(0)
}

/// A lit moment of the first half of a plan and a joint, drawn from a seed.
fn moment(plan: &Plan, seed: u64) -> (u32, Joint) {
    let mut dice = oorandom::Rand64::new(u128::from(seed));
    let lit = lit_ticks(plan);
    let when = lit[dice.rand_range(0..lit.len() as u64 / 2) as usize] as u32;
    (when, if seed.is_multiple_of(2) { Joint::Pan } else { Joint::Tilt })
}

/// A run with mischief, and what follows a fault.
fn run_with(config: &RigConfig, plan: &Plan, mischief: Mischief, seed: u64) -> Vec<Tick> {
    run_on(SimulatedRig::new(config, POSE, seed), plan, mischief, seed)
}

fn run_on(mut rig: SimulatedRig, plan: &Plan, mischief: Mischief, seed: u64) -> Vec<Tick> {
    let (when, joint) = moment(plan, seed);
    let watch = |rig: &mut SimulatedRig, tick: &Tick| {
        if tick.telemetry.tick >= when {
            mischief(rig, joint, tick.telemetry.tick - when);
        }
        ControlFlow::Continue(())
    };
    run(&mut rig, plan, false, watch).ticks
}

/// When a run shows its first fault, and which; no light is let out from then on.
fn fault_of(ticks: &[Tick], what: &str) -> (usize, Fault) {
    let seen = ticks.iter().enumerate().find_map(|(at, t)| Some((at, t.telemetry.fault()?)));
    assert!(seen.is_some(), "{what}: not seen");
    let (at, fault) = seen.unwrap();
    assert!(ticks[at..].iter().all(|t| !t.telemetry.actuation.gate), "{what}: lit after it");
    (at, fault)
}

/// Runs a case at every moment, by a controller in this process and by a board behind a wire: seen in time, dark in that tick and after it, no light further off
/// than the limit.
fn check(case: &Case, config: &RigConfig) {
    check_on(case, config, |rig, _| rig);
    check_on(case, config, |rig, seed| {
        let mut rig = rig.behind_wire(LinkSettings::default(), seed);
        rig.step();
        rig
    });
}

fn check_on(case: &Case, config: &RigConfig, on: fn(SimulatedRig, u64) -> SimulatedRig) {
    let name = case.name;
    let plan = plan_of(config, circle(0.2));
    let (mut slowest, mut furthest) = (0, 0.0f64);
    for seed in 0..MOMENTS {
        let (when, joint) = moment(&plan, seed);
        let rig = on(SimulatedRig::new(config, POSE, seed), seed);
        // a board has had a tick by then
        let first = rig.told().tick as usize + usize::from(rig.host().is_some());
        let ticks = run_on(rig, &plan, case.mischief, seed);
        let when = when - first as u32;
        let (at, fault) = fault_of(&ticks, &format!("{name}, seed {seed}"));
        assert!(case.faults.contains(&fault), "{name}, seed {seed}: {fault:?}");
        assert!(at > when as usize, "{name}, seed {seed}: before anything happened");
        slowest = slowest.max(at.saturating_sub((case.due)(&ticks, joint, when as usize)));
        furthest = ticks.iter().filter(|t| t.light).map(off_mm).fold(furthest, f64::max);
    }
    println!("{name}: seen within {slowest} ticks, light at most {furthest:.2} mm off");
    assert!(slowest <= case.bound as usize, "{name}: {slowest} ticks, not {}", case.bound);
    assert!(furthest <= case.limit_mm, "{name}: {furthest} mm, not {}", case.limit_mm);
}

#[test]
fn a_jump_of_the_count_is_seen_in_the_next_tick() {
    let mischief: Mischief = |rig, j, since| {
        if since == 0 {
            rig.suffer(Trouble::EncoderJump(j, 3));
        }
    };
    let faults = &[Fault::EncoderJumped];
    let case = Case { name: "jump", mischief, faults, bound: 2, due: at_once, limit_mm: 1.0 };
    check(&case, &RigConfig::report());
}

#[test]
fn noise_on_the_encoder_lines_is_seen_within_a_seventh_of_a_second() {
    let mischief: Mischief = |rig, j, _| rig.suffer(Trouble::EncoderNoise(j, 0.3));
    let faults = &[Fault::EncoderNoisy, Fault::EncoderJumped];
    let case = Case { name: "noise", mischief, faults, bound: 143, due: at_once, limit_mm: 3.0 };
    check(&case, &RigConfig::report());
}

#[test]
fn a_cut_encoder_is_seen_35_ms_after_four_counts_at_most() {
    let mischief: Mischief = |rig, j, since| {
        if since == 0 {
            rig.suffer(Trouble::EncoderCut(j));
        }
    };
    let faults = &[Fault::EncoderDead];
    let case =
        Case { name: "cut encoder", mischief, faults, bound: 35, due: after_four_counts, limit_mm: 7.5 };
    check(&case, &RigConfig::report());
}

#[test]
fn a_garbled_stamp_is_seen_in_its_tick() {
    let mischief: Mischief = |rig, j, _| rig.suffer(Trouble::StampGarbled(j));
    let faults = &[Fault::NotANumber];
    let case = Case { name: "garbled stamp", mischief, faults, bound: 0, due: after_an_edge, limit_mm: 1.0 };
    check(&case, &RigConfig::report());
}

#[test]
fn a_laser_that_stays_on_is_seen_three_ticks_after_it_should_be_off() {
    let mischief: Mischief = |rig, _, _| rig.suffer(Trouble::LaserStuck);
    let faults = &[Fault::LaserStuck];
    let case = Case {
        name: "stuck laser",
        mischief,
        faults,
        bound: 3 + 3, // the relay takes three to open
        due: after_a_switch,
        limit_mm: f64::INFINITY, // nothing the gate can do
    };
    check(&case, &RigConfig::report());
}

fn lean(rig: &mut SimulatedRig, joint: Joint, torque_nm: f64) {
    let mut torque = PanTilt::default();
    torque[joint] = torque_nm;
    rig.suffer(Trouble::Push(torque));
}

#[test]
fn a_joint_that_is_held_is_seen() {
    let mischief: Mischief = |rig, j, _| lean(rig, j, 1.5);
    let faults = &[Fault::AmplifierSaturated, Fault::EncoderDead, Fault::EncoderSlipping];
    let case = Case { name: "held joint", mischief, faults, bound: 600, due: at_once, limit_mm: 6.0 };
    check(&case, &RigConfig::report());
}

#[test]
fn a_head_that_is_not_back_in_time_is_given_up() {
    let mischief: Mischief = |rig, j, since| lean(rig, j, if since < 80 { 1.0 } else { 0.0 });
    let mut config = RigConfig::report();
    config.control.hold_limit_s = 0.1;
    // a hand that stops the head dead for 20 ms looks like a dead encoder
    let faults = &[Fault::HoldTimedOut, Fault::EncoderDead];
    let held = |ticks: &[Tick], _: Joint, when: usize| {
        when + ticks[when..].iter().position(|t| t.telemetry.phase == Phase::Holding).unwrap()
    };
    let case = Case { name: "slow return", mischief, faults, bound: 101, due: held, limit_mm: 6.0 };
    check(&case, &config);
}

#[test]
fn a_joint_that_is_pushed_out_of_its_range_is_seen_in_the_tick() {
    let mischief: Mischief = |rig, j, _| lean(rig, j, 4.0);
    let mut config = RigConfig::report();
    for j in Joint::BOTH {
        config.model.geometry.range_rad[j] = (-0.25, 0.25);
    }
    let faults = &[Fault::LimitReached];
    let outside = |ticks: &[Tick], j: Joint, when: usize| {
        let out = |t: &Tick| f64::from(t.telemetry.position_rad[j].abs()) > 0.25 + 3.0 * COUNT_RAD;
        when + ticks[when..].iter().position(out).unwrap()
    };
    let case = Case { name: "out of range", mischief, faults, bound: 0, due: outside, limit_mm: 6.5 };
    check(&case, &config);
}

/// The first tick at which I²t of either motor is over its rating, reckoned here.
fn heats_over(ticks: &[Tick], heating_s: f64, continuous: f64) -> Option<usize> {
    let mut heat = PanTilt::new(0.0, 0.0);
    ticks.iter().position(|t| {
        for j in Joint::BOTH {
            let share = f64::from(t.telemetry.actuation.command_v[j]) / 10.0;
            heat[j] += 1e-3 / heating_s * (share * share - heat[j]);
        }
        heat.pan.max(heat.tilt) > continuous * continuous
    })
}

#[test]
fn a_motor_that_gets_too_hot_is_seen_in_the_tick() {
    const HEATING_S: f64 = 2.0;
    let mut config = RigConfig::report();
    config.control.motor_heating_s = HEATING_S;
    let plan = plan_of(&config, circle(0.2));
    for seed in 0..MOMENTS {
        let continuous = 0.1 + 0.2 * seed as f64 / MOMENTS as f64;
        config.control.motor_continuous = continuous;
        let ticks = run_with(&config, &plan, |_, _, _| {}, seed);
        let (at, fault) = fault_of(&ticks, &format!("{continuous}"));
        assert_eq!(fault, Fault::MotorHot, "{continuous}");
        // f32 and f64 may differ by a tick where the temperature creeps
        let due = heats_over(&ticks, HEATING_S, continuous).unwrap_or(at);
        assert!(at.abs_diff(due) <= 1, "{continuous}: {at}, not {due}");
    }
}

/// A rig that is fed up to a segment, and then with another.
fn fed_until(plan: &Plan, segments: usize, last: Option<Segment>) -> Vec<Tick> {
    let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, 0);
    assert!(arm(&mut rig));
    let end = plan.segments[segments - 1].end_tick();
    let all: Vec<Segment> = plan.segments[..segments].iter().copied().chain(last).collect();
    let mut next = 0;
    let step = |_| {
        rig.send(Command::KeepAlive).unwrap();
        while next < all.len() && rig.send(Command::Append(all[next])).is_ok() {
            next += 1;
        }
        rig.step()
    };
    (0..end + 300).map(step).collect()
}

#[test]
fn a_segment_that_is_no_number_is_refused_before_its_time() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    for seed in 0..MOMENTS {
        let (when, _) = moment(&plan, seed);
        let segments = plan.segments.iter().position(|s| s.end_tick() > when).unwrap();
        let good = plan.segments[segments];
        let bad = Segment { coefficients: PanTilt::new([f32::NAN; 6], [0.0; 6]), ..good };
        let ticks = fed_until(&plan, segments, Some(bad));
        let (at, fault) = fault_of(&ticks, &format!("seed {seed}"));
        assert_eq!(fault, Fault::SetpointInvalid);
        assert!(at as u32 <= bad.start_tick);
    }
}

#[test]
fn segments_that_stop_coming_are_seen_in_the_tick_they_are_missing() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    for seed in 0..MOMENTS {
        let (when, _) = moment(&plan, seed);
        let segments = plan.segments.iter().position(|s| s.end_tick() > when).unwrap();
        let ticks = fed_until(&plan, segments, None);
        let (at, fault) = fault_of(&ticks, &format!("seed {seed}"));
        assert_eq!(fault, Fault::SetpointsStale);
        assert_eq!(at as u32, plan.segments[segments - 1].end_tick());
    }
}

/// After a fault nothing lights until somebody arms; then the head goes back and the stroke goes on where it stopped.
#[test]
fn after_a_fault_only_arming_lights_again_and_no_ink_is_missing() {
    let config = RigConfig::report();
    let plan = plan_of(&config, circle(0.2));
    for seed in 0..20 {
        let (when, _) = moment(&plan, seed);
        let mut rig = SimulatedRig::new(&config, POSE, seed);
        let mut ticks = Vec::new();
        let mut feeder = tracelight_session::Feeder::new(plan.segments.as_slice(), false);
        assert!(arm(&mut rig));
        while ticks.last().is_none_or(|t: &Tick| t.telemetry.phase != Phase::Done) && ticks.len() < 20_000 {
            let since = (ticks.len() as u32).wrapping_sub(when);
            // a host that falls silent, comes back, and arms
            if !(0..1100).contains(&since) {
                rig.send(Command::KeepAlive).unwrap();
                feeder.feed(&mut rig);
            }
            if since == 1200 {
                assert!(arm(&mut rig));
            }
            ticks.push(rig.step());
        }
        let last = ticks.last().unwrap();
        assert_eq!((last.telemetry.phase, last.telemetry.fault()), (Phase::Done, None), "seed {seed}");
        let dark = &ticks[when as usize + 50..when as usize + 1200];
        assert!(dark.iter().all(|t| !t.telemetry.actuation.gate), "seed {seed}");
        // the plan's clock passes every lit tick with light, but for what the relay takes at either end of the gap
        let drawn: std::collections::BTreeSet<u32> =
            ticks.iter().filter(|t| t.light).map(|t| t.telemetry.plan_tick).collect();
        let missing =
            (0..plan.points.len() as u32).filter(|i| plan.points[*i as usize].lit && !drawn.contains(i));
        let missing = missing.count();
        assert!(missing <= 8, "seed {seed}: {missing} ticks of ink missing");
        let far = ticks.iter().filter(|t| t.light).map(off_mm).fold(0.0, f64::max);
        assert!(far < 3.0, "seed {seed}: light {far} mm off");
    }
}

/// A head that strays on its way in the dark is waited for where the gate rises, some milliseconds before its stroke; the
/// clock gets under way slowly, and light must not fall before the stroke all the same.
#[test]
fn after_a_hold_at_a_strokes_start_light_falls_on_the_stroke() {
    let mut config = RigConfig::report();
    config.control.tolerance_m = 0.8e-3;
    config.truth.model.bodies.rotor_kg_m2 = PanTilt::new(0.09, 0.09);
    let plan = plan_of(&config, shapes::star(0.2));
    let (mut holds, mut early) = (0, 0);
    for seed in 0..20 {
        let ticks = run_with(&config, &plan, |_, _, _| {}, seed);
        holds += ticks.windows(2).filter(|w| w[1].telemetry.phase == Phase::Holding && w[0] != w[1]).count();
        let dark = |t: &Tick| !plan.points[(t.telemetry.plan_tick as usize).min(plan.points.len() - 1)].lit;
        early += ticks.iter().filter(|t| t.light && dark(t)).count();
    }
    assert!(holds > 0, "nothing to see: it never strayed");
    assert!(early <= 40, "{early} lit ticks where the plan is dark");
}

/// The first fault names what stopped the job; one that comes after it may still leave nothing to control by.
#[test]
fn an_encoder_that_jumps_after_another_fault_still_gets_its_motor_switched_off() {
    let config = RigConfig::report();
    let plan = plan_of(&config, circle(0.2));
    for seed in 0..10 {
        let (when, joint) = moment(&plan, seed);
        let mut rig = SimulatedRig::new(&config, POSE, seed);
        assert!(arm(&mut rig));
        let mut feeder = tracelight_session::Feeder::new(plan.segments.as_slice(), false);
        let mut last = None;
        for number in 0..when + 1800 {
            if number < when {
                rig.send(Command::KeepAlive).unwrap();
                feeder.feed(&mut rig);
            }
            if number == when + 1300 {
                rig.suffer(Trouble::EncoderJump(joint, 40));
            }
            last = Some(rig.step());
        }
        let seen = last.unwrap().telemetry;
        assert_eq!(seen.fault(), Some(Fault::HostLost), "seed {seed}");
        assert_eq!(seen.actuation.command_v, PanTilt::default(), "seed {seed}");
    }
}

/// Nobody can have meant to forget a fault that no telemetry has shown yet.
#[test]
fn arming_does_not_forget_a_fault_that_was_not_told() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, 0);
    assert!(arm(&mut rig));
    rig.send(Command::Append(Segment { ticks: 0, ..plan.segments[0] })).unwrap();
    assert!(arm(&mut rig));
    assert_eq!(rig.step().telemetry.fault(), Some(Fault::SetpointInvalid));
    assert!(arm(&mut rig));
    assert_eq!(rig.step().telemetry.fault(), None);
}

/// Whoever arms and dies is missed as before.
#[test]
fn a_host_that_arms_after_a_fault_and_falls_silent_is_missed_again() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, 0);
    assert!(arm(&mut rig));
    rig.send(Command::KeepAlive).unwrap();
    for &segment in plan.segments.iter().take(40) {
        rig.send(Command::Append(segment)).unwrap();
    }
    let faults = |rig: &mut SimulatedRig| (0..1100).map(|_| rig.step()).last().unwrap().telemetry.fault();
    assert_eq!(faults(&mut rig), Some(Fault::HostLost));
    assert!(arm(&mut rig));
    assert_eq!(rig.step().telemetry.fault(), None);
    assert_eq!(faults(&mut rig), Some(Fault::HostLost));
}

/// A head that fell while its motors had no volts comes back gently, also when there is nothing to draw yet.
#[test]
fn a_head_that_is_armed_where_it_fell_to_comes_back_without_a_jerk() {
    let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, 0);
    for _ in 0..50 {
        rig.step();
    }
    rig.suffer(Trouble::EncoderJump(Joint::Pan, 6));
    let fallen = (0..400).map(|_| alive(&mut rig)).last().unwrap();
    assert!(fallen.telemetry.fault().is_some() && fallen.angle_rad.tilt > 0.05, "{:?}", fallen.angle_rad);
    rig.suffer(Trouble::EncoderJump(Joint::Pan, -6));
    // what the line carries now is read at the end of a tick, and seen in the next
    rig.step();
    rig.step();
    assert!(arm(&mut rig));
    let back: Vec<Tick> = (0..3000).map(|_| alive(&mut rig)).collect();
    let last = back.last().unwrap();
    assert_eq!((last.telemetry.phase, last.telemetry.fault()), (Phase::Armed, None));
    assert!(last.angle_rad.tilt.abs() < 2.0 * COUNT_RAD, "{:?}", last.angle_rad);
    let beyond = back.iter().map(|t| -t.angle_rad.tilt).fold(0.0, f64::max);
    assert!(beyond < 3.0 * COUNT_RAD, "{beyond} rad past it");
    let most = back[200..].iter().map(|t| t.telemetry.actuation.command_v.tilt.abs()).fold(0.0, f32::max);
    assert!(most < 9.0, "{most} V");
}
