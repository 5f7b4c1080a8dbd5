//! Lines of pens that are not even: that swell and taper.

use tracelight_image::Grey;
use tracelight_maths::planar;
use tracelight_stroke::{Comparison, Point, StrokeKind, compare_polylines};
use tracelight_vision::{Options, Traced, trace};

use crate::raster::Canvas;

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

/// A broad nib's ring: thin where its edge leads along, thick across it, and that within a quarter of the way round.
#[test]
fn a_nibs_ring_is_followed_all_round() {
    for (radius, nib, slant) in [(12.0, 5.0, 0.7), (12.0, 5.0, 2.1), (80.0, 30.0, 0.7), (110.0, 26.0, 1.4)] {
        let ring: Vec<Point> = (0..=360).map(|k| ring_at(f64::from(k).to_radians(), radius)).collect();
        let mut canvas = Canvas::new(600, 440);
        // along the ring the direction is a right angle further
        let width = |share: f64| {
            let along = std::f64::consts::TAU * share + std::f64::consts::FRAC_PI_2;
            (nib * (along - slant).sin().abs()).max(0.15 * nib)
        };
        swelling(&mut canvas, &ring, width);
        let (found, comparison) = traced(&canvas, 600, std::slice::from_ref(&ring));
        let only = found.strokes.strokes.len() == 1 && found.strokes.strokes[0].path.is_closed();
        assert!(only, "{radius} px, {slant}: {} strokes, {comparison:?}", found.strokes.strokes.len());
        let good = comparison.coverage > 0.99 && comparison.precision > 0.99 && comparison.rms < 0.5;
        assert!(good, "{radius} px, {slant}: {comparison:?}");
    }
}

/// A face's ring with two eyes, which are longer than wide and narrower than the pen, and with grit as large but paler.
#[test]
fn an_eye_narrower_than_the_pen_is_drawn_and_grit_is_not() {
    let (pen, width) = (14.0, 600);
    let ring: Vec<Point> =
        (0..=180).map(|k| f64::from(k).to_radians() * 2.0).map(|a| ring_at(a, 110.0)).collect();
    let eye = |x: f64| vec![Point::new(x, 190.0), Point::new(x, 200.0)];
    for narrow in [0.5, 0.55] {
        let mut canvas = Canvas::new(width, 440);
        canvas.pen(&ring, pen);
        [270.0, 330.0].into_iter().for_each(|x| canvas.pen(&eye(x), narrow * pen));
        let mut grit = Canvas::new(width, 440);
        [280.0, 310.0]
            .into_iter()
            .for_each(|x| grit.pen(&[Point::new(x, 260.0), Point::new(x, 270.0)], narrow * pen));
        let drawn = canvas.shares().zip(grit.shares());
        let levels: Vec<u8> = drawn.map(|(ink, grit)| (245.0 - 215.0 * ink - 130.0 * grit) as u8).collect();
        let found = trace(&Grey::new(width, 440, levels).unwrap(), &Options::default()).unwrap();
        assert_eq!(found.strokes.strokes.len(), 3, "eyes of {narrow} pens");
        assert_eq!(found.left_out.specks, 2, "eyes of {narrow} pens");
        let eyes = found.strokes.strokes.iter().filter(|s| !s.path.is_closed());
        eyes.for_each(|eye| {
            let end = eye.path.end();
            assert!((180.0..210.0).contains(&end.y), "an eye ends at {end}");
        });
    }
}

fn ring_at(angle: f64, radius: f64) -> Point {
    Point::new(300.0 + radius * angle.cos(), 220.0 + radius * angle.sin())
}

/// The ways of a pen to and fro in a disc of 80 px, so many pens from middle to middle, slanted.
fn scribbled(canvas: &mut Canvas, centre: Point, pen: f64, pitch_pens: f64, joined: bool) {
    let radius = 80.0_f64;
    let (way, aside) = (planar::direction(0.4), planar::direction(0.4).turn_90());
    let ways = (2.0 * radius / (pitch_pens * pen)) as i32 + 1;
    for k in 0..ways {
        let middle = -radius + (f64::from(k) + 0.5) * pitch_pens * pen;
        let across: Vec<f64> = (0..=24).map(|i| middle + pen * (f64::from(i) / 24.0 - 0.5)).collect();
        let edge =
            |v: f64, side: f64| centre + aside * v + way * (side * (radius * radius - v * v).max(0.0).sqrt());
        let there = across.iter().map(|&v| edge(v, 1.0));
        let back = across.iter().rev().map(|&v| edge(v, -1.0));
        canvas.fill(&[there.chain(back).collect()]);
        // where the hand turns it meets the last way
        if joined && k > 0 {
            let side = if k % 2 == 0 { 0.8 } else { -0.8 };
            canvas.pen(&[edge(middle - pitch_pens * pen, side), edge(middle, side)], 0.6 * pen);
        }
    }
}

#[test]
fn an_area_that_a_felt_pen_filled_is_one_shape_and_hatching_is_lines() {
    let pen = 12.0;
    let line = vec![Point::new(380.0, 60.0), Point::new(560.0, 380.0)];
    for pitch in [0.9, 1.1, 1.25] {
        let mut canvas = Canvas::new(600, 440);
        scribbled(&mut canvas, Point::new(190.0, 220.0), pen, pitch, true);
        canvas.pen(&line, pen);
        let (found, _) = traced(&canvas, 600, std::slice::from_ref(&line));
        let outlines = found.strokes.strokes.iter().filter(|s| s.kind == StrokeKind::Outline).count();
        assert_eq!((found.strokes.strokes.len(), outlines), (2, 1), "{pitch} pens apart");
    }
    // a single slit, with ink all round
    let mut canvas = Canvas::new(600, 440);
    let ring = |radius: f64| {
        (0..90)
            .map(|k| Point::new(190.0, 220.0) + planar::direction(f64::from(k) * 4_f64.to_radians()) * radius)
            .collect::<Vec<_>>()
    };
    let slit = [(150.0, 218.0), (230.0, 218.0), (230.0, 222.0), (150.0, 222.0)].map(Point::from).to_vec();
    canvas.fill(&[ring(80.0), slit]);
    canvas.pen(&line, pen);
    let (found, _) = traced(&canvas, 600, std::slice::from_ref(&line));
    assert_eq!(found.strokes.strokes.len(), 2, "a slit");
    for (pen, pitch) in [(6.0, 2.0), (9.0, 1.4)] {
        let mut canvas = Canvas::new(600, 440);
        scribbled(&mut canvas, Point::new(190.0, 220.0), pen, pitch, false);
        canvas.pen(&line, pen);
        let (found, _) = traced(&canvas, 600, std::slice::from_ref(&line));
        let lines = found.strokes.strokes.iter().filter(|s| s.kind == StrokeKind::Centreline).count();
        assert!(lines >= 12 && lines == found.strokes.strokes.len(), "{lines} lines, {pitch} pens apart");
    }
}

/// A disc of 80 px with slots of such widths and lengths beside each other; how many strokes it is.
fn slotted(slots: &[(f64, f64)]) -> usize {
    let mut canvas = Canvas::new(400, 400);
    let centre = Point::new(200.0, 200.0);
    let ring: Vec<Point> =
        (0..90).map(|k| centre + planar::direction(f64::from(k) * 4_f64.to_radians()) * 80.0).collect();
    let (way, aside) = (planar::direction(0.4), planar::direction(0.4).turn_90());
    let slot = |(k, &(wide, long)): (usize, &(f64, f64))| {
        let middle = centre + aside * (24.0 * (k as f64 - 0.5 * (slots.len() - 1) as f64));
        let corner = |(u, v): (f64, f64)| middle + way * (0.5 * long * u) + aside * (0.5 * wide * v);
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(corner).to_vec()
    };
    let slots = slots.iter().enumerate().map(slot);
    canvas.fill(&std::iter::once(ring.clone()).chain(slots).collect::<Vec<_>>());
    traced(&canvas, 400, &[ring]).0.strokes.strokes.len()
}

#[test]
fn slits_that_a_pen_left_are_filled_though_no_line_tells_of_the_pen_and_slots_stay() {
    assert_eq!(slotted(&[(4.0, 130.0)]), 1, "one slit");
    assert_eq!(slotted(&[(4.0, 110.0), (5.0, 130.0), (4.0, 25.0)]), 1, "three slits, one of them short");
    assert_eq!(slotted(&[(4.0, 60.0)]), 2, "a coin's slot");
    assert_eq!(slotted(&[(24.0, 130.0)]), 2, "a wide one");
    assert_eq!(slotted(&[(12.0, 110.0), (12.0, 110.0)]), 3, "bars");
}

/// How high the paper's grain is at a pixel, 0 to 1: as high over squares of so many pixels.
fn grain(seed: u64, size: u64, x: usize, y: usize) -> f64 {
    let mut word = seed ^ (((x as u64 / size) << 32) | (y as u64 / size));
    for _ in 0..3 {
        word = (word ^ (word >> 31)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    }
    (word >> 40) as f64 / f64::from(1 << 24)
}

#[test]
fn a_crayon_from_near_draws_lines_and_no_crumbs() {
    let (width, height, pen) = (1200, 900, 30.0);
    let truth: Vec<Vec<Point>> = vec![
        (0..=90)
            .map(|k| f64::from(4 * k).to_radians())
            .map(|a| Point::new(420.0, 450.0) + planar::direction(a) * 260.0)
            .collect(),
        vec![Point::new(420.0, 300.0), Point::new(1080.0, 620.0)],
        vec![Point::new(800.0, 120.0), Point::new(900.0, 250.0), Point::new(1100.0, 180.0)],
    ];
    for seed in 1..6 {
        // pressed less towards its edges: there the grain's heights alone are taken
        let presses: Vec<Vec<f64>> = [0.65, 0.8, 1.0]
            .map(|share| {
                let mut canvas = Canvas::new(width, height);
                truth.iter().for_each(|line| canvas.pen(line, share * pen));
                canvas.shares().collect()
            })
            .to_vec();
        let level = |i: usize| {
            let press = presses.iter().map(|shares| shares[i]).sum::<f64>() / 3.0;
            let taken = press > 0.9 * grain(seed, 3, i % width, i / width) && press > 0.0;
            if taken { 90 } else { 225 }
        };
        let levels = (0..width * height).map(level).collect();
        let found = trace(&Grey::new(width, height, levels).unwrap(), &Options::default()).unwrap();
        let drawn: Vec<_> = found.strokes.strokes.iter().map(|s| s.path.flatten(0.02)).collect();
        let comparison = compare_polylines(&drawn, &truth, 0.25 * pen).unwrap();
        assert_eq!(drawn.len(), truth.len(), "seed {seed}: {comparison:?}");
        assert!(comparison.coverage > 0.985 && comparison.rms < 1.0, "seed {seed}: {comparison:?}");
        assert!(found.quality.pen_px.is_some_and(|px| (px / pen - 1.0).abs() < 0.25), "{:?}", found.quality);
    }
}

#[test]
fn a_soft_pencil_on_rough_paper_draws_lines_and_no_crumbs() {
    let (width, height) = (640, 480);
    let truth: Vec<Vec<Point>> = vec![
        (0..=90)
            .map(|k| Point::new(200.0, 240.0) + planar::direction(f64::from(4 * k).to_radians()) * 130.0)
            .collect(),
        (0..=60)
            .map(|k| Point::new(380.0 + 3.5 * f64::from(k), 120.0 + 40.0 * (f64::from(k) / 12.0).sin()))
            .collect(),
        vec![Point::new(400.0, 400.0), Point::new(590.0, 260.0)],
    ];
    let mut strokes = 0;
    for seed in 1..9 {
        let mut canvas = Canvas::new(width, height);
        truth.iter().for_each(|line| canvas.pen(line, 4.0));
        let shares: Vec<f64> = canvas.shares().collect();
        let level = |i: usize| {
            // the grain's heights take most, its hollows a little
            let taken = shares[i] * (1.15 - grain(seed, 1, i % width, i / width)).clamp(0.0, 1.0);
            (235.0 - 130.0 * taken) as u8
        };
        let levels = (0..width * height).map(level).collect();
        let found = trace(&Grey::new(width, height, levels).unwrap(), &Options::default()).unwrap();
        let drawn: Vec<_> = found.strokes.strokes.iter().map(|s| s.path.flatten(0.02)).collect();
        let comparison = compare_polylines(&drawn, &truth, 2.0).unwrap();
        assert!(comparison.coverage > 0.985 && comparison.precision > 0.97, "seed {seed}: {comparison:?}");
        strokes += drawn.len();
    }
    assert!(strokes <= 8 * truth.len() + 3, "{strokes} strokes for {}", 8 * truth.len());
}
