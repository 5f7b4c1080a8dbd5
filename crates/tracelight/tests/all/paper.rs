//! A sheet of paper that was photographed at a slant on a table: what is on it, to scale.

use std::path::{Path, PathBuf};

use image::{GrayImage, Luma};
use serde_json::Value;

use crate::support::{folder, run};

const WIDTH: u32 = 1000;
const HEIGHT: u32 = 1000;
/// The pinhole's distance from the picture, px, and from the middle of the sheet, m.
const FOCAL: f64 = 800.0;
const AWAY: f64 = 0.45;

/// Where a pixel's ray meets the sheet, whose middle the camera looks at from 30° below: m, x right, y up.
fn on_sheet(x: f64, y: f64) -> (f64, f64) {
    let (sine, cosine) = 30_f64.to_radians().sin_cos();
    let ray = ((x - 500.0) / FOCAL, (500.0 - y) / FOCAL);
    // the sheet's own up is (cos, sin) in the camera's up and onward
    let along = AWAY / (1.0 - ray.1 * sine / cosine);
    (ray.0 * along, ray.1 * along / cosine)
}

/// An A4 sheet with a ring of 60 mm radius, drawn by a pen so wide, m, on a dark table.
pub(crate) fn photograph(name: &str, pen: f64) -> PathBuf {
    let path = folder(name).join("photo.png");
    let level = |x: u32, y: u32| {
        // the mean of nine places in the pixel
        let places = (0..9).map(|k| {
            (f64::from(x) + (f64::from(k % 3) + 0.5) / 3.0, f64::from(y) + (f64::from(k / 3) + 0.5) / 3.0)
        });
        let levels = places.map(|(x, y)| match on_sheet(x, y) {
            (u, v) if (u.hypot(v) - 0.06).abs() < 0.5 * pen => 40.0,
            (u, v) if u.abs() < 0.105 && v.abs() < 0.1485 => 220.0,
            _ => 70.0,
        });
        Luma([(levels.sum::<f64>() / 9.0) as u8])
    };
    GrayImage::from_fn(WIDTH, HEIGHT, level).save(&path).unwrap();
    path
}

fn text(path: &Path) -> String {
    path.to_str().unwrap().to_owned()
}

/// The extents of the drawing that a picture becomes, m.
fn extents(picture: &Path, flags: &[&str]) -> (f64, f64) {
    let csv = picture.with_extension("csv");
    let output = run(&[&["strokes", &text(picture), "-o", &text(&csv)], flags].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let (mut low, mut high) = ((f64::MAX, f64::MAX), (f64::MIN, f64::MIN));
    for row in std::fs::read_to_string(&csv).unwrap().lines().skip(1) {
        let numbers: Vec<f64> = row.split(',').skip(1).map(|cell| cell.parse().unwrap()).collect();
        low = (low.0.min(numbers[0]), low.1.min(numbers[1]));
        high = (high.0.max(numbers[0]), high.1.max(numbers[1]));
    }
    (high.0 - low.0, high.1 - low.1)
}

#[test]
fn a_sheet_of_known_size_gives_its_drawing_to_scale() {
    let picture = photograph("paper_scale", 1.6e-3);
    let (width, height) = extents(&picture, &["--paper", "a4"]);
    for side in [width, height] {
        assert!((side - 0.12).abs() < 4e-4, "{width} × {height} m");
    }
    // without its size the proportions are those the corners tell
    let (width, height) = extents(&picture, &["--width", "210mm"]);
    assert!((width - 0.12).abs() < 4e-4 && (height / width - 1.0).abs() < 0.03, "{width} × {height} m");
    // as it is, the ring is wider than high
    let (width, height) = extents(&picture, &["--straighten", "off"]);
    assert!(width > 1.1 * height, "{width} × {height} m");
}

#[test]
fn strokes_in_pixels_stay_where_they_are_in_the_picture() {
    let picture = photograph("paper_pixels", 1.6e-3);
    let output = run(&["strokes", &text(&picture), "--json"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("only the sheet of paper is traced"));
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((found["width_px"].as_f64(), found["height_px"].as_f64()), (Some(1000.0), Some(1000.0)));
    let strokes = found["strokes"].as_array().unwrap();
    assert_eq!(strokes.len(), 1);
    for point in strokes[0]["points"].as_array().unwrap() {
        let (u, v) = on_sheet(point[0].as_f64().unwrap(), point[1].as_f64().unwrap());
        assert!((u.hypot(v) - 0.06).abs() < 4e-4, "{point}");
    }
    let sheet = &found["sheet"];
    assert_eq!(sheet["laid_square"], true);
    let corner = &sheet["corners"][0];
    let (u, v) = on_sheet(corner[0].as_f64().unwrap(), corner[1].as_f64().unwrap());
    assert!((u + 0.105).abs() < 8e-4 && (v - 0.1485).abs() < 8e-4, "{u}, {v}");
    // all of the picture: the sheet's edge is a line of it
    let whole = run(&["strokes", &text(&picture), "--whole", "--json"]);
    let whole: Value = serde_json::from_slice(&whole.stdout).unwrap();
    assert!(whole["sheet"].is_null() && whole["strokes"].as_array().unwrap().len() > 1);
}

#[test]
fn a_photograph_on_a_simulated_wall_is_held_against_what_hangs_there() {
    let picture = photograph("paper_hung", 5e-3);
    let source = format!("sim:{}", text(&picture));
    let out = picture.with_file_name("run");
    let output = run(&["trace", "--camera", &source, "--out", &text(&out), "--json"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
    let figure = &summary["camera"]["figure_mm"];
    assert!(figure["rms"].as_f64().is_some_and(|rms| rms < 0.5), "{figure}");
    assert!(figure["covered_share"].as_f64().is_some_and(|share| share > 0.95), "{figure}");
}

#[test]
fn corners_and_papers_that_do_not_fit_are_refused_with_what_would() {
    let picture = text(&photograph("paper_refused", 1.6e-3));
    let refused = |flags: &[&str], status: i32, wanted: &str| {
        let output = run(&[&["strokes", &picture], flags].concat());
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(status), "{flags:?}: {said}");
        assert!(said.contains(wanted), "{flags:?}: {said}");
    };
    refused(&["--straighten", "10,10 20,20"], 2, "4 numbers are not four corners");
    refused(&["--straighten", "1,1 9,1 9,9 1,9"], 2, "picture of 1000 × 1000 px");
    refused(&["--straighten", "100,100 900,100 900,900 100,900", "--whole"], 2, "give one");
    refused(&["--whole", "--paper", "a4"], 1, "--straighten \"X,Y X,Y X,Y X,Y\"");
}
