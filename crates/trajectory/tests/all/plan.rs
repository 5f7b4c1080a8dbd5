//! Whole plans: within the motors' limits, exact at the segments, honest when they cannot be.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on may panic, and shows figures"
)]

use crate::support::drawings::{
    SPEED_M_S, circle, drawing, line, machine, mixed, places_and_speeds_belong_together, request,
};
use tracelight_rig::{Joint, PanTilt, TICK_F64_S};
use tracelight_stroke::Drawing;
use tracelight_trajectory::{
    Binding, DarkMove, LitSpeed, Machine, Plan, PlanError, PlanRequest, Ramps, Shape, plan,
};

fn made(shape: Shape) -> Plan {
    plan(&mixed(), &machine(), &request(shape)).unwrap()
}

#[test]
fn no_plan_asks_more_than_the_motors_have() {
    for shape in [Shape::Ramped(Ramps::NONE), Shape::Ramped(Ramps::REPORT), Shape::Sine, Shape::Sigmoid] {
        let peak = made(shape).torque_peak_fraction();
        assert!(0.8 < peak && peak <= 0.901, "{shape:?}: {peak}");
    }
}

#[test]
fn the_lit_spot_reaches_its_speed_on_the_long_line_and_never_exceeds_it() {
    let top = made(Shape::Ramped(Ramps::REPORT)).top_speed_m_s();
    assert!((top / SPEED_M_S - 1.0).abs() < 1e-3, "{top}");
}

#[test]
fn position_and_speed_of_the_plan_belong_together() {
    places_and_speeds_belong_together(&made(Shape::Ramped(Ramps::REPORT)));
}

#[test]
fn segments_meet_the_plan_at_every_tick() {
    let plan = made(Shape::Ramped(Ramps::REPORT));
    let mut next = 0;
    for segment in &plan.segments {
        assert_eq!(segment.start_tick, next);
        next = segment.end_tick();
        for n in 0..=u32::from(segment.ticks) {
            let point = &plan.points[(segment.start_tick + n) as usize];
            let sampled = segment.sample(n as f32);
            for joint in Joint::BOTH {
                let off = f64::from(sampled[joint].position_rad) - point.joints[joint].position_rad;
                assert!(off.abs() < 1e-6, "{joint}: {off:e}");
            }
        }
    }
    assert_eq!(next as usize, plan.points.len() - 1);
}

#[test]
fn the_gate_leads_the_light_by_the_relays_delays() {
    let plan = made(Shape::Ramped(Ramps::REPORT));
    let mut gate = vec![false; plan.points.len()];
    for s in &plan.segments {
        gate[s.start_tick as usize..s.end_tick() as usize].fill(s.gate);
    }
    let lit: Vec<bool> = plan.points.iter().map(|p| p.lit).collect();
    let changes = |v: &[bool], to: bool| -> Vec<usize> {
        (1..v.len()).filter(|&i| v[i] == to && v[i - 1] != to).collect()
    };
    assert_eq!(changes(&lit, true).len(), 5);
    assert_eq!(changes(&gate, true), changes(&lit, true).iter().map(|i| i - 5).collect::<Vec<_>>());
    assert_eq!(changes(&gate, false), changes(&lit, false).iter().map(|i| i - 3).collect::<Vec<_>>());
}

#[test]
fn stroke_ends_are_at_rest_and_on_the_path() {
    let stops = PlanRequest { lit_speed: LitSpeed::Stops, ..request(Shape::Ramped(Ramps::REPORT)) };
    let plan = plan(&mixed(), &machine(), &stops).unwrap();
    assert_eq!(plan.leg_ends.len(), 5);
    for end in &plan.leg_ends {
        let point = &plan.points[end.tick as usize];
        assert!(point.spot.distance(end.point) < 1e-9);
        assert!(Joint::BOTH.iter().all(|&j| point.joints[j].velocity_rad_s == 0.0));
    }
}

#[test]
fn a_line_in_many_pieces_is_run_like_one() {
    let pieces: Vec<_> = (0..=60).map(|i| (0.005 * f64::from(i) - 0.15, 0.05)).collect();
    let took = |points: &[(f64, f64)]| {
        plan(&drawing([line(points)]), &machine(), &request(Shape::Sine)).unwrap().duration_s()
    };
    let (one, many) = (took(&[(-0.15, 0.05), (0.15, 0.05)]), took(&pieces));
    assert!((one - many).abs() < 2.5e-3, "{one} s, in pieces {many} s");
}

#[test]
fn every_moment_of_a_long_line_has_its_limit() {
    let plan = plan(&drawing([line(&[(-0.3, 0.0), (0.3, 0.1)])]), &machine(), &request(Shape::Sine)).unwrap();
    let shares = plan.limit_shares();
    assert_eq!(shares[0].0, Binding::SpeedCap, "{shares:?}");
    assert!(shares[0].1 > 0.8 && shares[1].0 == Binding::Torque(Joint::Pan), "{shares:?}");
    assert!(plan.points.iter().all(|p| p.lit || p.limit != Some(Binding::SpeedCap)));
}

#[test]
fn a_stroke_that_begins_where_the_last_one_ends_is_drawn_without_going_dark() {
    let apart = [line(&[(0.0, 0.0), (0.1, 0.0)]), line(&[(0.1, 0.001), (0.2, 0.05)])];
    let joined = [line(&[(0.0, 0.0), (0.1, 0.0)]), line(&[(0.1, 0.0), (0.2, 0.05)])];
    let [apart, joined] =
        [apart, joined].map(|paths| plan(&drawing(paths), &machine(), &request(Shape::Sine)).unwrap());
    let lit_runs = |plan: &Plan| plan.points.chunk_by(|a, b| a.lit == b.lit).filter(|run| run[0].lit).count();
    assert_eq!((lit_runs(&apart), lit_runs(&joined)), (2, 1));
    assert!(joined.duration_s() < apart.duration_s() - 0.04, "{} s", joined.duration_s());
    assert_eq!(joined.leg_ends.len(), 2);
}

#[test]
fn a_stroke_out_of_reach_is_named() {
    let far = line(&[(0.0, 0.0), (9.0, 0.0)]);
    let error = plan(&drawing([circle(0.0, 0.0, 0.1), far]), &machine(), &request(Shape::Sine)).unwrap_err();
    assert!(matches!(error, PlanError::Aim { stroke: 2, .. }), "{error}");
}

#[test]
fn a_motor_that_cannot_hold_its_joint_is_named() {
    let mut weak = machine();
    weak.motors.tilt.limit_v = 2.0;
    let error = plan(&drawing([circle(0.0, 0.0, 0.1)]), &weak, &request(Shape::Sine)).unwrap_err();
    assert!(matches!(error, PlanError::TooWeak { joint: Joint::Tilt, .. }), "{error}");
}

#[test]
fn nothing_to_draw_and_too_much_to_draw_are_refused_at_once() {
    let request = request(Shape::Sine);
    assert_eq!(plan(&Drawing::default(), &machine(), &request).unwrap_err(), PlanError::Empty);
    let slow = PlanRequest { speed_m_s: 1e-6, ..request };
    let error = plan(&drawing([circle(0.0, 0.0, 0.1)]), &machine(), &slow).unwrap_err();
    assert!(matches!(error, PlanError::TooLong { .. }), "{error}");
}

#[test]
fn the_reports_wish_needs_a_hundred_volts() {
    let wishes = machine().impossible_wishes(0.4636);
    let needs = |j: Joint| wishes.iter().find(|w| w.joint == j).unwrap().needed_v;
    assert!((needs(Joint::Pan) - 123.0).abs() < 1.0 && (needs(Joint::Tilt) - 98.0).abs() < 1.0);
}

#[test]
fn a_bound_on_jerk_holds_from_tick_to_tick() {
    let free = plan(&mixed(), &machine(), &request(Shape::Ramped(Ramps::REPORT))).unwrap();
    for lit_speed in [LitSpeed::Fastest, LitSpeed::Exact, LitSpeed::Stops] {
        for (most, travel) in [
            (2000.0, DarkMove::Shaped(Shape::Ramped(Ramps::REPORT))),
            (300.0, DarkMove::Shaped(Shape::Quintic)),
            (300.0, DarkMove::Shaped(Shape::Ramped(Ramps::NONE))),
            (1000.0, DarkMove::Optimal),
        ] {
            let bound = Machine { jerk_limit_rad_s3: PanTilt::new(most, 0.8 * most), ..machine() };
            let request = PlanRequest { lit_speed, travel, ..request(Shape::Sine) };
            let plan = plan(&mixed(), &bound, &request).unwrap();
            let jerks = plan.points.windows(2).map(|pair| {
                let jerk = |j: Joint| {
                    let [from, to] = [0, 1].map(|i: usize| pair[i].joints[j].acceleration_rad_s2);
                    (to - from).abs() / TICK_F64_S / bound.jerk_limit_rad_s3[j]
                };
                jerk(Joint::Pan).max(jerk(Joint::Tilt))
            });
            let worst = jerks.fold(0.0, f64::max);
            assert!(
                worst <= 1.0 + 1e-6 && (worst > 0.5 || most > 1000.0),
                "{lit_speed:?} {most} {travel:?}: {worst}"
            );
            let slower = plan.duration_s() / free.duration_s();
            assert!(slower > if most < 1000.0 { 1.05 } else { 0.99 }, "{lit_speed:?} {most}: {slower}");
            let is_named = plan.points.iter().any(|p| matches!(p.limit, Some(Binding::Jerk(_))));
            // rounded more widely than it must be, a stop may stay below
            assert!(is_named || most > 500.0 || lit_speed == LitSpeed::Stops, "{lit_speed:?} {most}");
        }
    }
}

#[test]
fn one_joint_without_jerk_does_not_make_the_other_crawl() {
    let bound = Machine { jerk_limit_rad_s3: PanTilt::new(100.0, f64::INFINITY), ..machine() };
    let request = PlanRequest { lit_speed: LitSpeed::Stops, ..request(Shape::Sine) };
    let plan = plan(&drawing([line(&[(0.0, 0.0), (0.1, 0.0)])]), &bound, &request).unwrap();
    assert!(plan.lit_s() < 1.0, "0.33 s at the set speed take {} s", plan.lit_s());
}
