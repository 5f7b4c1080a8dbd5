//! Drawings that once lost part of their ink: a pen of two widths, and very acute corners.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on may panic")]

#[path = "support/raster.rs"]
#[allow(dead_code, reason = "each test draws with some of it")]
mod raster;

use raster::Canvas;
use tracelight_stroke::{Comparison, Point, Vec2, compare_polylines};
use tracelight_vision::{Grey, Options, trace};

/// Polylines in pens of their own on 640 × 480 px, traced; strokes found, and how they compare with what was drawn.
fn traced(figures: &[(Vec<Point>, f64)]) -> (usize, Comparison) {
    let mut canvas = Canvas::new(640, 480);
    figures.iter().for_each(|(figure, pen)| canvas.pen(figure, *pen));
    let levels = canvas.shares().map(|s| (245.0 - 225.0 * s) as u8).collect();
    let found = trace(&Grey::new(640, 480, levels).unwrap(), &Options::default()).unwrap();
    let drawn: Vec<_> = found.strokes.strokes.iter().map(|s| s.path.flatten(0.02)).collect();
    let truth: Vec<_> = figures.iter().map(|(figure, _)| figure.clone()).collect();
    (drawn.len(), compare_polylines(&drawn, &truth, 3.0).unwrap())
}

#[test]
fn two_lines_that_part_slowly_miss_no_ink() {
    // 6° apart from one point on: in a pen of 12 px they are one wedge for 100 px and more
    let leg = |side: f64| Point::new(60.0, 240.0) + Vec2::from_angle(side * f64::to_radians(3.0)) * 300.0;
    let mut canvas = Canvas::new(640, 480);
    canvas.pen(&[leg(-1.0), Point::new(60.0, 240.0), leg(1.0)], 12.0);
    let levels = canvas.shares().map(|s| (245.0 - 225.0 * s) as u8).collect();
    let traced = trace(&Grey::new(640, 480, levels).unwrap(), &Options::default()).unwrap();
    assert!(traced.missed_ink < 0.02, "{}", traced.missed_ink);
}

fn row(points: &[(f64, f64)]) -> Vec<Point> {
    points.iter().map(|&p| p.into()).collect()
}

#[test]
fn a_line_thicker_than_the_rest_of_its_figure_is_kept_to_its_end() {
    let arc = |k: u32| Point::new(320.0, 320.0) + Vec2::from_angle(f64::from(k) / 100.0 * 4.7) * 120.0;
    let (_, comparison) = traced(&[
        (row(&[(80.0, 418.0), (320.0, 60.0), (560.0, 418.0)]), 4.0),
        (row(&[(80.0, 418.0), (560.0, 418.0)]), 6.0),
        ((0..=100).map(arc).collect(), 5.0),
    ]);
    assert!(comparison.coverage > 0.995 && comparison.precision > 0.995, "{comparison:?}");
    assert!((comparison.length_ratio - 1.0).abs() < 0.02, "{comparison:?}");
}

#[test]
fn an_acute_corner_reaches_to_its_point() {
    for degrees in [12.0, 15.0, 20.0, 30.0, 45.0] {
        let leg =
            |side: f64| Point::new(80.0, 240.0) + Vec2::from_angle(side * f64::to_radians(degrees)) * 400.0;
        let (strokes, comparison) = traced(&[(vec![leg(-0.5), Point::new(80.0, 240.0), leg(0.5)], 5.0)]);
        assert!(comparison.coverage > 0.995 && comparison.precision > 0.995, "{degrees}°: {comparison:?}");
        assert!(strokes <= 2, "{degrees}°: {strokes}");
    }
}
