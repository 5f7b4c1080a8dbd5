//! Lines of pens that are not even: that swell and taper.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on may panic")]

#[path = "support/raster.rs"]
#[allow(dead_code, reason = "each test draws with some of it")]
mod raster;

use raster::Canvas;
use tracelight_stroke::{Comparison, Point, compare_polylines};
use tracelight_vision::{Grey, Options, Traced, trace};

/// What is found of dark ink on white paper, and how it compares with what was drawn.
fn traced(canvas: &Canvas, width: usize, truth: &[Vec<Point>]) -> (Traced, Comparison) {
    let levels: Vec<u8> = canvas.shares().map(|s| (245.0 - 215.0 * s) as u8).collect();
    let height = levels.len() / width;
    let found = trace(&Grey::new(width, height, levels).unwrap(), &Options::default()).unwrap();
    let drawn: Vec<_> = found.strokes.strokes.iter().map(|s| s.path.flatten(0.02)).collect();
    let comparison = compare_polylines(&drawn, truth, 2.0).unwrap();
    (found, comparison)
}

/// A line of short pieces, each with a pen of its own width.
fn swelling(canvas: &mut Canvas, line: &[Point], width: impl Fn(f64) -> f64) {
    let pieces = (line.len() - 1) as f64;
    line.windows(2).enumerate().for_each(|(k, piece)| canvas.pen(piece, width(k as f64 / pieces)));
}

/// A bow across the picture.
fn bow(top: f64) -> Vec<Point> {
    (0..=90)
        .map(|k| Point::new(60.0 + 11.0 * f64::from(k), top + 90.0 * (f64::from(k) / 30.0).sin()))
        .collect()
}

#[test]
fn a_line_that_swells_is_followed_from_end_to_end() {
    let (wide, thin) = (26.0, 4.0);
    let pens: [&dyn Fn(f64) -> f64; 3] = [
        &|share| wide + (thin - wide) * share,
        &|share| thin + (wide - thin) * (std::f64::consts::PI * share).sin(),
        &|share| thin + (wide - thin) * (4.0 * std::f64::consts::PI * share).sin().powi(2),
    ];
    for (number, pen) in pens.into_iter().enumerate() {
        let truth = [bow(300.0)];
        let mut canvas = Canvas::new(1120, 640);
        swelling(&mut canvas, &truth[0], pen);
        let (found, comparison) = traced(&canvas, 1120, &truth);
        assert_eq!(found.strokes.strokes.len(), 1, "pen {number}: {comparison:?}");
        assert!(comparison.coverage > 0.985 && comparison.rms < 0.4, "pen {number}: {comparison:?}");
    }
}
