//! One line or arc followed by every profile: as fast as the motors can, and no faster.

use std::f64::consts::{FRAC_PI_2, TAU};

use tracelight_rig::TICK_F64_S;
use tracelight_stroke::{Element, Piece, Point};
use tracelight_trajectory::{Course, CourseError, Machine, MoveLimits, Pace, PlanError, Ramps, Shape};

use crate::support::drawings;

const SHAPES: [Shape; 6] = [
    Shape::Ramped(Ramps::NONE),
    Shape::Ramped(Ramps::REPORT),
    Shape::Sine,
    Shape::Cycloid,
    Shape::Sigmoid,
    Shape::Quintic,
];

/// With the beam where the axes cross.
fn machine() -> Machine {
    let mut machine = drawings::machine();
    machine.geometry.laser_offset_m = [0.0; 3];
    machine
}

fn line(from: (f64, f64), to: (f64, f64)) -> Piece {
    Piece { from: from.into(), element: Element::Line { to: to.into() } }
}

fn arc(radius_m: f64, sweep: f64) -> Piece {
    Piece { from: (radius_m, 0.0).into(), element: Element::Arc { centre: Point::ORIGIN, sweep } }
}

/// Nothing of a pace asks more of the motors than a plan may use, but for `excess`, looked at ten times as densely as when
/// it was made.
fn check_torque(machine: &Machine, course: &Course<'_>, pace: &Pace, excess: f64) {
    let most = 20_000;
    for i in 0..=most {
        let at = course.at(pace, f64::from(i) / f64::from(most) * pace.duration_s()).unwrap();
        let share = machine.fraction(at.torque_nm).map(f64::abs);
        let worst = share.pan.max(share.tilt);
        assert!(worst <= machine.torque_share * (1.0 + excess), "{worst} at {} of {pace:?}", at.t_s);
    }
}

#[test]
fn shapes_are_as_fast_as_the_motors_can_follow_and_optimal_is_faster() {
    let machine = machine();
    let wish = MoveLimits { speed: 22.0, acceleration: 91.0, deceleration: 91.0 };
    for piece in [
        line((-0.2, -0.1), (0.25, 0.15)),
        arc(0.2, FRAC_PI_2),
        arc(0.01, -TAU),
        line((0.0, 0.1), (0.0, -0.1)),
    ] {
        let course = Course::new(&machine, piece).unwrap();
        let optimal = course.optimal(&wish).unwrap();
        for shape in SHAPES {
            let pace = course.shaped_for_motors(shape, &wish).unwrap();
            check_torque(&machine, &course, &pace, 1e-4);
            let peaks = course.torque_peaks_nm(&pace).unwrap();
            let share = machine.fraction(peaks);
            assert!(share.pan.max(share.tilt) > 0.999 * machine.torque_share, "{shape:?} could be faster");
            assert!(pace.duration_s() > 0.999 * optimal.duration_s(), "{shape:?}: {}", optimal.duration_s());
        }
        // its limits hold at its places; between them the course bends
        check_torque(&machine, &course, &optimal, 5e-3);
    }
}

#[test]
fn gentle_limits_are_kept_and_need_no_fitting() {
    let machine = machine();
    let course = Course::new(&machine, line((-0.2, 0.0), (0.2, 0.0))).unwrap();
    let gentle = MoveLimits { speed: 0.3, acceleration: 1.0, deceleration: 0.5 };
    for shape in SHAPES {
        let (asked, fitted) =
            (course.shaped(shape, &gentle), course.shaped_for_motors(shape, &gentle).unwrap());
        assert!((asked.duration_s() - fitted.duration_s()).abs() < 1e-12);
    }
    // nothing beats a trapezoid where the motors are not what bounds it
    let [trapezoid, optimal] = [course.shaped(SHAPES[0], &gentle), course.optimal(&gentle).unwrap()];
    assert!((optimal.duration_s() / trapezoid.duration_s() - 1.0).abs() < 1e-4, "{}", optimal.duration_s());
    assert!(optimal.peaks().speed <= 0.3 + 1e-12 && optimal.peaks().deceleration <= 0.5 + 1e-9);
}

#[test]
fn phases_are_chosen_for_the_shortest_time() {
    // friction helps to brake, so the best trapezoid brakes harder than it speeds up
    let machine = machine();
    let course = Course::new(&machine, line((-0.2, 0.0), (0.2, 0.0))).unwrap();
    let wish = MoveLimits { speed: 22.0, acceleration: 91.0, deceleration: 91.0 };
    let best = course.shaped_for_motors(SHAPES[0], &wish).unwrap();
    assert!(best.peaks().deceleration > 1.1 * best.peaks().acceleration, "{:?}", best.peaks());
    let like_it = |factor: f64| {
        let (a, d) = (best.peaks().acceleration, best.peaks().deceleration);
        let limits = MoveLimits { speed: 22.0, acceleration: factor * a, deceleration: d / factor };
        let torque = course.torque_peaks_nm(&course.shaped(SHAPES[0], &limits)).unwrap();
        let share = machine.fraction(torque);
        share.pan.max(share.tilt)
    };
    assert!(like_it(1.03) > 1.01 * machine.torque_share && like_it(0.97) > 1.01 * machine.torque_share);
}

#[test]
fn ticks_begin_and_end_at_rest_on_the_course() {
    let machine = machine();
    let course = Course::new(&machine, arc(0.1, FRAC_PI_2)).unwrap();
    let wish = MoveLimits { speed: 0.3, acceleration: 2.0, deceleration: 2.0 };
    for pace in [course.shaped(SHAPES[1], &wish), course.optimal(&wish).unwrap()] {
        let ticks = course.ticks(&pace).unwrap();
        let (first, last) = (&ticks[0], ticks.last().unwrap());
        assert!(first.spot.distance(Point::new(0.1, 0.0)) < 1e-12);
        assert!(last.spot.distance(Point::new(0.0, 0.1)) < 1e-9, "{last:?}");
        assert!(first.along.velocity.abs() < 1e-9 && last.along.velocity.abs() < 1e-9);
        assert_eq!(ticks.len(), (pace.duration_s() / TICK_F64_S).ceil() as usize + 1);
        assert!(ticks.iter().all(|p| (p.spot.to_vec2().hypot() - 0.1).abs() < 1e-12));
    }
}

#[test]
fn what_cannot_be_followed_is_refused() {
    let machine = machine();
    let none = Course::new(&machine, line((0.1, 0.1), (0.1, 0.1))).unwrap_err();
    assert_eq!(none, CourseError::NoLength);
    assert_eq!(Course::new(&machine, line((0.1, 0.1), (f64::NAN, 0.1))).unwrap_err(), CourseError::NoLength);
    let mut narrow = machine;
    narrow.geometry.range_rad.tilt = (-0.1, 0.1);
    let far = Course::new(&narrow, line((0.0, 0.0), (0.0, 0.2))).unwrap_err();
    assert!(matches!(far, CourseError::Reach { at_m, .. } if (at_m - 0.0917).abs() < 3e-4), "{far}");
    let weak = Machine { torque_share: 0.05, ..machine };
    let course = Course::new(&weak, line((-0.1, 0.0), (0.1, 0.0))).unwrap();
    let wish = MoveLimits { speed: 1.0, acceleration: 1.0, deceleration: 1.0 };
    let error = course.shaped_for_motors(SHAPES[0], &wish).unwrap_err();
    assert!(matches!(error, CourseError::Plan(PlanError::TooWeak { .. })), "{error}");
    let slow = MoveLimits { speed: 1e-6, acceleration: 1.0, deceleration: 1.0 };
    let error = course.ticks(&course.shaped(SHAPES[0], &slow)).unwrap_err();
    assert!(matches!(error, CourseError::Plan(PlanError::TooLong { .. })), "{error}");
}
