//! Shapes to trace, 3 ft in front of the head.

pub(crate) mod ink;

use std::ops::ControlFlow;

use tracelight_aim::HeadPose;
use tracelight_rig::{Command, PanTilt, Rig};
use tracelight_sim::{RigConfig, Run, Simulated, SimulatedRig, Tick, Tracking, run, score};
use tracelight_stroke::{Drawing, Element, Path, Point, Stroke};
use tracelight_trajectory::{DarkMove, LitSpeed, Plan, PlanRequest, Ramps, Shape, plan, plan_from};

/// 1 ft/s.
pub(crate) const SPEED_M_S: f64 = 0.3048;
/// 3 ft.
pub(crate) const POSE: HeadPose = HeadPose::square_on(0.9144);

pub(crate) fn circle(radius: f64) -> Path {
    let mut path = Path::new(Point::new(radius, 0.0));
    path.push(Element::Arc { centre: Point::ORIGIN, sweep: std::f64::consts::TAU });
    path.close();
    path
}

pub(crate) fn star(radius: f64) -> Path {
    let point = |i: u32| {
        let r = if i.is_multiple_of(2) { radius } else { 0.38 * radius };
        let (s, c) = (f64::from(i) * std::f64::consts::PI / 5.0).sin_cos();
        Point::new(r * s, r * c)
    };
    Path::polyline(&(0..10).map(point).collect::<Vec<_>>(), true).unwrap()
}

/// A child's house: walls, roof, door and two windows, dark moves between them.
pub(crate) fn house() -> Vec<Path> {
    let rectangle =
        |left, bottom, right, top| (vec![(left, bottom), (right, bottom), (right, top), (left, top)], true);
    let roof = (vec![(-0.22, 0.1), (0.0, 0.25), (0.22, 0.1)], false);
    let door = (vec![(-0.04, -0.15), (-0.04, 0.0), (0.05, 0.0), (0.05, -0.15)], false);
    let walls = rectangle(-0.2, -0.15, 0.2, 0.1);
    let (right, left) = (rectangle(0.09, -0.04, 0.15, 0.03), rectangle(-0.15, -0.04, -0.09, 0.03));
    let line = |(corners, closed): (Vec<(f64, f64)>, bool)| {
        let corners: Vec<Point> = corners.into_iter().map(|(x, y)| Point::new(x, y)).collect();
        Path::polyline(&corners, closed).unwrap()
    };
    [walls, roof, door, right, left].map(line).to_vec()
}

/// A level line at a height: the hardest for tilt, which creeps through a reversal on it.
pub(crate) fn line(height: f64) -> Path {
    Path::polyline(&[Point::new(-0.2, height), Point::new(0.2, height)], false).unwrap()
}

pub(crate) fn plan_of(config: &RigConfig, path: Path) -> Plan {
    plan_at(config, path, LitSpeed::Fastest)
}

/// A plan of several strokes, in this order.
pub(crate) fn plan_of_all(config: &RigConfig, paths: Vec<Path>) -> Plan {
    plan_paths(config, paths, LitSpeed::Fastest)
}

pub(crate) fn plan_at(config: &RigConfig, path: Path, lit_speed: LitSpeed) -> Plan {
    plan_paths(config, vec![path], lit_speed)
}

/// The way of a path from rest at these joint angles, rad.
pub(crate) fn plan_there(config: &RigConfig, path: Path, home_rad: PanTilt<f64>) -> Plan {
    let drawing = Drawing { strokes: vec![Stroke::new(path)] };
    plan_from(&drawing, &config.machine(POSE), &request(config, LitSpeed::Fastest), home_rad).unwrap()
}

fn request(config: &RigConfig, lit_speed: LitSpeed) -> PlanRequest {
    PlanRequest {
        speed_m_s: SPEED_M_S,
        lit_speed,
        travel: DarkMove::Shaped(Shape::Ramped(Ramps::REPORT)),
        ramp_s: config.motion.ramp_s,
        settle_s: config.motion.settle_s,
        tolerance_m: config.control.tolerance_m,
        corner_m: 0.0,
    }
}

fn plan_paths(config: &RigConfig, paths: Vec<Path>, lit_speed: LitSpeed) -> Plan {
    let drawing = Drawing { strokes: paths.into_iter().map(Stroke::new).collect() };
    plan(&drawing, &config.machine(POSE), &request(config, lit_speed)).unwrap()
}

pub(crate) fn trace(config: &RigConfig, path: Path, seed: u64) -> (Plan, Run, Tracking) {
    let plan = plan_of(config, path);
    let mut rig = SimulatedRig::new(config, POSE, seed);
    let run = run(&mut rig, &plan, false, |_, _| ControlFlow::Continue(()));
    let tracking = score(&plan, &run, SPEED_M_S);
    (plan, run, tracking)
}

/// The plan's ticks that are to be lit.
pub(crate) fn lit_ticks(plan: &Plan) -> Vec<usize> {
    (0..plan.points.len()).filter(|&i| plan.points[i].lit).collect()
}

/// How far the true spot is from where its setpoint would put it, mm.
pub(crate) fn off_mm(tick: &Tick) -> f64 {
    1e3 * tick.spot.unwrap().distance(tick.asked.unwrap())
}

/// One tick of a rig whose host is there.
pub(crate) fn alive(rig: &mut SimulatedRig) -> Tick {
    rig.send(Command::KeepAlive).unwrap();
    rig.step()
}

/// The counts that its encoders would read if they knew where zero is.
pub(crate) fn true_counts(config: &RigConfig, at: &Tick) -> PanTilt<i32> {
    let count_rad = config.truth.model.encoder.count_rad();
    at.angle_rad.map(|angle| (angle / count_rad + 0.5).floor() as i32)
}
