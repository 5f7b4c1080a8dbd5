//! Small figures and sharp angles come out as their strokes: crosses of a few pixels, corners however sharp, tight bows, lines that
//! cross at a few degrees or touch, small crescents.

use std::f64::consts::{PI, TAU};

use tracelight_image::Grey;
use tracelight_maths::planar;
use tracelight_stroke::{Point, Stroke, StrokeKind, compare_polylines};
use tracelight_vision::{Options, trace};

use crate::raster::Canvas;

const WIDTH: usize = 480;
const HEIGHT: usize = 360;

/// The strokes of dark ink on white paper.
fn strokes(canvas: &Canvas) -> Vec<Stroke> {
    strokes_of(canvas.shares())
}

/// The same by how much of each pixel's light the ink takes.
fn strokes_of(shares: impl Iterator<Item = f64>) -> Vec<Stroke> {
    let levels = shares.map(|s| (250.0 - 220.0 * s) as u8).collect();
    trace(&Grey::new(WIDTH, HEIGHT, levels).unwrap(), &Options::default()).unwrap().strokes.strokes
}

/// Checks that each line has a stroke of its own that covers nine tenths of it to `within` px, and lies on it to nine tenths, and that
/// there are no others.
fn each_is_drawn(lines: &[Vec<Point>], pen: f64, within: f64, what: &str) {
    let mut canvas = Canvas::new(WIDTH, HEIGHT);
    lines.iter().for_each(|line| canvas.pen(line, pen));
    let found = strokes(&canvas);
    assert_eq!(found.len(), lines.len(), "{what}");
    for (number, line) in lines.iter().enumerate() {
        let own = found.iter().any(|stroke| {
            let drawn = [stroke.path.flatten(0.02)];
            let comparison = compare_polylines(&drawn, std::slice::from_ref(line), within).unwrap();
            comparison.coverage > 0.9 && comparison.precision > 0.9
        });
        assert!(own, "{what}: line {number} has no stroke of its own");
    }
}

fn arc(centre: (f64, f64), radius: f64, from: f64, sweep: f64) -> Vec<Point> {
    let at = |k: i32| Point::from(centre) + planar::direction(from + sweep * f64::from(k) / 160.0) * radius;
    (0..=160).map(at).collect()
}

/// A line of some length about a place.
fn bar(middle: (f64, f64), length: f64, angle: f64) -> Vec<Point> {
    let half = planar::direction(angle) * (0.5 * length);
    vec![Point::from(middle) - half, Point::from(middle) + half]
}

#[test]
fn small_crosses_run_through() {
    for (size, pen) in [(8.0, 1.5), (10.0, 1.8), (14.0, 2.5)] {
        let lines: Vec<Vec<Point>> = (0..12)
            .flat_map(|k| {
                let middle = (60.0 + 35.7 * f64::from(k % 4), 60.0 + 41.3 * f64::from(k / 4));
                [0.0, 0.5 * PI].map(|turn| bar(middle, size, turn + 0.26 * f64::from(k)))
            })
            .collect();
        each_is_drawn(&lines, pen, 2.0, &format!("crosses of {size} px"));
    }
}

#[test]
fn the_bar_of_a_small_t_is_whole() {
    let lines: Vec<Vec<Point>> = (0..8)
        .flat_map(|k| {
            let (x, y) = (60.3 + 37.1 * f64::from(k), 80.0 + 0.37 * f64::from(k));
            [bar((x, y), 10.0, 0.0), vec![Point::new(x, y), Point::new(x - 0.5, y + 14.0)]]
        })
        .collect();
    each_is_drawn(&lines, 2.2, 2.0, "small T");
}

#[test]
fn letters_of_eight_px_are_whole_and_stay_apart() {
    let letter = |x: f64, y: f64, k: usize| -> Vec<Vec<Point>> {
        let p = |u: f64, v: f64| Point::new(x + u, y + v);
        match k % 3 {
            0 => vec![vec![p(0.0, 0.0), p(6.0, 0.0)], vec![p(3.0, 0.0), p(3.0, 8.0)]],
            1 => vec![vec![p(0.0, 0.0), p(6.0, 0.0), p(2.0, 8.0)]],
            // a tick
            _ => vec![vec![p(0.0, 4.0), p(2.0, 8.0), p(6.5, 1.0)]],
        }
    };
    // from bar to bar there are 3 px of paper
    let lines: Vec<Vec<Point>> =
        (0..12).flat_map(|k| letter(60.0 + 10.5 * k as f64, 80.0 + 1.3 * (k / 3) as f64, k)).collect();
    each_is_drawn(&lines, 1.5, 2.0, "letters of 8 px");
}

#[test]
fn crosses_and_rings_of_a_thin_pen_beside_a_thick_one_are_no_dust() {
    let mut canvas = Canvas::new(WIDTH, HEIGHT);
    canvas.pen(&[Point::new(60.0, 280.0), Point::new(420.0, 300.0)], 12.0);
    for k in 0..6 {
        let (x, y) = (80.2 + 55.3 * f64::from(k), 90.4 + 0.3 * f64::from(k));
        canvas.pen(&bar((x, y), 9.0, 0.6), 1.2);
        canvas.pen(&bar((x, y), 9.0, 0.6 + 0.5 * PI), 1.2);
        canvas.pen(&arc((x, y + 60.0), 4.0, 0.0, TAU), 1.2);
    }
    // a lens spreads what is thin
    let shares: Vec<f64> = canvas.shares().collect();
    let spread = |k: usize| {
        let (x, y) = (k % WIDTH, k / WIDTH);
        let beside = |v: usize, by: usize, most: usize| (v + by).saturating_sub(1).min(most - 1);
        let share = |i: usize| shares[beside(y, i / 3, HEIGHT) * WIDTH + beside(x, i % 3, WIDTH)];
        let weight = |i: usize| [0.28, 0.44, 0.28][i / 3] * [0.28, 0.44, 0.28][i % 3];
        (0..9).map(|i| weight(i) * share(i)).sum::<f64>()
    };
    let found = strokes_of((0..WIDTH * HEIGHT).map(spread));
    assert_eq!(found.len(), 1 + 6 * 3);
    assert_eq!(found.iter().filter(|stroke| stroke.path.is_closed()).count(), 6);
}

#[test]
fn a_fat_stem_that_runs_on_beyond_a_bow_keeps_its_nub() {
    for (k, pen) in [9.0, 10.0, 11.0].into_iter().enumerate() {
        let (x, y) = (70.0 + 130.0 * k as f64, 40.0);
        let stem = vec![Point::new(x, y), Point::new(x + 3.0, y + 24.0 * pen)];
        // a bow that leaves it upwards, 1.5 pens below the stem's upper end
        let bow = arc((x + 2.8 * pen + 0.2, y + 4.2 * pen), 3.9 * pen, -2.37, 4.4);
        let mut canvas = Canvas::new(WIDTH, HEIGHT);
        [&stem, &bow].into_iter().for_each(|line| canvas.pen(line, pen));
        let drawn: Vec<Vec<Point>> =
            strokes(&canvas).iter().map(|stroke| stroke.path.flatten(0.02)).collect();
        let comparison = compare_polylines(&drawn, &[stem], 0.5 * pen).unwrap();
        assert!(comparison.coverage > 0.98, "pen {pen}: {} of the stem is drawn", comparison.coverage);
    }
}

#[test]
fn rings_that_touch_or_overlap_a_little_stay_rings() {
    for (pen, overlap) in [(3.0, 0.0), (4.0, 1.0), (4.0, 1.5)] {
        let rings: Vec<Vec<Point>> =
            [(70.0, 80.0, 40.0, 24.0), (90.0, 240.0, 45.0, 35.0), (280.0, 150.0, 60.0, 28.0)]
                .into_iter()
                .flat_map(|(x, y, large, small)| {
                    let middle = Point::new(x, y) + planar::direction(0.005 * x) * (large + small - overlap);
                    [arc((x, y), large, 0.0, TAU), arc((middle.x, middle.y), small, 0.0, TAU)]
                })
                .collect();
        each_is_drawn(&rings, pen, 2.0, &format!("rings of a pen of {pen} px"));
    }
}

#[test]
fn a_corner_is_one_line_however_sharp_it_is() {
    for pen in [2.5, 4.0, 5.0] {
        let lines: Vec<Vec<Point>> = (0..6)
            .map(|k| {
                let half = (6.0 + 3.0 * f64::from(k)).to_radians();
                let tip = Point::new(180.0 + 200.0 * f64::from(k % 2), 60.0 + 110.0 * f64::from(k / 2));
                [half, -half].map(|a| tip - planar::direction(a) * 130.0).to_vec()
            })
            .zip(0..)
            .map(|(ends, k)| {
                let tip = Point::new(180.0 + 200.0 * f64::from(k % 2), 60.0 + 110.0 * f64::from(k / 2));
                vec![ends[0], tip, ends[1]]
            })
            .collect();
        each_is_drawn(&lines, pen, 2.0, &format!("corners of a pen of {pen} px"));
    }
}

#[test]
fn a_tight_bow_goes_round() {
    for (radius, pen) in [(3.4, 5.0), (4.0, 6.0), (6.0, 4.0)] {
        for turn in (0..24).map(|k| TAU * f64::from(k) / 24.0) {
            let leg = |side: f64| Point::new(-110.0, side * (radius + 40.0));
            let bow = arc((0.0, 0.0), radius, -0.5 * PI, PI);
            let (cos, sin) = (turn.cos(), turn.sin());
            let turned = |p: Point| Point::new(240.0 + cos * p.x - sin * p.y, 180.0 + sin * p.x + cos * p.y);
            let line: Vec<Point> = [leg(-1.0)].into_iter().chain(bow).chain([leg(1.0)]).map(turned).collect();
            let mut canvas = Canvas::new(WIDTH, HEIGHT);
            canvas.pen(&line, pen);
            let found = strokes(&canvas);
            let drawn: Vec<_> = found.iter().map(|s| s.path.flatten(0.02)).collect();
            let comparison = compare_polylines(&drawn, &[line], 1.5).unwrap();
            let which = format!("a bow of {radius} px turned by {turn} rad: {comparison:?}");
            assert!(found.len() == 1 && comparison.max < 1.5 && comparison.coverage > 0.99, "{which}");
        }
    }
}

#[test]
fn lines_that_cross_at_a_few_degrees_are_two() {
    for degrees in [5.0, 6.0, 9.0, 14.0_f64] {
        let lines = [0.5, -0.5].map(|side| bar((240.0, 180.0), 380.0, 0.1 + side * degrees.to_radians()));
        each_is_drawn(&lines, 4.0, 2.0, &format!("{degrees}°"));
    }
}

#[test]
fn curves_that_touch_bend_on() {
    for overlap in [0.0, 0.5, 1.0] {
        let lines = [
            arc((240.0, 180.0 - 120.0), 120.0 + 0.5 * overlap, 0.25 * PI, 0.5 * PI),
            arc((240.0, 180.0 + 120.0), 120.0 + 0.5 * overlap, -0.75 * PI, 0.5 * PI),
        ];
        each_is_drawn(&lines, 4.0, 2.0, &format!("they overlap by {overlap} px"));
    }
}

#[test]
fn small_crescents_are_shapes() {
    let mut canvas = Canvas::new(WIDTH, HEIGHT);
    let ring = arc((240.0, 180.0), 150.0, 0.0, TAU);
    canvas.pen(&ring, 5.0);
    let crescent = |middle: (f64, f64), size: f64| -> Vec<Point> {
        let half = 0.5 * size;
        let outer =
            (0..=40).map(|k| f64::from(k) / 20.0 - 1.0).map(|u| (half * u, -0.36 * size * (1.0 - u * u)));
        let inner =
            (0..=40).map(|k| 1.0 - f64::from(k) / 20.0).map(|u| (half * u, -0.14 * size * (1.0 - u * u)));
        outer.chain(inner).map(|(x, y)| Point::new(middle.0 + x, middle.1 + y)).collect()
    };
    let shapes = [((180.0, 140.0), 42.0), ((300.0, 140.0), 42.0), ((240.0, 250.0), 56.0)]
        .map(|(middle, size)| crescent(middle, size));
    canvas.fill(&shapes);
    let found = strokes(&canvas);
    let outlines: Vec<_> =
        found.iter().filter(|s| s.kind == StrokeKind::Outline).map(|s| s.path.flatten(0.02)).collect();
    assert_eq!((found.len(), outlines.len()), (4, 3));
    let comparison = compare_polylines(&outlines, &shapes, 1.5).unwrap();
    assert!(comparison.coverage > 0.98 && comparison.precision > 0.99, "{comparison:?}");
}

/// Drops and ovals beside a pen's ring are shapes, and a dash of the pen is a line.
#[test]
fn small_drops_and_ovals_are_shapes() {
    let around = |half: (f64, f64), narrow: f64, middle: (f64, f64), turn: f64| -> Vec<Point> {
        let (cos, sin) = (turn.cos(), turn.sin());
        let at = |k: usize| TAU * k as f64 / 80.0;
        let by = |t: f64| (half.0 * t.cos(), half.1 * t.sin() * (1.0 - narrow * 0.5 * (1.0 + t.cos())));
        let turned =
            |(x, y): (f64, f64)| Point::new(middle.0 + x * cos - y * sin, middle.1 + x * sin + y * cos);
        (0..80).map(|k| turned(by(at(k)))).collect()
    };
    for size in [1.0, 1.5] {
        let mut canvas = Canvas::new(WIDTH, HEIGHT);
        canvas.pen(&arc((240.0, 180.0), 150.0, 0.0, TAU), 4.0);
        let shapes = [
            around((15.0 * size, 8.0 * size), 0.9, (180.0, 130.0), 0.4),
            around((15.0 * size, 8.0 * size), 0.9, (300.0, 130.0), 2.2),
            around((16.0 * size, 5.5 * size), 0.0, (180.0, 230.0), 1.0),
        ];
        canvas.fill(&shapes);
        canvas.pen(&bar((300.0, 230.0), 18.0, 0.5), 4.5);
        let found = strokes(&canvas);
        let outlines: Vec<_> =
            found.iter().filter(|s| s.kind == StrokeKind::Outline).map(|s| s.path.flatten(0.02)).collect();
        assert_eq!((found.len(), outlines.len()), (5, 3), "{size}");
        let comparison = compare_polylines(&outlines, &shapes, 1.5).unwrap();
        assert!(comparison.coverage > 0.97 && comparison.precision > 0.98, "{size} {comparison:?}");
    }
}

/// A cross of a thin pen beside a thick one's ring, far from it, is no dust; a speck of grit is.
#[test]
fn a_thin_mark_beside_a_thick_pen_stays() {
    let mut canvas = Canvas::new(WIDTH, HEIGHT);
    canvas.pen(&arc((130.0, 180.0), 80.0, 0.0, TAU), 9.0);
    [0.3, 0.3 + 0.5 * PI].iter().for_each(|&turn| canvas.pen(&bar((380.0, 120.0), 10.0, turn), 1.6));
    let grit = Point::new(400.3, 280.2);
    canvas.pen(&[grit, grit], 2.4);
    assert_eq!(strokes(&canvas).len(), 3);
}
