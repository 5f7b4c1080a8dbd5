//! The 2006 rig, what it is asked for, and drawings in front of it.

use tracelight_aim::{HeadGeometry, HeadPose};
use tracelight_dynamics::{Friction, HeadBodies, Motor};
use tracelight_rig::{Joint, PanTilt, TICK_F64_S};
use tracelight_stroke::{Drawing, Element, Path, Point, Stroke};
use tracelight_trajectory::{DarkMove, LitSpeed, Machine, Plan, PlanRequest, Shape};

pub(crate) const SPEED_M_S: f64 = 0.3048;

pub(crate) fn machine() -> Machine {
    let motor = |torque_nm_per_v| Motor::by_current(torque_nm_per_v, 10.0);
    Machine {
        lumped: HeadBodies::set_a().lumped(),
        friction: PanTilt::new(Friction::symmetric(0.0009, 0.04), Friction::symmetric(0.0018, 0.058)),
        motors: PanTilt::new(motor(0.0619), motor(0.0774)),
        torque_share: 0.85,
        speed_limit_rad_s: PanTilt::new(24.0, 24.0),
        acceleration_limit_rad_s2: PanTilt::new(100.0, 100.0),
        jerk_limit_rad_s3: PanTilt::new(f64::INFINITY, f64::INFINITY),
        tolerance_limit_rad: f64::INFINITY,
        geometry: HeadGeometry {
            laser_offset_m: [0.02, 0.005, 0.01],
            ..HeadGeometry::centred(PanTilt::new((-3.1, 3.1), (-1.6, 1.6)))
        },
        pose: HeadPose::square_on(0.9144),
        relay_on_ticks: 5,
        relay_off_ticks: 3,
    }
}

pub(crate) fn request(travel: Shape) -> PlanRequest {
    PlanRequest {
        speed_m_s: SPEED_M_S,
        travel: DarkMove::Shaped(travel),
        lit_speed: LitSpeed::Fastest,
        ramp_s: 0.02,
        settle_s: 0.04,
        tolerance_m: 3e-3,
        corner_m: 0.0,
    }
}

pub(crate) fn drawing(paths: impl IntoIterator<Item = Path>) -> Drawing {
    Drawing { strokes: paths.into_iter().map(Stroke::new).collect() }
}

pub(crate) fn circle(x: f64, y: f64, radius: f64) -> Path {
    let mut path = Path::new(Point::new(x + radius, y));
    path.push(Element::Arc { centre: Point::new(x, y), sweep: std::f64::consts::TAU });
    path.close();
    path
}

pub(crate) fn line(points: &[(f64, f64)]) -> Path {
    let points: Vec<Point> = points.iter().map(|&p| p.into()).collect();
    Path::polyline(&points, false).unwrap()
}

/// Tight circles, a long line, a letter-sized curve, a line of small breaks.
pub(crate) fn mixed() -> Drawing {
    let mut curl = Path::new(Point::new(0.0, -0.2));
    curl.push(Element::Cubic {
        c1: Point::new(0.03, -0.17),
        c2: Point::new(-0.02, -0.16),
        to: Point::new(0.01, -0.2),
    });
    let breaks: Vec<_> =
        (0..40).map(|i| (0.01 * f64::from(i) - 0.2, 0.2 + 1e-4 * f64::from(i % 3))).collect();
    drawing([
        circle(-0.1, 0.1, 0.004),
        circle(0.2, -0.1, 0.03),
        line(&[(-0.3, 0.0), (0.3, 0.1)]),
        curl,
        line(&breaks),
    ])
}

/// Places are what the speeds lead to.
pub(crate) fn places_and_speeds_belong_together(plan: &Plan) {
    for pair in plan.points.windows(2) {
        for joint in Joint::BOTH {
            let (a, b) = (pair[0].joints[joint], pair[1].joints[joint]);
            let mean = 0.5 * (a.velocity_rad_s + b.velocity_rad_s) * TICK_F64_S;
            // at a small break of the tangent the speed jumps by up to 16 mrad/s somewhere within the tick
            assert!((b.position_rad - a.position_rad - mean).abs() < 2e-5, "{joint}: {a:?} {b:?}");
        }
    }
}
