//! The controller on the plant, through the seams only: accuracy, sameness, faults.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on may panic, and shows figures"
)]

use std::ops::ControlFlow;

use tracelight_rig::{Fault, Joint, PanTilt, Phase};
use tracelight_sim::{RigConfig, Run, Simulated, SimulatedRig, Tick, Trouble, arm, run};
use tracelight_stroke::Point;
use tracelight_trajectory::{LitSpeed, Plan};

use crate::shapes::{POSE, SPEED_M_S, alive, circle, line, lit_ticks, off_mm, plan_at, plan_of, star, trace};

#[test]
fn shapes_on_the_report_rig_are_drawn_within_a_quarter_of_a_millimetre() {
    let shapes = [("circle", circle(0.2)), ("star", star(0.2)), ("line", line(0.15))];
    for (name, path) in shapes {
        for seed in 0..3 {
            let (_, run, tracking) = trace(&RigConfig::report(), path.clone(), seed);
            assert_eq!(run.ticks.last().unwrap().telemetry.phase, Phase::Done, "{name}");
            let good = tracking.rms_mm <= 0.25
                && tracking.max_mm <= 1.4
                && tracking.overshoot_percent <= 0.5
                && tracking.final_error_mm <= 0.25;
            assert!(good, "{name}, seed {seed}: {tracking:?}");
        }
    }
}

/// A square at one speed, whatever the relay's delays: light goes on and off where the lines begin and end, to what the
/// spot moves in a tick and a half.
#[test]
fn the_light_begins_and_ends_where_the_lines_do_at_full_speed() {
    const SIDE_M: f64 = 0.2;
    let corners =
        [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| Point::new(SIDE_M * x, SIDE_M * y));
    for (on_s, off_s) in [(5e-3, 3e-3), (2e-3, 10e-3), (10e-3, 2e-3), (0.0, 0.0)] {
        let mut config = RigConfig::report();
        for relay in [&mut config.model.relay, &mut config.truth.model.relay] {
            (relay.on_s, relay.off_s) = (on_s, off_s);
        }
        let square = tracelight_stroke::Path::polyline(&corners, true).unwrap();
        let plan = plan_at(&config, square, LitSpeed::Exact);
        let mut rig = SimulatedRig::new(&config, POSE, 0);
        let ran = run(&mut rig, &plan, false, |_, _| ControlFlow::Continue(()));
        let lines: Vec<&[Tick]> =
            ran.ticks.chunk_by(|a, b| a.light == b.light).filter(|run| run[0].light).collect();
        assert_eq!(lines.len(), 4);
        let mut worst = 0.0f64;
        for (i, line) in lines.iter().enumerate() {
            let end = |tick: &Tick, corner: Point| tick.spot.unwrap().distance(corner);
            // the last tick's light falls on the way to the next
            worst =
                worst.max(end(&line[0], corners[i])).max(end(&line[line.len() - 1], corners[(i + 1) % 4]));
        }
        println!("relay {on_s} {off_s} s: at most {:.3} mm off", 1e3 * worst);
        assert!(worst < 1.5e-3 * SPEED_M_S + 1e-4, "{on_s} {off_s}: {worst} m");
    }
}

#[test]
fn a_head_without_edge_stamps_is_nearly_as_good() {
    let mut config = RigConfig::report();
    config.model.encoder.edge_stamps = false;
    config.truth.model.encoder.edge_stamps = false;
    let (_, _, tracking) = trace(&config, star(0.2), 0);
    assert!(tracking.rms_mm <= 0.25, "{tracking:?}");
}

#[test]
fn a_worn_head_still_finishes_its_drawing() {
    for seed in 0..5 {
        let (_, run, tracking) = trace(&RigConfig::worn(), star(0.2), seed);
        assert_eq!(run.ticks.last().unwrap().telemetry.phase, Phase::Done);
        assert!(tracking.rms_mm <= 1.0, "{tracking:?}");
    }
}

#[test]
fn equal_seeds_give_equal_runs_to_the_bit_and_others_do_not() {
    let run = |seed| trace(&RigConfig::worn(), circle(0.05), seed).1;
    assert_eq!(run(1), run(1));
    assert_ne!(run(1), run(2));
}

#[test]
fn the_plan_takes_the_time_it_says() {
    let (plan, run, _) = trace(&RigConfig::report(), circle(0.1), 0);
    // the tick after the last setpoint is the first that knows it is done
    assert_eq!(run.ticks.len(), plan.points.len());
}

#[test]
fn light_falls_on_exactly_the_planned_ticks() {
    let (plan, run, _) = trace(&RigConfig::report(), circle(0.1), 0);
    for (tick, point) in run.ticks.iter().zip(&plan.points) {
        assert_eq!(tick.light, point.lit, "tick {}", tick.telemetry.tick);
    }
}

/// Only tilt moves on the way to this star, and not much: before the first light the head stops in the dark until pan's encoder was seen to follow its motor,
/// and the light falls on the planned ticks of the plan's clock.
#[test]
fn what_the_way_there_does_not_show_is_waited_for_in_the_dark() {
    let (plan, run, tracking) = trace(&RigConfig::report(), star(0.1), 0);
    let late = run.ticks.len() - plan.points.len();
    assert!((100..1000).contains(&late), "{late}");
    let first_lit = plan.points.iter().position(|p| p.lit).unwrap();
    for tick in run.ticks.iter().filter(|t| t.telemetry.phase == Phase::Tracing) {
        let at = tick.telemetry.plan_tick as usize;
        // the clock gets under way gently, and stands between two ticks of the plan from then on
        let sure = at < first_lit || at > first_lit + 200 && plan.points[at].lit == plan.points[at + 1].lit;
        assert!(!sure || tick.light == plan.points[at].lit, "plan tick {at}");
    }
    assert!(tracking.max_mm < 0.2, "{tracking:?}");
}

/// Runs a plan; at `from` and until `until` (ticks) somebody does something to the rig.
fn disturbed(plan: &Plan, mut act: impl FnMut(&mut SimulatedRig, u32)) -> Run {
    let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, 0);
    run(&mut rig, plan, false, |rig, tick| {
        act(rig, tick.telemetry.tick);
        ControlFlow::Continue(())
    })
}

/// The middle of the lit ticks.
fn middle(plan: &Plan) -> u32 {
    let lit = lit_ticks(plan);
    lit[lit.len() / 2] as u32
}

#[test]
fn a_push_darkens_at_once_and_the_stroke_goes_on_where_it_was_left() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    let at = middle(&plan);
    let run = disturbed(&plan, |rig, tick| {
        if tick == at {
            rig.suffer(Trouble::Push(PanTilt::new(1.0, 0.0)));
        } else if tick == at + 80 {
            rig.suffer(Trouble::Push(PanTilt::default()));
        }
    });
    // what the controller believes, on the target
    let geometry = RigConfig::report().model.geometry;
    let believed_off_mm = |t: &Tick| {
        let believed = t.telemetry.position_rad.map(f64::from);
        1e3 * geometry.spot(&POSE, believed).unwrap().distance(t.asked.unwrap())
    };
    let crossed = run.ticks.iter().position(|t| believed_off_mm(t) > 3.0).unwrap_or(usize::MAX - 2);
    let dark =
        at as usize + run.ticks[at as usize..].iter().position(|t| !t.telemetry.actuation.gate).unwrap();
    assert!(dark <= crossed + 2, "crossed at {crossed}, dark at {dark}");
    assert!(believed_off_mm(&run.ticks[dark]) > 2.0, "not before it must");
    let relit = run.ticks.iter().skip(dark).position(|t| t.telemetry.actuation.gate).unwrap() + dark;
    assert!(relit > dark + 80, "it cannot be back while it is pushed");
    let (left, back) = (&run.ticks[dark], &run.ticks[relit]);
    assert_eq!(left.telemetry.plan_tick, back.telemetry.plan_tick);
    assert!(back.spot.unwrap().distance(left.asked.unwrap()) < 0.75e-3);
    assert_eq!(run.ticks.last().unwrap().telemetry.phase, Phase::Done);
    // everything lit after it is on the stroke again
    let stray = run.ticks[relit..].iter().filter(|t| t.light);
    assert!(stray.clone().all(|t| off_mm(t) < 1.0));
}

#[test]
fn a_dead_encoder_is_noticed_and_the_laser_darkens() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    let at = middle(&plan);
    for joint in Joint::BOTH {
        // on the circle's far side tilt moves and pan turns round, a quarter later they change roles
        let when = if joint == Joint::Tilt { at } else { at + 1000 };
        let run = disturbed(&plan, |rig, tick| {
            if tick == when {
                rig.suffer(Trouble::EncoderCut(joint));
            }
        });
        let last = run.ticks.last().unwrap();
        assert_eq!(last.telemetry.fault(), Some(Fault::EncoderDead), "{joint}");
        let fault = run.ticks.iter().position(|t| t.telemetry.fault().is_some()).unwrap() as u32;
        assert!(fault < when + 100, "{joint}: {} ms", fault - when);
        assert!(!run.ticks[fault as usize].telemetry.actuation.gate);
    }
}

#[test]
fn a_jump_of_the_count_is_a_fault_in_the_same_tick() {
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    let at = middle(&plan);
    let run = disturbed(&plan, |rig, tick| {
        if tick == at {
            rig.suffer(Trouble::EncoderJump(Joint::Tilt, 100));
        }
    });
    let fault = run.ticks.iter().find(|t| t.telemetry.fault().is_some()).unwrap();
    assert_eq!(fault.telemetry.fault(), Some(Fault::EncoderJumped));
    assert!(fault.telemetry.tick <= at + 2 && !fault.telemetry.actuation.gate);
}

#[test]
fn a_dry_run_moves_and_stays_dark() {
    let plan = plan_of(&RigConfig::report(), circle(0.1));
    let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, 0);
    let run = run(&mut rig, &plan, true, |_, _| ControlFlow::Continue(()));
    assert!(run.ticks.iter().all(|t| !t.light && !t.telemetry.actuation.gate));
    let end = run.ticks.last().unwrap().spot.unwrap();
    assert!(end.distance(plan.points.last().unwrap().spot) < 1e-3);
}

#[test]
fn segments_that_stop_coming_darken_the_beam() {
    use tracelight_rig::{Command, Rig};
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, 0);
    assert!(arm(&mut rig));
    for &segment in plan.segments.iter().take(60) {
        rig.send(Command::Append(segment)).unwrap();
    }
    let ticks: Vec<_> = (0..plan.points.len()).map(|_| alive(&mut rig)).collect();
    let fault = ticks.iter().find(|t| t.telemetry.fault().is_some()).unwrap();
    assert_eq!(fault.telemetry.fault(), Some(Fault::SetpointsStale));
    assert_eq!(fault.telemetry.tick, plan.segments[59].end_tick());
    assert!(ticks.iter().skip(fault.telemetry.tick as usize).all(|t| !t.telemetry.actuation.gate));
}

#[test]
fn a_segment_that_does_not_join_is_refused_with_a_fault() {
    use tracelight_rig::{Command, Rig, Segment};
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, 0);
    assert!(arm(&mut rig));
    rig.send(Command::Append(plan.segments[0])).unwrap();
    let late = Segment { start_tick: plan.segments[1].start_tick + 1, ..plan.segments[1] };
    rig.send(Command::Append(late)).unwrap();
    assert_eq!(rig.step().telemetry.fault(), Some(Fault::SetpointInvalid));
}

#[test]
fn ten_seeds_draw_the_same_line() {
    let runs: Vec<Run> = (0..10).map(|seed| trace(&RigConfig::report(), star(0.2), seed).1).collect();
    let lit = |i: usize| runs.iter().all(|r| r.ticks[i].light);
    let (mut sum, mut count) = (0.0, 0.0);
    for i in (0..runs[0].ticks.len()).filter(|&i| lit(i)) {
        let spots: Vec<_> = runs.iter().map(|r| r.ticks[i].spot.unwrap()).collect();
        let (x, y) = spots.iter().fold((0.0, 0.0), |(x, y), p| (x + p.x / 10.0, y + p.y / 10.0));
        sum += spots.iter().map(|p| p.distance_squared((x, y).into())).sum::<f64>();
        count += 10.0;
    }
    let spread_mm = (sum / f64::max(count, 1.0)).sqrt() * 1e3;
    assert!(spread_mm <= 0.2, "{spread_mm} mm");
}

#[test]
fn a_segment_after_the_end_of_the_job_lights_nothing() {
    use tracelight_rig::{Command, Rig};
    let plan = plan_of(&RigConfig::report(), circle(0.1));
    let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, 0);
    run(&mut rig, &plan, false, |_, _| ControlFlow::Continue(()));
    let last = *plan.segments.last().unwrap();
    let still = last.sample(f32::from(last.ticks)).map(|s| [s.position_rad, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let lit =
        tracelight_rig::Segment { start_tick: last.end_tick(), coefficients: still, gate: true, ..last };
    rig.send(Command::Append(lit)).unwrap();
    assert!((0..100).all(|_| !rig.step().telemetry.actuation.gate));
}

#[test]
fn a_segment_without_a_bound_on_its_error_is_refused() {
    use tracelight_rig::{Command, Rig, Segment};
    let first = plan_of(&RigConfig::report(), circle(0.1)).segments[0];
    for bound in [f32::NAN, f32::INFINITY, 0.0] {
        let mut rig = SimulatedRig::new(&RigConfig::report(), POSE, 0);
        assert!(arm(&mut rig));
        rig.send(Command::Append(Segment { tolerance_rad: PanTilt::new(bound, 1e-3), ..first })).unwrap();
        assert_eq!(rig.step().telemetry.fault(), Some(Fault::SetpointInvalid), "{bound}");
    }
}

#[test]
fn a_job_disarmed_on_its_way_goes_on_dark_until_it_is_back() {
    use tracelight_rig::{Command, Rig};
    let plan = plan_of(&RigConfig::report(), circle(0.2));
    let at = middle(&plan);
    let run = disturbed(&plan, |rig, tick| {
        if tick == at {
            rig.send(Command::Disarm).unwrap();
        } else if tick == at + 300 {
            assert!(arm(rig));
        }
    });
    let off = at as usize + 1;
    assert!(run.ticks[off..off + 300].iter().all(|t| !t.telemetry.actuation.gate));
    let relit = off + run.ticks[off..].iter().position(|t| t.telemetry.actuation.gate).unwrap();
    assert!(relit > off + 350, "it has to be still on its stroke first");
    assert_eq!(run.ticks[relit].telemetry.plan_tick, run.ticks[off].telemetry.plan_tick);
    assert!(run.ticks[relit].spot.unwrap().distance(run.ticks[relit].asked.unwrap()) < 0.75e-3);
    assert_eq!(run.ticks.last().unwrap().telemetry.phase, Phase::Done);
}
