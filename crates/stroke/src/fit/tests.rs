use std::f64::consts::{PI, TAU};

use kurbo::{Point, Vec2};
use tracelight_maths::planar;

use super::*;
use crate::distance_to_segment;

/// Points every 1 along a polyline, moved by seeded noise of this amplitude.
fn drawn(path: &[Point], noise: f64, seed: u64) -> Vec<Point> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut draw = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        ((state >> 11) as f64 / (1u64 << 53) as f64 - 0.5) * 2.0 * noise
    };
    let samples = Samples::of(path, false, 1.0).unwrap();
    samples.points.iter().map(|&p| p + Vec2::new(draw(), draw())).collect()
}

fn curve(f: impl Fn(f64) -> (f64, f64), from: f64, to: f64) -> Vec<Point> {
    (0..=4000).map(|i| f(from + (to - from) * f64::from(i) / 4000.0)).map(Point::from).collect()
}

/// Breaks of direction between neighbouring elements, rad.
fn breaks(path: &Path) -> Vec<f64> {
    let pieces: Vec<_> = path.pieces().collect();
    let mut found: Vec<f64> = Vec::new();
    for pair in pieces.windows(2) {
        found.push(window::turn(pair[0].end_tangent(), pair[1].start_tangent()).abs());
    }
    if path.is_closed() {
        found.push(window::turn(pieces[pieces.len() - 1].end_tangent(), pieces[0].start_tangent()).abs());
    }
    found
}

fn greatest_curvature(path: &Path) -> f64 {
    let of = |p: Piece| {
        let length = p.length(1e-3);
        (0..=40)
            .map(|i| p.at_length(length * f64::from(i) / 40.0, 1e-4).curvature.hypot())
            .fold(0.0, f64::max)
    };
    path.pieces().map(of).fold(0.0, f64::max)
}

fn off(path: &Path, truth: &[Point]) -> f64 {
    let line = path.flatten(0.01);
    let nearest = |p: &Point| {
        let to = |w: &[Point]| distance_to_segment(*p, w[0], w[1]);
        line.windows(2).map(to).fold(f64::INFINITY, f64::min)
    };
    truth.iter().map(nearest).fold(0.0, f64::max)
}

fn options() -> FitOptions {
    FitOptions { reach: 2.5, ..FitOptions::new(0.35) }
}

#[test]
fn a_star_gets_its_ten_sharp_corners_back() {
    let tip = |i: u32| {
        let radius = if i.is_multiple_of(2) { 200.0 } else { 80.0 };
        Point::ORIGIN + planar::direction(TAU * f64::from(i) / 10.0) * radius
    };
    let mut star: Vec<_> = (0..=10).map(tip).collect();
    star[10] = star[0];
    for seed in 1..20 {
        let path = fit(&drawn(&star, 0.1, seed), true, &options()).unwrap();
        assert_eq!(path.elements().len(), 10, "seed {seed}");
        assert!(path.elements().iter().all(|e| matches!(e, Element::Line { .. })));
        let corner_off = |p: &Point| star.iter().map(|s| s.distance(*p)).fold(f64::INFINITY, f64::min);
        let worst = path.pieces().map(|p| corner_off(&p.from)).fold(0.0, f64::max);
        assert!(worst < 0.25, "seed {seed}: {worst}");
    }
}

#[test]
fn a_circle_is_two_arcs() {
    let circle = curve(|t| (50.0 * t.cos(), 50.0 * t.sin()), 0.0, TAU);
    let path = fit(&drawn(&circle, 0.1, 3), true, &options()).unwrap();
    assert!(matches!(path.elements(), [Element::Arc { .. }, Element::Arc { .. }]));
    assert!((path.length(1e-6) - 100.0 * PI).abs() < 0.2);
}

#[test]
fn a_ring_that_stays_open_goes_all_the_way_round() {
    for gap in [0.5, 2.0, 6.0, 40.0] {
        let ring = curve(|t| (100.0 * t.cos(), 100.0 * t.sin()), 0.0, TAU - gap / 100.0);
        for seed in 1..10 {
            let path = fit(&drawn(&ring, 0.1, seed), false, &options()).unwrap();
            let length = path.length(1e-6);
            assert!((length - (200.0 * PI - gap)).abs() < 0.7, "gap {gap}, seed {seed}: {length} long");
        }
    }
}

#[test]
fn smooth_curves_have_no_kinks_and_no_peaks_of_curvature() {
    type Curve = (&'static str, bool, f64, Vec<Point>);
    let curves: Vec<Curve> = vec![
        ("ellipse", true, 120.0 / 3600.0, curve(|t| (120.0 * t.cos(), 60.0 * t.sin()), 0.0, TAU)),
        ("spiral", false, 1.0 / 12.0, curve(|t| (3.0 * t * t.cos(), 3.0 * t * t.sin()), 4.0, 25.0)),
        ("wave", false, 30.0 / 900.0, curve(|t| (30.0 * t, 30.0 * t.sin()), 0.0, 12.0)),
        ("line", false, 0.0, curve(|t| (t, 0.3 * t), 0.0, 300.0)),
        ("big circle", false, 1.0 / 300.0, curve(|t| (300.0 * t.cos(), 300.0 * t.sin()), 0.0, 2.0)),
        ("loop", false, 25.0 / 169.0, curve(|t| (12.0 * t - 25.0 * t.sin(), -25.0 * t.cos()), 0.0, 20.0)),
    ];
    for (name, closed, sharpest, truth) in &curves {
        for seed in 1..10 {
            let path = fit(&drawn(truth, 0.1, seed), *closed, &options()).unwrap();
            let kink = breaks(&path).into_iter().fold(0.0, f64::max).to_degrees();
            let (bend, off) = (greatest_curvature(&path), off(&path, truth));
            println!(
                "{name} {seed}: {} elements, kink {kink:.4}, curvature {bend:.4} of {sharpest:.4}, off {off:.3}",
                path.elements().len()
            );
            assert!(kink < 0.1, "{name} {seed}: kink of {kink}°");
            assert!(bend < 1.5 * sharpest + 2e-3, "{name} {seed}: curvature {bend} where {sharpest} is");
            assert!(off < 0.35, "{name} {seed}: off by {off}");
        }
    }
}

#[test]
fn a_rounded_square_is_lines_and_bends_without_a_corner() {
    for radius in [8.0, 15.0, 40.0] {
        let side = |a: f64| {
            curve(
                move |t| {
                    let centre = planar::direction(a) * 80.0 + planar::direction(a + PI / 2.0) * 80.0;
                    (centre + planar::direction(a + t) * radius).into()
                },
                0.0,
                PI / 2.0,
            )
        };
        let square: Vec<_> =
            [side(0.0), side(PI / 2.0), side(PI), side(1.5 * PI), side(0.0)[..1].to_vec()].concat();
        let path = fit(&drawn(&square, 0.08, 5), true, &options()).unwrap();
        let lines = path.elements().iter().filter(|e| matches!(e, Element::Line { .. })).count();
        let kink = breaks(&path).into_iter().fold(0.0, f64::max).to_degrees();
        println!(
            "radius {radius}: {} elements, {lines} lines, kink {kink:.4}, curvature {:.4}",
            path.elements().len(),
            greatest_curvature(&path)
        );
        assert_eq!(lines, 4, "radius {radius}");
        assert!(kink < 0.1 && path.elements().len() <= 12, "radius {radius}: {kink}");
        assert!(greatest_curvature(&path) < 1.6 / radius, "radius {radius}");
    }
}

#[test]
fn an_open_line_keeps_its_ends_and_its_corner() {
    let hook = [(0.0, 0.0), (100.0, 0.0), (60.0, 80.0)].map(Point::from);
    let path = fit(&drawn(&hook, 0.0, 1), false, &options()).unwrap();
    assert_eq!(path.elements().len(), 2);
    assert!(path.start().distance(hook[0]) < 1e-9 && path.end().distance(hook[2]) < 1e-9);
    assert!(path.pieces().nth(1).unwrap().from.distance(hook[1]) < 0.05);
}

#[test]
fn hardly_any_points_are_no_reason_to_fail() {
    let o = options();
    let p = Point::new(1.0, 2.0);
    assert_eq!(fit(&[], false, &o), None);
    assert_eq!(fit(&[p, p, p], true, &o), None);
    assert_eq!(fit(&[Point::new(f64::NAN, 0.0), p], false, &o), None);
    for n in 2..12 {
        for closed in [false, true] {
            let points: Vec<_> = (0..n).map(|i| Point::new(f64::from(i * i % 5), f64::from(i % 3))).collect();
            let path = fit(&points, closed, &o).unwrap();
            assert!(path.flatten(0.01).iter().all(|p| p.is_finite()));
        }
    }
}

#[test]
fn a_small_ring_of_one_corner_is_not_lost() {
    // the edge of a triangle 11 px wide, as a tracer found it, and a tolerance as wide as its noise
    let down = (0..15).map(|i| Point::new(8.5 - 0.5 * f64::from(i), 8.0 - 0.5 * f64::from(i)));
    let right =
        [(12., 0.5), (12., 1.5), (12., 2.5), (11.5, 3.), (11., 3.5), (11., 4.5), (11., 5.5), (10.5, 6.)];
    let across = (0..11).map(|i| Point::new(1.5 + f64::from(i), 0.0));
    let rest = [(10., 6.5), (9.5, 7.), (9., 7.5)].map(Point::from);
    let start = Point::new(1.0, 0.5);
    let ring: Vec<_> =
        std::iter::once(start).chain(across).chain(right.map(Point::from)).chain(rest).chain(down).collect();
    let options = FitOptions { reach: 2.0, ..FitOptions::new(1.585) };
    let path = fit(&ring, true, &options).unwrap();
    assert!((20.0..40.0).contains(&path.length(1e-6)), "{path:?}");
}

#[test]
fn points_too_far_out_to_reckon_with_are_passed_over() {
    let far = [(0.0, 1.0), (1e300, -1e200), (5.0, -7.5), (f64::INFINITY, 0.0)].map(Point::from);
    let path = fit(&far, false, &options()).unwrap();
    assert_eq!((path.start(), path.end()), (far[0], far[2]));
}
