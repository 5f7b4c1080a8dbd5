//! What people draw, in pens from thin to fat: its lines are followed in their middle, wherever many of them meet and however short
//! they are for their pen.

use std::f64::consts::{FRAC_PI_4, TAU};

use tracelight_image::Grey;
use tracelight_maths::planar;
use tracelight_stroke::{Point, StrokeKind, compare_polylines};
use tracelight_vision::{Options, Traced, trace};

use crate::raster::Canvas;

const SIDE: usize = 300;

/// Lines in a square of side 1, turned about its middle and drawn with a pen on 300 × 300 px, and what is found of them.
fn traced(figure: &[Vec<Point>], pen: f64, turned: f64) -> (Vec<Vec<Point>>, Traced) {
    let place = |p: &Point| {
        let middle = 0.5 * SIDE as f64;
        let off = planar::direction(turned).rotate_scale(*p - Point::new(0.5, 0.5));
        Point::new(middle, middle) + off * (0.84 * SIDE as f64)
    };
    let drawn: Vec<Vec<Point>> = figure.iter().map(|line| line.iter().map(place).collect()).collect();
    let mut canvas = Canvas::new(SIDE, SIDE);
    drawn.iter().for_each(|line| canvas.pen(line, pen));
    (drawn, found_on(&canvas))
}

fn found_on(canvas: &Canvas) -> Traced {
    let levels = canvas.shares().map(|share| (245.0 - 225.0 * share) as u8).collect();
    trace(&Grey::new(SIDE, SIDE, levels).unwrap(), &Options::default()).unwrap()
}

/// All of a figure is found as lines, and nothing else, in each pen.
fn check(name: &str, figure: &[Vec<Point>], pens: &[f64]) {
    for (&pen, turned) in pens.iter().flat_map(|pen| [0.05, 0.4].map(|turned| (pen, turned))) {
        let what = format!("{name} in a pen of {pen} px, turned by {turned}");
        let (drawn, found) = traced(figure, pen, turned);
        let strokes = &found.strokes.strokes;
        assert!(strokes.iter().all(|s| s.kind == StrokeKind::Centreline), "{what}: outlines");
        let rows: Vec<Vec<Point>> = strokes.iter().map(|stroke| stroke.path.flatten(0.02)).collect();
        let comparison = compare_polylines(&rows, &drawn, 0.3 * pen + 1.0).unwrap();
        assert!(comparison.coverage > 0.97 && comparison.precision > 0.97, "{what}: {comparison:?}");
    }
}

fn line(points: &[(f64, f64)]) -> Vec<Point> {
    points.iter().map(|&p| p.into()).collect()
}

fn ring(radius: f64) -> Vec<Point> {
    (0..=80).map(|k| on_ring(radius, TAU * f64::from(k) / 80.0)).collect()
}

fn on_ring(radius: f64, angle: f64) -> Point {
    Point::new(0.5, 0.5) + planar::direction(angle) * radius
}

#[test]
fn an_arrows_short_head_is_lines_too() {
    let head = |back: f64, up: f64| line(&[(0.9 - back, 0.5 - up), (0.9, 0.5), (0.9 - back, 0.5 + up)]);
    let shaft = line(&[(0.1, 0.5), (0.9, 0.5)]);
    check("an arrow", &[shaft.clone(), head(0.2, 0.15)], &[4.0, 8.0, 14.0]);
    check("a blunt arrow", &[shaft, head(0.1, 0.17)], &[4.0, 8.0, 14.0]);
}

#[test]
fn a_grid_and_a_ladder_of_short_lines_are_lines() {
    let at = |k: u32| 0.1 + 0.2 * f64::from(k);
    let upright = (0..5).map(|k| line(&[(at(k), 0.1), (at(k), 0.9)]));
    let level = (0..5).map(|k| line(&[(0.1, at(k)), (0.9, at(k))]));
    check("a grid", &upright.chain(level).collect::<Vec<_>>(), &[4.0, 8.0, 16.0]);
    let sides = [0.3, 0.7].map(|x| line(&[(x, 0.05), (x, 0.95)]));
    let rungs = (1..5).map(|k| line(&[(0.3, 0.2 * f64::from(k)), (0.7, 0.2 * f64::from(k))]));
    check("a ladder", &sides.into_iter().chain(rungs).collect::<Vec<_>>(), &[4.0, 8.0, 16.0]);
}

#[test]
fn sides_shorter_than_three_pens_keep_their_corners() {
    // a fir: where its notches are, their ink is one with that of the sides
    let half = [(0.5, 0.05), (0.25, 0.35), (0.4, 0.35), (0.2, 0.65), (0.4, 0.65), (0.15, 0.9)];
    let other = half[1..].iter().rev().map(|&(x, y)| (1.0 - x, y));
    let fir: Vec<(f64, f64)> = half.into_iter().chain(other).chain([half[0]]).collect();
    check("a fir", &[line(&fir)], &[4.0, 8.0, 16.0]);
}

#[test]
fn four_lines_through_one_place_are_four() {
    let through = |k: u32| {
        let angle = FRAC_PI_4 * f64::from(k);
        vec![on_ring(0.45, angle), on_ring(-0.45, angle)]
    };
    let figure: Vec<_> = (0..4).map(through).collect();
    check("a snowflake", &figure, &[4.0, 8.0, 12.0]);
    for pen in [4.0, 8.0, 12.0] {
        assert_eq!(traced(&figure, pen, 0.05).1.strokes.strokes.len(), 4, "in a pen of {pen} px");
    }
}

#[test]
fn a_wheels_spokes_end_at_its_hub() {
    let spoke = |k: u32| {
        let angle = FRAC_PI_4 * f64::from(k);
        vec![on_ring(0.08, angle), on_ring(0.45, angle)]
    };
    let figure: Vec<_> = [ring(0.08), ring(0.45)].into_iter().chain((0..8).map(spoke)).collect();
    check("a wheel", &figure, &[4.0, 8.0, 14.0]);
}

#[test]
fn a_disc_with_rays_stays_a_disc() {
    let ray = |k: u32| {
        let angle = FRAC_PI_4 * f64::from(k);
        vec![on_ring(0.15, angle), on_ring(0.45, angle)]
    };
    let mut canvas = Canvas::new(SIDE, SIDE);
    let place = |p: &Point| Point::new(p.x * SIDE as f64, p.y * SIDE as f64);
    let mut draw = |line: Vec<Point>, pen: f64| canvas.pen(&line.iter().map(place).collect::<Vec<_>>(), pen);
    (0..8).for_each(|k| draw(ray(k), 6.0));
    draw(line(&[(0.5, 0.5), (0.5, 0.501)]), 90.0);
    let found = found_on(&canvas);
    let outlines = found.strokes.strokes.iter().filter(|s| s.kind != StrokeKind::Centreline).count();
    assert!(outlines > 0 && found.strokes.strokes.len() > 8, "{outlines} outlines");
}
