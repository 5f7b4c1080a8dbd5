//! Any row of points is fitted by a path near it, and any strokes are put in an order that has all of them.

use std::f64::consts::{PI, TAU};

use oorandom::Rand64;
use tracelight_maths::planar;
use tracelight_stroke::{
    Drawing, Effort, Element, FitOptions, OrderOptions, Path, Point, Stroke, Vec2, fit, order, simplify,
};

fn uniform(r: &mut Rand64, low: f64, high: f64) -> f64 {
    low + (high - low) * r.rand_float()
}

fn place(r: &mut Rand64) -> Point {
    Point::new(uniform(r, -30.0, 30.0), uniform(r, -30.0, 30.0))
}

/// Points of one kind: scattered, a lattice where many coincide, a walk, a saw, a closed curve with noise.
fn points(kind: u64, r: &mut Rand64) -> Vec<Point> {
    let count = 2 + r.rand_range(0..60) as i32;
    let noise = [0.0, 0.1, 1.0][r.rand_range(0..3) as usize];
    let (a, b) = (uniform(r, 0.5, 6.0), uniform(r, 0.5, 6.0));
    let mut at = place(r);
    let of = |i: i32| match kind {
        0 => place(r),
        1 => Point::new(r.rand_range(0..4) as f64, r.rand_range(0..3) as f64),
        2 => {
            at += planar::direction(uniform(r, 0.0, TAU)) * uniform(r, 0.0, 2.0);
            at
        }
        3 => Point::new(f64::from(i) * a, f64::from(i % 7 / 5) * 10.0 * b),
        _ => {
            let t = TAU * f64::from(i) / f64::from(count);
            let shake = Vec2::new(uniform(r, -noise, noise), uniform(r, -noise, noise));
            Point::new(40.0 * (a.round() * t).cos(), 25.0 * (b.round() * t).sin()) + shake
        }
    };
    (0..count).map(of).collect()
}

fn options(r: &mut Rand64) -> FitOptions {
    FitOptions {
        tolerance: [0.1, 0.35, 0.35, 2.0][r.rand_range(0..4) as usize],
        corner_rad: [0.05, 25f64.to_radians(), 1.5, PI][r.rand_range(0..4) as usize],
        reach: [0.0, 1.4, 6.0][r.rand_range(0..3) as usize],
    }
}

/// How far a point lies outside the box of some points.
fn outside(p: Point, points: &[Point]) -> f64 {
    let fold =
        |f: fn(f64, f64) -> f64| points.iter().copied().reduce(|a, b| (f(a.x, b.x), f(a.y, b.y)).into());
    let (low, high) = (fold(f64::min).unwrap(), fold(f64::max).unwrap());
    [low.x - p.x, low.y - p.y, p.x - high.x, p.y - high.y].into_iter().fold(0.0, f64::max)
}

#[test]
fn any_points_are_fitted_nearby_from_the_first_to_the_last() {
    let mut r = Rand64::new(7);
    let mut worst = 0.0_f64;
    for number in 0..1_500 {
        let (points, options, closed) =
            (points(number % 5, &mut r), options(&mut r), r.rand_range(0..2) == 1);
        let what = format!("row {number}, closed {closed}, {options:?}");
        let distinct = points.windows(2).any(|w| w[0] != w[1]);
        let path = fit(&points, closed, &options);
        assert_eq!(path.is_some(), distinct, "{what}: {points:?}");
        assert_eq!(path, fit(&points, closed, &options), "{what}: a second run differs");
        let Some(path) = path else { continue };
        assert!(path.length(1e-3) > 0.0, "{what}: nothing is left of {points:?}");
        if !closed {
            let ends = (path.start().distance(points[0]), path.end().distance(points[points.len() - 1]));
            assert!(ends.0 < 1e-9 && ends.1 < 1e-9, "{what}: ends moved by {ends:?}");
        }
        let size = points.iter().map(|p| p.distance(points[0])).fold(0.0, f64::max);
        for p in path.flatten(0.1) {
            let off = outside(p, &points);
            worst = worst.max(off / (size + 4.0 * options.reach));
            assert!(off <= size + 4.0 * options.reach, "{what}: {off} outside points of size {size}");
        }
        assert!(simplify(&points, closed, options.tolerance).len() <= points.len());
    }
    println!("{worst:.3} of what is allowed");
}

#[test]
fn points_that_are_no_numbers_are_passed_over() {
    let mut r = Rand64::new(9);
    let wild = [f64::NAN, f64::INFINITY, -f64::INFINITY, f64::MAX, f64::MIN_POSITIVE, 1e59, -1e59, 1e-200];
    for number in 0..40 {
        let mut points = points(number % 5, &mut r);
        for _ in 0..1 + r.rand_range(0..3) {
            let at = r.rand_range(0..points.len() as u64) as usize;
            let value = wild[r.rand_range(0..wild.len() as u64) as usize];
            points[at] = if number % 2 == 0 { Point::new(value, 1.0) } else { Point::new(1.0, value) };
        }
        let closed = r.rand_range(0..2) == 1;
        let Some(path) = fit(&points, closed, &options(&mut r)) else { continue };
        assert!(path.pieces().all(|p| p.end().is_finite()), "row {number}: {points:?} became {path:?}");
    }
}

fn stroke(number: usize, r: &mut Rand64) -> Stroke {
    // on a lattice, so that ends coincide
    let mut knot = || Point::new(r.rand_range(0..9) as f64, r.rand_range(0..9) as f64);
    let mut path = Path::new(knot());
    path.line_to(knot());
    path.push(Element::Cubic { c1: knot(), c2: knot(), to: knot() });
    path.push(Element::Arc { centre: knot(), sweep: 1.0 });
    if number.is_multiple_of(3) {
        path.close();
    }
    Stroke { layer: Some(number.to_string().into()), ..Stroke::new(path) }
}

#[test]
fn any_order_has_every_stroke_once() {
    let mut r = Rand64::new(11);
    let uphill_is_dear = |a: Point, b: Point| a.distance(b) + (b.y - a.y).max(0.0);
    for number in 0..200 {
        let count = r.rand_range(0..40) as usize;
        let drawing = Drawing { strokes: (0..count).map(|i| stroke(i, &mut r)).collect() };
        let effort = if number % 4 == 0 { Effort::Normal } else { Effort::Quick };
        let ordered = order(&drawing, place(&mut r), OrderOptions { effort, seed: number }, &uphill_is_dear);
        let name = |s: &Stroke| s.layer.as_deref().unwrap().parse::<usize>().unwrap();
        let mut names: Vec<usize> = ordered.drawing.strokes.iter().map(name).collect();
        for (stroke, &name) in ordered.drawing.strokes.iter().zip(&names) {
            let (was, is) = (drawing.strokes[name].path.length(1e-6), stroke.path.length(1e-6));
            assert!((was - is).abs() < 1e-4, "drawing {number}: stroke {name} of {was} became {is} long");
        }
        names.sort_unstable();
        assert!(names.into_iter().eq(0..count), "drawing {number}");
        assert!(ordered.lower_bound <= ordered.travel * (1.0 + 1e-9), "drawing {number}");
    }
}
