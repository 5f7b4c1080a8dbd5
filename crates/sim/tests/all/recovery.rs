//! What a host needs to find a head again while a job waits: a dot where it stands, and the job forgotten.

use tracelight_rig::{Command, Fault, Joint, PanTilt, Phase, Rig};
use tracelight_session::Feeder;
use tracelight_sim::{RigConfig, SimulatedRig, Tick, Trouble, arm, run_segments};
use tracelight_trajectory::Plan;

use crate::shapes::{POSE, alive, circle, lit_ticks, plan_of, true_counts};

/// A rig stopped in the middle of a lit circle and come to rest there.
fn stopped(plan: &Plan) -> SimulatedRig {
    let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, 3);
    let mut feeder = Feeder::new(plan.segments.as_slice(), false);
    let middle = lit_ticks(plan)[lit_ticks(plan).len() / 2];
    assert!(arm(&mut rig));
    for _ in 0..middle {
        feeder.feed(&mut rig);
        alive(&mut rig);
    }
    rig.send(Command::Disarm).unwrap();
    ticks(&mut rig, 300);
    rig
}

fn ticks(rig: &mut SimulatedRig, count: u32) -> Vec<Tick> {
    (0..count).map(|_| alive(rig)).collect()
}

#[test]
fn a_dot_is_lit_where_the_head_waits_and_the_job_goes_on_after_it() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    let mut rig = stopped(&plan);
    assert!(ticks(&mut rig, 50).iter().all(|t| !t.light));
    rig.send(Command::Point(100)).unwrap();
    let dot = ticks(&mut rig, 300);
    let lit: Vec<&Tick> = dot.iter().filter(|t| t.light).collect();
    assert!((95..=105).contains(&lit.len()), "{}", lit.len());
    assert!(lit.iter().all(|t| t.spot.unwrap().distance(t.asked.unwrap()) < 2e-3));
    assert!(dot.iter().all(|t| t.telemetry.plan_tick == dot[0].telemetry.plan_tick));
    assert!(arm(&mut rig));
    let mut feeder = Feeder::new([], false);
    feeder.feed(&mut rig);
    let rest = ticks(&mut rig, 3000);
    assert!(rest.iter().any(|t| t.light && t.telemetry.phase == Phase::Tracing));
}

#[test]
fn no_dot_is_lit_by_an_armed_rig_in_motion_or_after_a_fault() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    let mut rig = stopped(&plan);
    rig.send(Command::Point(500)).unwrap();
    ticks(&mut rig, 20);
    // somebody takes hold of the head
    rig.suffer(Trouble::Push(PanTilt::new(0.5, 0.0)));
    let pushed = ticks(&mut rig, 300);
    let moving = |t: &&Tick| t.rate_rad_s.pan.abs() > 0.1;
    assert!(pushed.iter().filter(moving).count() > 10);
    let far = |t: &Tick| t.spot.unwrap().distance(t.asked.unwrap()) > 4e-3;
    assert!(pushed.iter().all(|t| !(t.light && far(t))));
    let mut rig = stopped(&plan);
    rig.suffer(Trouble::EncoderJump(Joint::Pan, 30));
    ticks(&mut rig, 20);
    rig.send(Command::Point(100)).unwrap();
    assert!(ticks(&mut rig, 100).iter().skip(5).all(|t| !t.light));
}

#[test]
fn an_abandoned_job_leaves_a_head_at_zero_that_takes_another() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    for fault in [false, true] {
        let mut rig = stopped(&plan);
        if fault {
            rig.suffer(Trouble::EncoderJump(Joint::Tilt, -7));
            assert_eq!(ticks(&mut rig, 200).last().unwrap().telemetry.fault(), Some(Fault::EncoderJumped));
            assert!(arm(&mut rig));
        }
        rig.send(Command::Abandon).unwrap();
        let way = ticks(&mut rig, 4000);
        assert!(way.iter().all(|t| !t.light && t.telemetry.fault().is_none()));
        let home = way.last().unwrap().telemetry.position_rad;
        assert!(home.pan.abs().max(home.tilt.abs()) < 2e-3, "{home:?}");
        assert_eq!(way.last().unwrap().telemetry.homed, !fault);
        if fault {
            // its counts were lost: somebody has to look where it is
            rig.send(Command::Home(true_counts(&RigConfig::report(), way.last().unwrap()))).unwrap();
            rig.send(Command::Abandon).unwrap();
            ticks(&mut rig, 1000);
        }
        let again = run_segments(&mut rig, &plan.segments, false, |_, _| std::ops::ControlFlow::Continue(()));
        assert!(again.is_done() && again.ticks.iter().any(|t| t.light), "fault first: {fault}");
    }
}

#[test]
fn a_bump_turns_what_stands_and_a_drift_stretches_it() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    let mut rig = stopped(&plan);
    let before = alive(&mut rig).spot.unwrap();
    rig.suffer(Trouble::Bump(PanTilt::new(0.0175, 0.0)));
    let after = ticks(&mut rig, 400).last().unwrap().spot.unwrap();
    // 1° at 3 ft are 16 mm, further off the middle some more
    assert!((0.0155..0.018).contains(&before.distance(after)), "{before} {after}");
    let mut rig = stopped(&plan);
    let before = alive(&mut rig).spot.unwrap();
    rig.suffer(Trouble::Drift(0.01));
    let after = ticks(&mut rig, 1000).last().unwrap().spot.unwrap();
    let radius = before.to_vec2().hypot();
    assert!((before.distance(after) / (0.01 * radius) - 1.0).abs() < 0.15, "{before} {after}");
}
