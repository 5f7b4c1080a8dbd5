//! A job without a simulator: three strokes followed with a known error, for the tests of the outputs.

use tracelight_maths::planar;
use tracelight_picture::Raster;
use tracelight_pipeline::{DistanceFrom, Standing};
use tracelight_rig::{
    Actuation, Darkness, DarknessSet, Fault, FaultRecord, Inputs, Measurement, PanTilt, Phase, Setpoint,
    TICK_F64_S, Telemetry,
};
use tracelight_sim::{Origin, Run, Tick, Tracking};
use tracelight_stroke::{Affine, Drawing, Element, Path, Point, Stroke, Vec2};
use tracelight_trajectory::{JointMotion, Plan, PlanPoint};
use tracelight_vision::Quality;

use crate::{Finished, Picture, Setting, Target, Timing};

/// Speed along the strokes, m/s.
pub(crate) const SPEED_M_S: f64 = 0.3048;
const TRAVEL_M_S: f64 = 1.0;
const STANDING: Standing = Standing {
    distance_m: 0.9144,
    from: DistanceFrom::Asked,
    largest_angle_deg: 22.6,
    spot_mm: 2.9,
    longest_spot_mm: 3.2,
    best_distance_m: 0.66,
};
const TARGET: Target =
    Target { width_m: 0.6096, height_m: 0.4572, middle: Point::ORIGIN, distance_m: 0.9144 };

/// Owns what a [`Finished`] borrows.
pub(crate) struct Fixture {
    pub(crate) raster: Option<Raster>,
    pub(crate) quality: Option<Quality>,
    pub(crate) drawing: Drawing,
    pub(crate) plan: Plan,
    pub(crate) run: Run,
    pub(crate) settings: Vec<Setting>,
    pub(crate) notes: Vec<String>,
}

impl Fixture {
    pub(crate) fn job(&self) -> Finished<'_> {
        let scale = TARGET.width_m / 640.0;
        let place = Affine::translate((-TARGET.width_m / 2.0, TARGET.height_m / 2.0))
            * Affine::scale_non_uniform(scale, -scale);
        Finished {
            picture_path: "examples/star <&> \"friends\".png",
            picture: self.raster.as_ref().map(|raster| Picture { raster, target_from_pixel: place }),
            quality: self.quality.as_ref(),
            target: TARGET,
            standing: STANDING,
            align: None,
            left_out: None,
            points: None,
            drawing: &self.drawing,
            plan: &self.plan,
            run: &self.run,
            finished: self.run.is_done(),
            earlier_laps: &[],
            tracking: tracking(),
            set_speed_m_s: SPEED_M_S,
            command_limit_v: PanTilt::new(10.0, 10.0),
            torque_limit_nm: PanTilt::new(0.619, 0.774),
            tolerance_mm: 3.0,
            eye: None,
            seen: None,
            settings: &self.settings,
            notes: &self.notes,
            timing: Timing { vision_ms: 31.4, plan_ms: 120.2, run_ms: 88.8, report_ms: 0.0 },
            seed: 0,
            dry_run: false,
            origin: Origin::SIMULATION,
        }
    }
}

fn tracking() -> Tracking {
    Tracking {
        rms_mm: 0.2113,
        max_mm: 0.4842,
        off_stroke_rms_mm: 0.1401,
        off_stroke_max_mm: 0.3977,
        overshoot_percent: 0.112,
        final_error_mm: 0.0713,
        lit_speed_m_s: 0.3041,
        at_speed_share: 0.974,
    }
}

/// A star, a circle in it and a wave below.
pub(crate) fn star() -> Fixture {
    let drawing = Drawing { strokes: vec![five_points(), circle(), wave()] };
    let plan = plan(&drawing);
    let run = run(&plan);
    let setting = |name: &str, value: &str| Setting { name: name.to_owned(), value: value.to_owned() };
    let settings = vec![
        setting("rig", "preset report, simulated"),
        setting("width", "24 in (0.6096 m)"),
        setting("distance", "3 ft (0.9144 m)"),
        setting("speed", "1 ft/s (0.3048 m/s)"),
        setting("profile", "s-curve"),
        setting("mode", "auto <script>alert(1)</script>"),
        setting("seed", "0"),
    ];
    let notes = vec!["1 ft/s is not reached at the 10 corners of stroke 1: torque & light.".to_owned()];
    let raster = Some(drawn(&drawing));
    Fixture { raster, quality: Some(quality()), drawing, plan, run, settings, notes }
}

/// A job of a vector file without a stroke that never ran.
pub(crate) fn nothing() -> Fixture {
    let (drawing, plan, run) = (Drawing::default(), Plan::default(), Run::default());
    Fixture { raster: None, quality: None, drawing, plan, run, settings: vec![], notes: vec![] }
}

/// Of a drawing seen out of focus.
const fn quality() -> Quality {
    Quality {
        contrast_percent: 83.2,
        contrast_to_noise: 40.0,
        noise_levels: 0.4,
        light_evenness: 0.93,
        ink_percent: 3.1,
        edge_px: Some(6.2),
        clipped_percent: 0.0,
        tone_percent: Some(0.0),
        pen_px: Some(4.1),
        light_on_dark: false,
    }
}

fn five_points() -> Stroke {
    let corner = |i: i32| {
        let angle = std::f64::consts::PI * (0.5 + f64::from(i) / 5.0);
        let radius = if i % 2 == 0 { 0.2 } else { 0.2 * 0.382 };
        Point::new(0.0, 0.02) + planar::direction(angle) * radius
    };
    let corners: Vec<_> = (0..10).map(corner).collect();
    Stroke::new(Path::polyline(&corners, true).unwrap())
}

fn circle() -> Stroke {
    let mut path = Path::new(Point::new(0.04, 0.02));
    path.push(Element::Arc { centre: Point::new(0.0, 0.02), sweep: std::f64::consts::TAU });
    path.close();
    Stroke::new(path)
}

fn wave() -> Stroke {
    let mut path = Path::new(Point::new(-0.24, -0.19));
    path.push(Element::Cubic {
        c1: Point::new(-0.08, -0.10),
        c2: Point::new(0.08, -0.28),
        to: Point::new(0.24, -0.19),
    });
    Stroke::new(path)
}

/// Dark lines on a light page, 640×480.
fn drawn(drawing: &Drawing) -> Raster {
    let ink: Vec<Vec<Point>> = drawing.strokes.iter().map(|s| s.path.flatten(1e-3)).collect();
    Raster::from_rows(640, 480, |v, row| {
        for (u, out) in row.chunks_exact_mut(3).enumerate() {
            let p = Point::new((u as f64 + 0.5) / 640.0 - 0.5, (0.5 - (f64::from(v) + 0.5) / 480.0) * 0.75)
                .to_vec2()
                * TARGET.width_m;
            let near = |line: &Vec<Point>| line.windows(2).any(|w| away(p.to_point(), w[0], w[1]) < 0.002);
            out.fill(if ink.iter().any(near) { 40 } else { 250 });
        }
    })
}

fn away(p: Point, a: Point, b: Point) -> f64 {
    let ab = b - a;
    let t = ((p - a).dot(ab) / ab.hypot2().max(1e-12)).clamp(0.0, 1.0);
    p.distance(a + ab * t)
}

fn plan(drawing: &Drawing) -> Plan {
    let mut points = Vec::new();
    let mut at = Point::ORIGIN;
    for (number, stroke) in drawing.strokes.iter().enumerate() {
        let way = [at, stroke.path.start()];
        walk(&way, TRAVEL_M_S, |spot| points.push(point(spot, None)));
        let line = stroke.path.flatten(1e-5);
        walk(&line, SPEED_M_S, |spot| points.push(point(spot, Some(number as u32))));
        at = stroke.path.end();
    }
    points.extend((0..200).map(|_| point(at, None)));
    Plan { points, ..Plan::default() }
}

/// Steps of one tick along a polyline at constant speed.
fn walk(line: &[Point], speed: f64, mut visit: impl FnMut(Point)) {
    let mut left = 0.0;
    for pair in line.windows(2) {
        let length = pair[0].distance(pair[1]);
        while left < length {
            visit(pair[0].lerp(pair[1], left / length));
            left += speed * TICK_F64_S;
        }
        left -= length;
    }
}

fn point(spot: Point, stroke: Option<u32>) -> PlanPoint {
    let joints = angles(spot).map(|position_rad| JointMotion { position_rad, ..JointMotion::default() });
    let share = PanTilt::new((spot.x * 2.0).sin() as f32 * 0.7, 0.2 + (spot.y * 9.0).sin() as f32 * 0.4);
    PlanPoint { spot, joints, torque_fraction: share, limit: None, lit: stroke.is_some(), stroke }
}

fn angles(spot: Point) -> PanTilt<f64> {
    let pan = (-spot.x / TARGET.distance_m).atan();
    PanTilt::new(pan, (-spot.y * pan.cos() / TARGET.distance_m).atan())
}

fn run(plan: &Plan) -> Run {
    Run { ticks: plan.points.iter().enumerate().map(|(i, p)| tick(i as u32, p)).collect() }
}

fn tick(number: u32, planned: &PlanPoint) -> Tick {
    let t = f64::from(number) * TICK_F64_S;
    let wobble = Vec2::new((t * 23.0).sin() * 2.5e-4 + (t * 140.0).sin() * 6e-5, (t * 31.0).cos() * 2e-4);
    let spot = planned.spot + wobble;
    let angle_rad = angles(spot);
    let mut darkness = DarknessSet::default();
    darkness.insert_if(!planned.lit, Darkness::Planned);
    let telemetry = Telemetry {
        tick: number,
        plan_tick: number,
        measured: angle_rad.map(|a| Measurement {
            count: (a * 4096.0 / std::f64::consts::TAU).round() as i32,
            edge_age_ticks: None,
        }),
        inputs: Inputs::ABSENT,
        setpoint: planned
            .joints
            .map(|j| Setpoint { position_rad: j.position_rad as f32, ..Setpoint::default() }),
        position_rad: angle_rad.map(|a| a as f32),
        velocity_rad_s: PanTilt::default(),
        acceleration_rad_s2: PanTilt::default(),
        lost_counts: PanTilt::default(),
        latched: None,
        foot_turned_rad: None,
        actuation: Actuation {
            command_v: planned.torque_fraction.map(|f| f * 10.0 + (t * 400.0).sin() as f32 * 0.3),
            gate: planned.lit,
            enable: true,
        },
        darkness,
        homed: true,
        fault_number: 0,
        phase: Phase::Tracing,
    };
    Tick {
        telemetry,
        angle_rad,
        rate_rad_s: PanTilt::default(),
        spot: Some(spot),
        asked: Some(planned.spot),
        light: planned.lit,
    }
}

/// A fault that was latched in the first tick, shown by nothing but itself.
pub(crate) fn latched(fault: Fault) -> Option<FaultRecord> {
    Some(FaultRecord { fault, number: 1, tick: 0, joint: None, exceeded: None })
}
