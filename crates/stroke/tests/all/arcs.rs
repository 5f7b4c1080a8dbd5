//! Lines and arcs that pass into each other come out as what was drawn.

use std::f64::consts::{PI, TAU};

use crate::drawn::Drawn::{self, Arc, Line};
use tracelight_maths::planar;
use tracelight_stroke::{Element, FitOptions, Path, Point, Vec2, fit};

use crate::drawn::{kinds, kinds_drawn, kink, path};

const TOLERANCE: f64 = 0.35;

/// Points every 1 along a path, each moved by noise of this amplitude either way, drawn from `seed`.
fn seen(path: &Path, noise: f64, seed: u64) -> Vec<Point> {
    let mut state = seed;
    let mut draw = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) as f64 / f64::from(1u32 << 31) - 0.5) * 2.0 * noise
    };
    let mut points: Vec<Point> = Vec::new();
    for piece in path.pieces() {
        let count = piece.length(1e-3).round().max(1.0);
        points.extend((0..count as u32).map(|k| piece.at(f64::from(k) / count)));
    }
    if !path.is_closed() {
        points.push(path.end());
    }
    points.into_iter().map(|p| p + Vec2::new(draw(), draw())).collect()
}

/// Noise of a quarter of the tolerance.
const NOISE: f64 = 0.25 * TOLERANCE;

fn fitted(points: &[Point], closed: bool) -> Path {
    fit(points, closed, &FitOptions { reach: 1.5, ..FitOptions::new(TOLERANCE) }).unwrap()
}

/// Draws a figure in twelve directions with noise of its own each: it must come back as it was drawn, radii to 1 %,
/// sweeps to 1°.
fn check(name: &str, closed: bool, drawn: &[Drawn]) {
    let wanted = kinds_drawn(drawn);
    for seed in 1..=12u32 {
        let what = format!("{name}, seed {seed}");
        let truth = path(Point::new(30.0, 40.0), f64::from(seed) * 0.53, drawn, closed);
        let points = seen(&truth, NOISE, u64::from(seed));
        let found = fitted(&points, closed);
        assert!(kink(&found) < 0.1, "{what}: kink of {}°", kink(&found));
        let starts = if closed { found.elements().len() } else { 1 };
        let begun = (0..starts).map(|k| found.started_at(k)).find(|path| kinds(path) == wanted);
        let begun = begun.unwrap_or_else(|| panic!("{what}: {} instead of {wanted}", kinds(&found)));
        for (piece, d) in begun.pieces().zip(drawn) {
            if let (Element::Arc { centre, sweep }, Arc(radius, degrees)) = (piece.element, *d) {
                let (off, turned) =
                    (piece.from.distance(centre) / radius - 1.0, sweep.to_degrees() - degrees);
                assert!(off.abs() < 0.01, "{what}: radius of {radius} off by {:.2} %", 100.0 * off);
                assert!(turned.abs() < 1.0, "{what}: sweep of {degrees}° off by {turned}°");
            }
        }
        if !closed {
            let ends = (found.start().distance(points[0]), found.end().distance(points[points.len() - 1]));
            assert!(ends.0 < 1e-9 && ends.1 < 1e-9, "{what}: ends moved by {ends:?}");
        }
        let line = found.flatten(0.01);
        let off = points.iter().map(|&p| off(p, &line)).fold(0.0, f64::max);
        assert!(off < TOLERANCE, "{what}: {off} off its points");
    }
}

/// How far a point is from a polyline.
fn off(p: Point, line: &[Point]) -> f64 {
    let to = |w: &[Point]| {
        let along = w[1] - w[0];
        let share = ((p - w[0]).dot(along) / along.hypot2().max(1e-300)).clamp(0.0, 1.0);
        p.distance(w[0] + along * share)
    };
    line.windows(2).map(to).fold(f64::INFINITY, f64::min)
}

#[test]
fn a_rounded_rectangle_is_four_lines_and_four_arcs() {
    for radius in [15.0, 25.0, 40.0, 90.0] {
        let drawn = [Line(160.0), Arc(radius, 90.0), Line(100.0), Arc(radius, 90.0)].repeat(2);
        check(&format!("rounded by {radius}"), true, &drawn);
    }
}

#[test]
fn a_stadium_is_two_lines_and_two_half_circles() {
    for radius in [8.0, 15.0, 40.0, 90.0] {
        check(&format!("stadium {radius}"), true, &[Line(120.0), Arc(radius, 180.0)].repeat(2));
    }
}

#[test]
fn a_letter_u_is_two_lines_and_the_half_circle_between_them() {
    for radius in [8.0, 15.0, 40.0, 90.0] {
        check(&format!("U {radius}"), false, &[Line(90.0), Arc(radius, -180.0), Line(60.0)]);
    }
}

#[test]
fn a_line_and_an_arc_to_the_end_are_just_that() {
    for radius in [15.0, 40.0, 90.0] {
        check(&format!("hook {radius}"), false, &[Line(80.0), Arc(radius, 140.0)]);
        check(&format!("crook {radius}"), false, &[Arc(radius, -200.0), Line(80.0)]);
    }
}

#[test]
fn arcs_pass_into_arcs() {
    for radius in [40.0, 90.0] {
        check(&format!("S {radius}"), false, &[Arc(radius, 150.0), Arc(1.4 * radius, -120.0)]);
        check(&format!("C {radius}"), false, &[Arc(radius, 110.0), Arc(2.5 * radius, 70.0)]);
        let drawn = [Arc(radius, 100.0), Arc(radius, -140.0), Arc(radius, 140.0), Arc(radius, -100.0)];
        check(&format!("snake {radius}"), false, &drawn);
    }
    check("three-centred arch", false, &[Arc(70.0, 65.0), Arc(200.0, 50.0), Arc(70.0, 65.0)]);
}

#[test]
fn a_road_bends_to_one_side_and_to_the_other() {
    for radius in [40.0, 90.0] {
        check(
            &format!("road {radius}"),
            false,
            &[Line(70.0), Arc(radius, 70.0), Arc(radius, -70.0), Line(90.0)],
        );
        check(&format!("bend {radius}"), false, &[Line(70.0), Arc(radius, 75.0), Line(90.0)]);
    }
    check("arc, short line, arc", false, &[Arc(50.0, 120.0), Line(30.0), Arc(40.0, -130.0)]);
}

/// A curve of this parameter, seen: a point every 1 along it, with noise.
fn curve(f: &dyn Fn(f64) -> (f64, f64), to: f64, seed: u64) -> Vec<Point> {
    let fine: Vec<Point> = (0..=4000).map(|k| f(to * f64::from(k) / 4000.0).into()).collect();
    seen(&spaced(&fine), NOISE, seed)
}

/// The polyline through every point that is 1 further on.
fn spaced(fine: &[Point]) -> Path {
    let (mut passed, mut path) = (0.0, Path::new(fine[0]));
    for w in fine.windows(2) {
        passed += w[0].distance(w[1]);
        if passed >= path.elements().len() as f64 + 1.0 {
            path.line_to(w[1]);
        }
    }
    path
}

/// A bend between lines whose curvature grows and falls evenly: two clothoids. It turns by `turn_rad` over `size`, and
/// `t` runs to 3.
fn clothoids(size: f64, turn_rad: f64, t: f64) -> (f64, f64) {
    const STEPS: u32 = 400;
    let turned = |u: f64| match u - 1.0 {
        v if v < 0.0 => 0.0,
        v if v < 0.5 => 2.0 * v * v,
        v if v < 1.0 => 1.0 - 2.0 * (1.0 - v) * (1.0 - v),
        _ => 1.0,
    };
    let step = t / f64::from(STEPS);
    let along = |k: u32| planar::direction(turn_rad * turned(step * (f64::from(k) + 0.5))) * step * size;
    let end: Vec2 = (0..STEPS).map(along).sum();
    (end.x, end.y)
}

#[test]
fn what_is_no_arc_does_not_become_one() {
    type Curve = (&'static str, f64, Box<dyn Fn(f64) -> (f64, f64)>);
    let curves: [Curve; 9] = [
        ("half ellipse", PI, Box::new(|t| (50.0 * t.cos(), 40.0 * t.sin()))),
        ("quarter ellipse", 0.5 * PI, Box::new(|t| (60.0 * t.cos(), 40.0 * t.sin()))),
        ("ellipse all but closed", 0.97 * TAU, Box::new(|t| (120.0 * t.cos(), 60.0 * t.sin()))),
        ("spiral", 21.0, Box::new(|t| (3.0 * (t + 4.0) * t.cos(), 3.0 * (t + 4.0) * t.sin()))),
        ("turn of a spiral", 5.0, Box::new(|t| (5.0 * (t + 4.0) * t.cos(), 5.0 * (t + 4.0) * t.sin()))),
        ("sine", 12.0, Box::new(|t| (30.0 * t, 30.0 * t.sin()))),
        ("parabola", 2.0, Box::new(|t| (60.0 * t, 60.0 * (t - 1.0) * (t - 1.0)))),
        ("clothoids", 3.0, Box::new(|t| clothoids(80.0, 1.57, t))),
        ("long clothoids", 3.0, Box::new(|t| clothoids(120.0, 2.6, t))),
    ];
    for (name, to, f) in &curves {
        for seed in 1..=12 {
            let found = fitted(&curve(f, *to, seed), false);
            assert!(!kinds(&found).contains('A'), "{name}, seed {seed}: {}", kinds(&found));
            assert!(kink(&found) < 0.1, "{name}, seed {seed}: kink of {}°", kink(&found));
        }
    }
}

#[test]
fn a_closed_ellipse_has_no_arcs() {
    for (a, b) in [(120.0, 60.0), (50.0, 40.0), (18.0, 11.0)] {
        for seed in 1..=12 {
            let mut points = curve(&|t| (a * t.cos(), b * t.sin()), TAU, seed);
            points.pop();
            let found = fitted(&points, true);
            assert!(!kinds(&found).contains('A'), "{a} by {b}, seed {seed}: {}", kinds(&found));
        }
    }
}
