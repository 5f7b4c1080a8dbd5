//! The example pictures, traced and compared with the truth they were drawn from.

#![allow(clippy::print_stdout, reason = "the figures are worth seeing when a bound is missed")]

use std::path::{Path, PathBuf};

use serde_json::Value;
use tracelight_image::Grey;
use tracelight_stroke::{Comparison, Point, StrokeKind, compare_polylines};
use tracelight_vision::{Options, Traced, trace};

fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples")
}

/// A picture's brightness, as the host makes it of colours (ITU-R BT.709).
fn picture(name: &str) -> Grey {
    let image = image::open(examples().join(name).with_extension("png")).unwrap().to_luma8();
    Grey::new(image.width() as usize, image.height() as usize, image.into_raw()).unwrap()
}

fn truth(name: &str) -> Vec<Vec<Point>> {
    let text = std::fs::read_to_string(examples().join("truth").join(name).with_extension("json")).unwrap();
    let json: Value = serde_json::from_str(&text).unwrap();
    let number = |v: &Value| v.as_f64().unwrap();
    let point = |v: &Value| Point::new(number(&v[0]), number(&v[1]));
    let stroke = |v: &Value| v["points"].as_array().unwrap().iter().map(point).collect();
    json["strokes"].as_array().unwrap().iter().map(stroke).collect()
}

fn lines(traced: &Traced) -> Vec<Vec<Point>> {
    traced.strokes.strokes.iter().map(|s| s.path.flatten(0.01)).collect()
}

/// Breaks of direction too small for a corner and too large to pass unnoticed, degrees.
fn kinks(traced: &Traced) -> Vec<f64> {
    let of = |stroke: &tracelight_stroke::Stroke| {
        let pieces: Vec<_> = stroke.path.pieces().collect();
        let next = pieces.iter().skip(1).chain(pieces.first().filter(|_| stroke.path.is_closed()));
        let turn = |(a, b): (&tracelight_stroke::Piece, &tracelight_stroke::Piece)| {
            let (a, b) = (a.end_tangent(), b.start_tangent());
            a.cross(b).atan2(a.dot(b)).abs().to_degrees()
        };
        pieces.iter().zip(next).map(turn).filter(|t| (0.5..20.0).contains(t)).collect::<Vec<f64>>()
    };
    traced.strokes.strokes.iter().flat_map(of).collect()
}

fn check(name: &str, strokes: usize) {
    let traced = trace(&picture(name), &Options::default()).unwrap();
    let Comparison { rms, max, coverage, precision, length_ratio, .. } =
        compare_polylines(&lines(&traced), &truth(name), 2.0).unwrap();
    let found = traced.strokes.strokes.len();
    let elements: usize = traced.strokes.strokes.iter().map(|s| s.path.elements().len()).sum();
    println!(
        "{name}: {found} strokes, {elements} elements, rms {rms:.3} px, max {max:.2} px, coverage {:.2} %, precision \
         {:.2} %, length {length_ratio:.4}",
        100.0 * coverage,
        100.0 * precision
    );
    assert!(rms <= 0.4, "{name}: rms {rms} px");
    assert!(coverage >= 0.995 && precision >= 0.995, "{name}: coverage {coverage}, precision {precision}");
    assert!((0.98..=1.03).contains(&length_ratio), "{name}: length {length_ratio}");
    assert_eq!(found, strokes, "{name}: strokes");
    assert!(kinks(&traced).is_empty(), "{name}: kinks of {:?}°", kinks(&traced));
}

/// The picture as a webcam under a lamp sees it: light falling to 35 % across it, blurred by 0.9 px, noise of σ 6
/// levels and 0.06 % specks. Light first, noise last.
fn through_a_webcam(picture: &Grey) -> Grey {
    let (w, h) = (picture.width(), picture.height());
    let level = |x: usize, y: usize| f64::from(picture.levels()[y.min(h - 1) * w + x.min(w - 1)]);
    let kernel = [(0, 0.06), (1, 0.24), (2, 0.4), (3, 0.24), (4, 0.06)];
    let mut state = 7u64;
    let mut draw = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut pixel = |i: usize| {
        let at = |dx: usize, dy: usize| level((i % w + dx).saturating_sub(2), (i / w + dy).saturating_sub(2));
        let across = |dy: usize| kernel.iter().map(|&(dx, share)| share * at(dx, dy)).sum::<f64>();
        let blurred: f64 = kernel.iter().map(|&(dy, share)| share * across(dy)).sum();
        // twelve uniform draws add up to a normal one of variance 1
        let noise = (0..12).map(|_| draw()).sum::<f64>() - 6.0;
        let seen = blurred * (1.0 - 0.65 * (i % w) as f64 / w as f64) + 6.0 * noise;
        match draw() {
            speck if speck < 3e-4 => 0,
            speck if speck < 6e-4 => 255,
            _ => seen as u8,
        }
    };
    Grey::new(w, h, (0..w * h).map(&mut pixel).collect()).unwrap()
}

#[test]
fn bad_light_and_noise_cost_little() {
    for name in ["star", "shapes", "house", "silhouette", "handwriting", "chalk"] {
        let traced = trace(&through_a_webcam(&picture(name)), &Options::default()).unwrap();
        let clean = trace(&picture(name), &Options::default()).unwrap();
        let found = compare_polylines(&lines(&traced), &truth(name), 2.0).unwrap();
        let (strokes, drawn) = (traced.strokes.strokes.len(), clean.strokes.strokes.len());
        println!(
            "{name}: {strokes} strokes, rms {:.3} px, coverage {:.2} %, precision {:.2} %, length {:.3}",
            found.rms,
            100.0 * found.coverage,
            100.0 * found.precision,
            found.length_ratio
        );
        assert!(strokes.abs_diff(drawn) <= 1, "{name}: {strokes} strokes instead of {drawn}");
        assert!(found.rms < 0.35 && found.coverage > 0.98 && found.precision > 0.99, "{name}: {found:?}");
    }
}

#[test]
fn a_star_is_one_stroke() {
    check("star", 1);
}

#[test]
fn a_circle_a_square_and_a_triangle_are_three_strokes() {
    check("shapes", 3);
}

#[test]
fn a_house_has_the_strokes_a_hand_would_draw() {
    // two fewer than were drawn: each door post runs on into its side of the footpath
    check("house", 28);
}

#[test]
fn a_silhouette_is_its_outline_with_its_hole() {
    check("silhouette", 2);
    let traced = trace(&picture("silhouette"), &Options::default()).unwrap();
    assert!(traced.strokes.strokes.iter().all(|s| s.kind == StrokeKind::Outline));
}

#[test]
fn handwriting_runs_through_its_crossings() {
    check("handwriting", 3);
}

#[test]
fn chalk_on_a_board_is_traced_like_ink() {
    check("chalk", 9);
}
