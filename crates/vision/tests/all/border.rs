//! Lines along the picture's own border are lines: the middle of what is seen of them is drawn.

use tracelight_image::Grey;
use tracelight_vision::{Options, trace};

/// A picture of 420 × 320 px by what is ink.
fn picture(is_ink: impl Fn(usize, usize) -> bool) -> Grey {
    let level = |i: usize| if is_ink(i % 420, i / 420) { 0 } else { 255 };
    Grey::new(420, 320, (0..420 * 320).map(level).collect()).unwrap()
}

#[test]
fn a_frame_along_the_border_is_one_closed_line() {
    let frame = |x: usize, y: usize| x.min(419 - x).min(y.min(319 - y)) < 3;
    let ring = |x: usize, y: usize| ((x as f64 - 200.0).hypot(y as f64 - 160.0) - 90.0).abs() < 1.5;
    let found = trace(&picture(|x, y| frame(x, y) || ring(x, y)), &Options::default()).unwrap();
    assert!(!found.quality.light_on_dark);
    assert_eq!(found.strokes.strokes.len(), 2);
    assert!(found.strokes.strokes.iter().all(|stroke| stroke.path.is_closed()));
    let points = found.strokes.strokes.iter().flat_map(|stroke| stroke.path.flatten(0.05));
    let outer = points.fold((400.0_f64, 300.0_f64, 0.0_f64, 0.0_f64), |(left, top, right, bottom), p| {
        (left.min(p.x), top.min(p.y), right.max(p.x), bottom.max(p.y))
    });
    for (side, middle) in [(outer.0, 1.5), (outer.1, 1.5), (outer.2, 418.5), (outer.3, 318.5)] {
        assert!((side - middle).abs() < 0.35, "{side}, not {middle}");
    }
}

#[test]
fn a_frame_anywhere_within_the_border_is_no_dark_picture() {
    for inside in 0..28 {
        for wide in [3, 6] {
            let frame =
                |x: usize, y: usize| (inside..inside + wide).contains(&x.min(419 - x).min(y.min(319 - y)));
            let ring = |x: usize, y: usize| ((x as f64 - 200.0).hypot(y as f64 - 160.0) - 90.0).abs() < 2.5;
            let found = trace(&picture(|x, y| frame(x, y) || ring(x, y)), &Options::default()).unwrap();
            let closed = found.strokes.strokes.iter().filter(|stroke| stroke.path.is_closed()).count();
            assert_eq!((found.strokes.strokes.len(), closed), (2, 2), "{wide} px, {inside} px inside");
        }
    }
}

#[test]
fn three_lines_along_the_border_are_no_dark_picture() {
    let lines = |x: usize, y: usize| (y < 3 || !(3..=416).contains(&x)) && y < 300;
    let found = trace(&picture(lines), &Options::default()).unwrap();
    assert!(!found.quality.light_on_dark);
    assert_eq!(found.strokes.strokes.len(), 1);
    assert!(!found.strokes.strokes[0].path.is_closed());
}

#[test]
fn a_frame_on_which_a_shadow_falls_is_no_sheet_of_paper() {
    for shadow in [(0.25, 260.0), (-0.1, 150.0), (1.2, 400.0), (6.0, 1700.0), (1.4, 330.0)] {
        let frame = |x: usize, y: usize| (4..8).contains(&x.min(419 - x).min(y.min(319 - y)));
        let ring = |x: usize, y: usize| ((x as f64 - 200.0).hypot(y as f64 - 160.0) - 90.0).abs() < 1.5;
        // a pixel's edges are soft, and so is the shadow's
        let lit = |x: f64, y: f64| {
            let off = (y + shadow.0 * x - shadow.1) / f64::hypot(1.0, shadow.0);
            0.58 + 0.42 * (0.5 - off / 3.0).clamp(0.0, 1.0)
        };
        let level = |i: usize| {
            let (x, y) = (i % 420, i / 420);
            let ink = if frame(x, y) || ring(x, y) { 0.12 } else { 1.0 };
            (238.0 * ink * lit(x as f64, y as f64)) as u8
        };
        let image = Grey::new(420, 320, (0..420 * 320).map(level).collect()).unwrap();
        let found = trace(&image, &Options::default()).unwrap();
        let closed = found.strokes.strokes.iter().filter(|stroke| stroke.path.is_closed()).count();
        assert_eq!((found.strokes.strokes.len(), closed), (2, 2), "{shadow:?}");
    }
}

#[test]
fn a_frame_round_a_small_picture_is_no_sheet_of_paper() {
    for size in [80, 96, 100] {
        let frame = |x: usize, y: usize| (2..5).contains(&x.min(size - 1 - x).min(y.min(size - 1 - y)));
        let middle = size as f64 / 2.0;
        let off = |x: usize, y: usize| (x as f64 - middle).hypot(y as f64 - middle);
        let level = |i: usize| {
            let (x, y) = (i % size, i / size);
            let ink = if frame(x, y) || (off(x, y) - 18.0).abs() < 1.5 { 0.15 } else { 1.0 };
            (235.0 * ink * (1.0 - 0.4 * x as f64 / size as f64)) as u8
        };
        let image = Grey::new(size, size, (0..size * size).map(level).collect()).unwrap();
        let found = trace(&image, &Options::default()).unwrap();
        assert_eq!(found.strokes.strokes.len(), 2, "{size}");
        assert!(found.strokes.strokes.iter().all(|stroke| stroke.path.is_closed()), "{size}");
    }
}

#[test]
fn strips_of_table_along_the_border_are_no_lines() {
    // left, top, right, bottom: px at the beginning and at the end of each
    let strips: [(&str, [(f64, f64); 4]); 4] = [
        ("half a pixel", [(0.0, 0.0), (0.0, 0.0), (0.0, 0.0), (0.5, 0.5)]),
        ("a hair's breadth on two sides", [(1.2, 0.9), (0.7, 0.7), (0.0, 0.0), (0.0, 0.0)]),
        ("a narrow wedge", [(0.0, 0.0), (0.0, 0.0), (1.4, 2.2), (0.0, 0.0)]),
        ("not as wide on one side as on the other", [(3.0, 3.0), (6.0, 6.0), (0.0, 0.0), (0.0, 0.0)]),
    ];
    for (name, widths) in strips {
        let covered = |(width, at): (f64, f64)| (width - at).clamp(0.0, 1.0);
        let level = |i: usize| {
            let (x, y) = ((i % 420) as f64, (i / 420) as f64);
            let width = |k: usize, share: f64| widths[k].0 + (widths[k].1 - widths[k].0) * share;
            let strip = [
                (width(0, y / 320.0), x),
                (width(1, x / 420.0), y),
                (width(2, y / 320.0), 419.0 - x),
                (width(3, x / 420.0), 319.0 - y),
            ];
            let table = strip.into_iter().map(covered).fold(0.0, f64::max);
            let ink = (2.0 - ((x - 200.0).hypot(y - 160.0) - 90.0).abs()).clamp(0.0, 1.0);
            (235.0 - 200.0 * ink + (40.0 - 235.0) * table * (1.0 - ink)) as u8
        };
        let image = Grey::new(420, 320, (0..420 * 320).map(level).collect()).unwrap();
        let found = trace(&image, &Options::default()).unwrap();
        assert_eq!(found.strokes.strokes.len(), 1, "{name}");
        assert!(found.strokes.strokes[0].path.is_closed(), "{name}");
    }
}
