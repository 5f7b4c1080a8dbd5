//! A line goes on where it is too pale for the threshold; paper, another line beyond it and a shadow's edge are no line.

use tracelight_image::Grey;
use tracelight_stroke::Point;
use tracelight_vision::{Options, Traced, trace};

use crate::raster::Canvas;

const WIDTH: usize = 640;
const HEIGHT: usize = 480;

/// Noise of two levels' deviation, the same in every run.
fn noise(k: usize) -> f64 {
    let word = (k as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let word = (word ^ (word >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let byte = |shift: u32| ((word >> shift) & 0xFF) as f64 / 255.0 - 0.5;
    2.4 * (byte(8) + byte(24) + byte(40) + byte(52))
}

/// What is found of lines by a pen of 6 px on paper of level 235, each so many levels darker than it.
fn traced(lines: &[(f64, Vec<Point>)], light: impl Fn(usize, usize) -> f64) -> Traced {
    let mut levels = vec![235.0; WIDTH * HEIGHT];
    for (dark, line) in lines {
        let mut canvas = Canvas::new(WIDTH, HEIGHT);
        canvas.pen(line, 6.0);
        levels
            .iter_mut()
            .zip(canvas.shares())
            .for_each(|(level, share)| *level = f64::min(*level, 235.0 - dark * share));
    }
    let seen = levels.iter().enumerate().map(|(k, level)| level * light(k % WIDTH, k / WIDTH) + noise(k));
    let image = Grey::new(WIDTH, HEIGHT, seen.map(|level| level as u8).collect()).unwrap();
    trace(&image, &Options::default()).unwrap()
}

/// A bow from one column to another.
fn bow(from: u32, to: u32) -> Vec<Point> {
    (from..=to).map(|x| Point::new(f64::from(x), 200.0 + 60.0 * (f64::from(x) / 150.0).sin())).collect()
}

fn even(_: usize, _: usize) -> f64 {
    1.0
}

#[test]
fn a_line_that_pales_is_one_line_and_with_paper_between_it_is_two() {
    let with = |pale: f64| {
        traced(&[(170.0, bow(60, 220)), (pale, bow(220, 300)), (170.0, bow(300, 560))], even).strokes.strokes
    };
    for pale in [16.0, 24.0, 40.0] {
        let strokes = with(pale);
        assert_eq!(strokes.len(), 1, "{pale} levels");
        let on_line = |p: &Point| (p.y - 200.0 - 60.0 * (p.x / 150.0).sin()).abs() < 2.0;
        assert!(strokes[0].path.flatten(0.1).iter().all(on_line), "{pale} levels: off the line");
    }
    assert_eq!(with(0.0).len(), 2);
}

#[test]
fn a_corner_is_one_though_its_sides_pale_to_just_the_threshold() {
    let (corner, ends) = (Point::new(200.0, 400.0), [Point::new(120.0, 60.0), Point::new(420.0, 80.0)]);
    for palest in (50..130).step_by(5).map(f64::from) {
        // so many levels at the corner, and 220 at the ends, in steps
        let step = |end: Point, k: u32| {
            let at = |k: u32| corner.lerp(end, f64::from(k) / 40.0);
            (palest + (220.0 - palest) * f64::from(k) / 40.0, vec![at(k), at(k + 1)])
        };
        let lines: Vec<_> = ends.iter().flat_map(|&end| (0..40).map(move |k| step(end, k))).collect();
        let strokes = traced(&lines, even).strokes.strokes;
        assert_eq!(strokes.len(), 1, "{palest} levels");
        let near = |p: Point| strokes[0].path.flatten(0.1).iter().any(|q| q.distance(p) < 2.0);
        assert!(near(corner) && ends.iter().all(|&end| near(end)), "{palest} levels: not all of it");
    }
}

#[test]
fn a_tail_is_followed_as_far_as_it_is_seen() {
    let found = traced(&[(170.0, bow(60, 300)), (22.0, bow(300, 420))], even);
    let path = &found.strokes.strokes[0].path;
    assert_eq!(found.strokes.strokes.len(), 1);
    let end = path.start().x.max(path.end().x);
    assert!((405.0..425.0).contains(&end), "it ends at {end}");
}

#[test]
fn an_end_before_another_line_and_one_on_a_shadows_edge_stay_ends() {
    let bar = vec![Point::new(330.0, 80.0), Point::new(330.0, 400.0)];
    let level = vec![Point::new(60.0, 240.0), Point::new(300.0, 240.0)];
    let found = traced(&[(170.0, level.clone()), (170.0, bar)], even);
    assert_eq!(found.strokes.strokes.len(), 2);
    // the line ends in the middle of the picture, where the shadow's edge begins to go on as it did
    let shadow = |x: usize, y: usize| if x > 300 && y > 240 { 0.6 } else { 1.0 };
    let found = traced(&[(170.0, level)], shadow);
    let reach = found.strokes.strokes.iter().flat_map(|s| s.path.flatten(0.1)).map(|p| p.x);
    let reach = reach.fold(0.0, f64::max);
    assert!(reach < 312.0, "light along the shadow's edge up to {reach}");
}
