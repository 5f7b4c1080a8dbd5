//! Filled shapes come back as their outlines: pale ones, ones with holes, small ones with many corners.

use std::f64::consts::TAU;

use tracelight_image::Grey;
use tracelight_maths::planar;
use tracelight_stroke::{Comparison, Point, StrokeKind, compare_polylines};
use tracelight_vision::{Options, Traced, trace};

use crate::raster::Canvas;

/// What is found of ink on paper of level 245, and how it compares with what was drawn.
fn traced(canvas: &Canvas, width: usize, ink: f64, truth: &[Vec<Point>]) -> (Traced, Comparison) {
    let levels: Vec<u8> = canvas.shares().map(|s| (245.0 - (245.0 - ink) * s) as u8).collect();
    let height = levels.len() / width;
    let found = trace(&Grey::new(width, height, levels).unwrap(), &Options::default()).unwrap();
    let drawn: Vec<_> = found.strokes.strokes.iter().map(|s| s.path.flatten(0.02)).collect();
    let comparison = compare_polylines(&drawn, truth, 2.0).unwrap();
    (found, comparison)
}

fn ring(centre: (f64, f64), radii: (f64, f64)) -> Vec<Point> {
    let at = |k: u32| {
        let way = planar::direction(TAU * f64::from(k) / 200.0);
        Point::new(centre.0 + radii.0 * way.x, centre.1 + radii.1 * way.y)
    };
    (0..=200).map(at).collect()
}

/// A star of so many points, from its hollows' radius to its tips', closed.
fn star(centre: (f64, f64), radii: (f64, f64), points: u32) -> Vec<Point> {
    let at = |k: u32| {
        let radius = if k.is_multiple_of(2) { radii.1 } else { radii.0 };
        Point::from(centre) + planar::direction(TAU * f64::from(k) / f64::from(2 * points) + 0.1) * radius
    };
    (0..=2 * points).map(at).collect()
}

#[test]
fn a_large_pale_shape_is_no_shadow() {
    for ink in [170.0, 190.0, 205.0] {
        for radii in [(90.0, 90.0), (140.0, 100.0), (60.0, 45.0)] {
            let truth = [ring((330.0, 230.0), radii)];
            let mut canvas = Canvas::new(640, 480);
            canvas.fill(&truth);
            let (found, comparison) = traced(&canvas, 640, ink, &truth);
            assert_eq!(found.strokes.strokes.len(), 1, "level {ink}, {radii:?}");
            assert!(comparison.coverage > 0.999 && comparison.precision > 0.999, "{ink}: {comparison:?}");
        }
    }
}

#[test]
fn a_small_hole_makes_no_pen_of_a_shape() {
    for hole in [4.0, 5.5, 7.0] {
        let disc = [ring((200.0, 150.0), (27.0, 27.0)), ring((200.0, 150.0), (hole, hole))];
        let drop = ring((420.0, 300.0), (16.0, 13.0));
        let truth = [&disc[..], &[drop]].concat();
        let mut canvas = Canvas::new(640, 480);
        canvas.fill(&truth);
        let (found, comparison) = traced(&canvas, 640, 30.0, &truth);
        let is_outline = |s: &tracelight_stroke::Stroke| s.kind == StrokeKind::Outline;
        assert!(found.strokes.strokes.iter().all(is_outline), "hole of {hole} px");
        assert_eq!(found.strokes.strokes.len(), 3, "hole of {hole} px");
        assert!(comparison.coverage > 0.999 && comparison.precision > 0.999, "{hole}: {comparison:?}");
    }
}

#[test]
fn a_nut_with_a_small_hole_is_a_shape_however_it_is_turned() {
    // their corners' spurs are pruned from the skeleton
    for (corners, radius) in [(4, 38.0), (5, 33.0), (6, 31.0)] {
        for turn in [0.0, 0.1, 0.3] {
            let at = |k: u32| {
                Point::new(200.0, 150.0)
                    + planar::direction(TAU * f64::from(k) / f64::from(corners) + turn) * radius
            };
            let truth = [
                (0..=corners).map(at).collect(),
                ring((200.0, 150.0), (7.0, 7.0)),
                ring((420.0, 300.0), (16.0, 13.0)),
            ];
            let mut canvas = Canvas::new(640, 480);
            canvas.fill(&truth);
            let (found, comparison) = traced(&canvas, 640, 30.0, &truth);
            assert_eq!(found.strokes.strokes.len(), 3, "{corners} corners, {turn} rad");
            assert!(comparison.coverage > 0.99, "{corners} corners, {turn} rad: {comparison:?}");
        }
    }
}

#[test]
fn a_grid_alone_is_lines() {
    for (pen, pitch) in [(6.0, 20.0), (6.0, 16.0), (4.0, 12.0)] {
        let line = |k: i32| {
            let at = 120.0 + pitch * f64::from(k);
            let (from, to) = (120.0 - pitch, 120.0 + 9.0 * pitch);
            [vec![Point::new(at, from), Point::new(at, to)], vec![Point::new(from, at), Point::new(to, at)]]
        };
        let truth: Vec<Vec<Point>> = (0..9).flat_map(line).collect();
        let mut canvas = Canvas::new(640, 480);
        truth.iter().for_each(|line| canvas.pen(line, pen));
        let (found, comparison) = traced(&canvas, 640, 30.0, &truth);
        let is_line = |s: &tracelight_stroke::Stroke| s.kind == StrokeKind::Centreline;
        assert!(found.strokes.strokes.iter().all(is_line), "pen {pen}, pitch {pitch}");
        assert_eq!(found.strokes.strokes.len(), 18, "pen {pen}, pitch {pitch}");
        assert!(comparison.coverage > 0.99, "pen {pen}, pitch {pitch}: {comparison:?}");
    }
}

#[test]
fn the_stick_of_a_lollipop_tells_the_pen_where_it_is_the_only_line() {
    // the second shape would else be lines about its two holes
    let holes = [ring((430.0, 318.0), (6.0, 6.0)), ring((430.0, 342.0), (6.0, 6.0))];
    let shapes = [vec![star((430.0, 330.0), (30.0, 36.0), 3)], holes.to_vec()].concat();
    let stick = vec![Point::new(100.0, 300.0), Point::new(160.0, 170.0)];
    let mut canvas = Canvas::new(640, 480);
    canvas.fill(&shapes);
    canvas.pen(&stick, 4.0);
    let disc = ring((165.0, 159.0), (12.0, 12.0));
    canvas.pen(&[Point::new(165.0, 159.0); 2], 24.0);
    let (found, comparison) = traced(&canvas, 640, 30.0, &[shapes, vec![stick, disc]].concat());
    let lines = found.strokes.strokes.iter().filter(|s| s.kind == StrokeKind::Centreline).count();
    assert_eq!((lines, found.strokes.strokes.len()), (1, 5));
    assert!(comparison.coverage > 0.98 && comparison.precision > 0.99, "{comparison:?}");
}

#[test]
fn the_smallest_ring_is_a_line_about_its_hole() {
    // its hole has three to five pixels
    for (radius, centre) in [(2.5, (160.0, 120.0)), (2.6, (160.5, 120.5)), (2.6, (160.3, 120.2))] {
        let truth = [ring(centre, (radius, radius)), vec![Point::new(60.0, 60.0), Point::new(250.0, 80.0)]];
        let mut canvas = Canvas::new(320, 240);
        truth.iter().for_each(|line| canvas.pen(line, 2.6));
        let (found, comparison) = traced(&canvas, 320, 30.0, &truth);
        let is_line = |s: &tracelight_stroke::Stroke| s.kind == StrokeKind::Centreline;
        assert!(found.strokes.strokes.iter().all(is_line), "radius {radius}");
        assert_eq!(found.strokes.strokes.len(), 2, "radius {radius}");
        assert!(comparison.rms < 0.3 && comparison.coverage > 0.99, "radius {radius}: {comparison:?}");
    }
}

#[test]
fn a_small_star_keeps_its_points() {
    for (points, radii) in [(6, (15.0, 26.0)), (6, (17.0, 30.0)), (8, (20.0, 32.0))] {
        let truth = [star((160.0, 120.0), radii, points)];
        let mut canvas = Canvas::new(320, 240);
        canvas.fill(&truth);
        let (_, comparison) = traced(&canvas, 320, 30.0, &truth);
        assert!(comparison.rms < 0.3 && comparison.coverage > 0.99, "{points} points: {comparison:?}");
    }
}

#[test]
fn steps_of_a_few_pixels_are_followed_though_most_of_an_outline_is_steps() {
    for side in [8.0, 10.0, 14.0] {
        // down a diagonal, and back along a border
        let corner =
            |k: u32| Point::new(60.0 + side * f64::from(k / 2), 50.0 + side * f64::from(k.div_ceil(2)));
        let steps: Vec<Point> = (0..=48).map(corner).collect();
        let back = [Point::new(60.0, steps[48].y), steps[0]];
        let truth = [[&steps[..], &back].concat()];
        let mut canvas = Canvas::new(640, 480);
        canvas.fill(&truth);
        let (_, comparison) = traced(&canvas, 640, 30.0, &truth);
        assert!(comparison.max < 1.5 && comparison.rms < 0.25, "{side} px: {comparison:?}");
    }
}
