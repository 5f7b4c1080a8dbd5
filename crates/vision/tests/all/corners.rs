//! Drawings that once lost part of their ink: a pen of two widths, and very acute corners.

use tracelight_image::Grey;
use tracelight_maths::planar;
use tracelight_stroke::{Comparison, Point, compare_polylines};
use tracelight_vision::{Options, trace};

use crate::raster::Canvas;

/// Polylines in pens of their own on 640 × 480 px, traced; strokes found, and how they compare with what was drawn.
fn traced(figures: &[(Vec<Point>, f64)]) -> (usize, Comparison) {
    let drawn = strokes(figures, 0);
    let truth: Vec<_> = figures.iter().map(|(figure, _)| figure.clone()).collect();
    (drawn.len(), compare_polylines(&drawn, &truth, 3.0).unwrap())
}

/// The strokes found through a lens: each of so many passes blurs by a binomial of half a pixel's variance either way.
fn strokes(figures: &[(Vec<Point>, f64)], passes: usize) -> Vec<Vec<Point>> {
    let mut canvas = Canvas::new(640, 480);
    figures.iter().for_each(|(figure, pen)| canvas.pen(figure, *pen));
    let mut shares: Vec<f64> = canvas.shares().collect();
    for _ in 0..passes {
        for step in [1, 640] {
            let at = |i: usize| shares.get(i).copied().unwrap_or(0.0);
            let mean = |i: usize| 0.5 * at(i) + 0.25 * (at(i.wrapping_sub(step)) + at(i + step));
            shares = (0..shares.len()).map(mean).collect();
        }
    }
    let levels = shares.iter().map(|s| (245.0 - 225.0 * s) as u8).collect();
    let found = trace(&Grey::new(640, 480, levels).unwrap(), &Options::default()).unwrap();
    found.strokes.strokes.iter().map(|s| s.path.flatten(0.02)).collect()
}

#[test]
fn two_lines_that_part_slowly_miss_no_ink() {
    // 6° apart from one point on: in a pen of 12 px they are one wedge for 100 px and more
    let leg = |side: f64| Point::new(60.0, 240.0) + planar::direction(side * f64::to_radians(3.0)) * 300.0;
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
    let arc = |k: u32| Point::new(320.0, 320.0) + planar::direction(f64::from(k) / 100.0 * 4.7) * 120.0;
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
            |side: f64| Point::new(80.0, 240.0) + planar::direction(side * f64::to_radians(degrees)) * 400.0;
        let (strokes, comparison) = traced(&[(vec![leg(-0.5), Point::new(80.0, 240.0), leg(0.5)], 5.0)]);
        assert!(comparison.coverage > 0.995 && comparison.precision > 0.995, "{degrees}°: {comparison:?}");
        assert!(strokes <= 2, "{degrees}°: {strokes}");
    }
}

#[test]
fn the_short_arm_of_a_letter_is_kept_though_another_pen_drew_it() {
    for (stem, arm) in [(5.0, 6.2), (6.2, 5.0), (5.0, 6.6)] {
        let at = |k: f64| (40.0 + 50.0 * k, 200.0);
        let figures = (0..10).flat_map(|k| {
            let (x, y) = at(f64::from(k));
            [(row(&[(x, y), (x, y + 36.0)]), stem), (row(&[(x, y + 36.0), (x + 16.0, y + 36.0)]), arm)]
        });
        let (strokes, comparison) = traced(&figures.collect::<Vec<_>>());
        assert_eq!(strokes, 10, "{stem} and {arm} px: one stroke for each L");
        assert!(comparison.coverage > 0.98, "{stem} and {arm} px: {comparison:?}");
    }
}

#[test]
fn a_bar_as_short_as_its_junctions_are_wide_is_kept() {
    // an R: its bar leads from the stem to where bowl and leg meet
    for (bar, degrees) in [(11.0, 0.0), (11.0, 75.0), (12.0, 40.0), (13.0, 20.0), (14.0, 0.0)] {
        let turned = |p: Point| {
            Point::new(320.0, 240.0) + planar::direction(f64::to_radians(degrees)).rotate_scale(p.to_vec2())
        };
        let bowl = (0..=30).map(|k| {
            let angle = std::f64::consts::PI * (f64::from(k) / 30.0 - 0.5);
            Point::new(bar + 15.0 * angle.cos(), 15.0 * angle.sin())
        });
        let stem = row(&[(0.0, -15.0), (0.0, 45.0)]);
        let leg = row(&[(bar, 15.0), (bar + 15.0, 45.0)]);
        let top = stem[..1].iter().copied().chain(bowl).chain([Point::new(0.0, 15.0)]).collect();
        let figures = [stem, top, leg].map(|figure| (figure.into_iter().map(turned).collect(), 6.0));
        let middle = [turned(Point::new(0.5 * bar, 15.0)), turned(Point::new(0.5 * bar + 1.0, 15.0))];
        // of the bar alone: is there anything near its middle?
        let comparison = compare_polylines(&strokes(&figures, 6), &[middle.to_vec()], 1.5).unwrap();
        assert!(comparison.coverage > 0.99, "bar of {bar} px, {degrees}°: {comparison:?}");
    }
}

#[test]
fn a_hairpin_that_a_bar_crosses_just_below_its_turn_reaches_to_it() {
    // nothing of either leg is clear of all the ink where they cross and meet
    for (pen, apart, shoulder, below) in
        [(9.0, 0.65, 1.0, 1.8), (11.0, 0.65, 0.6, 1.8), (11.0, 0.75, 1.0, 2.2)]
    {
        let (half, top) = (pen * apart, 160.0 + pen * shoulder);
        let legs = row(&[
            (300.0 - half, 260.0),
            (300.0 - half, top),
            (300.0, 160.0),
            (300.0 + half, top),
            (300.0 + half, 290.0),
        ]);
        let bar = row(&[(240.0, 160.0 + pen * below), (370.0, 163.0 + pen * below)]);
        let truth = [legs.clone(), bar.clone()];
        let comparison = compare_polylines(&strokes(&[(legs, pen), (bar, pen)], 2), &truth, 3.0).unwrap();
        assert!(comparison.coverage > 0.97 && comparison.precision > 0.99, "{pen} px: {comparison:?}");
    }
}

#[test]
fn a_three_is_one_line_and_its_point_is_where_both_bows_run_together() {
    let (radius, long) = (3.0, 0.8);
    for pen in [5.0, 6.0, 7.0, 8.0] {
        let bow = |from: f64, to: f64, y: f64| {
            let at = move |k: u32| {
                let angle = from + (to - from) * f64::from(k) / 40.0;
                Point::new(320.0, y) + planar::direction(angle) * (radius * pen)
            };
            (0..=40).map(at)
        };
        // both bows end at 20° to the way on to the point
        let (end, inner) = (1.22, radius * pen * f64::sin(1.22));
        let tip = Point::new(320.0 + radius * pen * f64::cos(end) - long * pen, 240.0);
        let bows = bow(-2.6, end, 240.0 - inner).chain([tip]).chain(bow(-end, 2.6, 240.0 + inner));
        let three: Vec<Point> = bows.collect();
        let drawn = strokes(&[(three.clone(), pen)], 2);
        let comparison = compare_polylines(&drawn, &[three], 3.0).unwrap();
        assert_eq!(drawn.len(), 1, "{pen} px");
        assert!(comparison.coverage > 0.99 && comparison.precision > 0.99, "{pen} px: {comparison:?}");
    }
}
