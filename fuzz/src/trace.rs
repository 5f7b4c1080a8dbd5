//! The tracer: any image, any mode.

use std::f64::consts::FRAC_PI_2;

use tracelight_stroke::Point;
use tracelight_image::Grey;
use tracelight_vision::{Mode, Options, Traced, find_two_marks, trace};
use tracelight_markers::{TAG_COUNT, find_tags};

use crate::bytes::Bytes;
use crate::sound::check_path;

/// Smallest and largest side of an image, px.
const SIDES: [usize; 2] = [8, 128];

const MODES: [Mode; 4] = [Mode::Auto, Mode::Centreline, Mode::Outline, Mode::Sweep];
const TOLERANCES_PX: [f64; 8] = [0.35, 0.35, 0.35, 0.05, 0.08, 0.1, 2.0, 10.0];
const CORNERS_RAD: [f64; 6] = [0.436, 0.436, 0.09, 0.2, 1.5, FRAC_PI_2];

/// Layout: width, height, mode, tolerance, corner, style, then what the style makes an image of.
///
/// # Panics
/// When a stroke is nowhere, outside the image or not what it says, or a second run finds another.
pub fn check(data: &[u8]) {
    let mut bytes = Bytes::of(data);
    let [width, height] = [bytes.byte(), bytes.byte()].map(side);
    let options = Options {
        mode: bytes.one_of(&MODES),
        tolerance_px: bytes.one_of(&TOLERANCES_PX),
        corner_rad: bytes.one_of(&CORNERS_RAD),
        ..Options::default()
    };
    let style = bytes.byte();
    let options = Options { sheets: style >= 128, ..options };
    let levels = match style % 3 {
        0 => raw(bytes.rest(), width * height),
        1 => bits(bytes.rest(), width * height),
        _ => pens(bytes, width, height),
    };
    let Ok(image) = Grey::new(width, height, levels) else { return };
    let _ = find_two_marks(&image);
    check_tags(&image);
    let found = trace(&image, &options);
    if let Ok(traced) = &found {
        check_traced(traced, width, height);
    }
    // every run is slow under a sanitizer: one in eight is repeated
    if data.len().is_multiple_of(8) {
        assert_eq!(found, trace(&image, &options), "a second run differs");
    }
}

/// Markers are found where they are in sight, and nowhere else.
fn check_tags(image: &Grey) {
    for tag in find_tags(image) {
        assert!(tag.id < TAG_COUNT, "id {}", tag.id);
        assert!(tag.corners.iter().all(|corner| corner.x.is_finite() && corner.y.is_finite()), "{:?}", tag.corners);
        assert!(tag.deviation_px > 0.0 && tag.deviation_px.is_finite(), "{}", tag.deviation_px);
    }
}

fn side(byte: u8) -> usize {
    SIDES[0] + usize::from(byte) % (SIDES[1] - SIDES[0] + 1)
}

fn check_traced(traced: &Traced, width: usize, height: usize) {
    let strokes = &traced.strokes.strokes;
    assert!(!strokes.is_empty(), "no stroke is an error");
    assert_eq!((traced.width_px, traced.height_px), (width, height));
    assert!((0.0..=1.0).contains(&traced.missed_ink), "{} of the ink is missed", traced.missed_ink);
    for stroke in strokes {
        check_path(&stroke.path);
        assert!(stroke.pen.is_none_or(|w| w > 0.0 && w.is_finite()), "a pen of {:?}", stroke.pen);
        let length = stroke.path.length(1e-3);
        assert!(length > 0.0 && length.is_finite(), "a stroke of length {length}");
        for p in stroke.path.flatten(0.1) {
            assert!(is_inside(p, width, height), "a point at {p:?}, image {width} × {height}");
        }
    }
}

/// How far outside the image a stroke may reach, px: rounding.
const OUTSIDE_PX: f64 = 1e-9;

fn is_inside(p: Point, width: usize, height: usize) -> bool {
    let within = |v: f64, side: usize| (-OUTSIDE_PX..=side as f64 + OUTSIDE_PX).contains(&v);
    within(p.x, width) && within(p.y, height)
}

/// Level by level; a short row is repeated, which makes a texture.
fn raw(levels: &[u8], count: usize) -> Vec<u8> {
    match levels.is_empty() {
        true => vec![255; count],
        false => levels.iter().copied().cycle().take(count).collect(),
    }
}

/// Ink or paper, eight pixels to a byte.
fn bits(bytes: &[u8], count: usize) -> Vec<u8> {
    let levels = bytes.iter().flat_map(|b| (0..8).map(move |i| if b >> i & 1 == 1 { 20 } else { 235 }));
    raw(&levels.take(count).collect::<Vec<_>>(), count)
}

/// Lines of a round pen on even paper: where from, where to, half the width and how dark.
fn pens(mut bytes: Bytes<'_>, width: usize, height: usize) -> Vec<u8> {
    const MOST_LINES: usize = 40;
    let mut levels = vec![bytes.byte(); width * height];
    for _ in 0..MOST_LINES {
        if bytes.is_empty() {
            break;
        }
        let [x0, y0, x1, y1, pen, level] = bytes.take();
        let at = |x: u8, y: u8| {
            Point::new(f64::from(x) / 256.0 * width as f64, f64::from(y) / 256.0 * height as f64)
        };
        let line = (at(x0, y0), at(x1, y1));
        draw(&mut levels, width, line, 0.5 + f64::from(pen % 48) / 8.0, level);
    }
    levels
}

fn draw(levels: &mut [u8], width: usize, (a, b): (Point, Point), radius: f64, ink: u8) {
    for (i, level) in levels.iter_mut().enumerate() {
        let p = Point::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
        let along = b - a;
        let share = ((p - a).dot(along) / along.hypot2().max(1e-9)).clamp(0.0, 1.0);
        let cover = (radius + 0.5 - p.distance(a + along * share)).clamp(0.0, 1.0);
        *level = (f64::from(*level) * (1.0 - cover) + f64::from(ink) * cover) as u8;
    }
}
