//! What the program says of a picture, and what is set of its tracing by hand.

use std::path::{Path, PathBuf};

use image::{Rgba, RgbaImage};
use serde_json::Value;

use crate::support::{folder, run, trace};

const STAR: &str = "examples/star.png";

fn json(arguments: &[&str]) -> Value {
    let output = run(&[arguments, &["--json"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn text(path: &Path) -> String {
    path.to_str().unwrap().to_owned()
}

/// A line of one colour, 300 px long, over a dash of 30 px, on a clear sheet.
fn sheet(name: &str, ink: [u8; 4]) -> PathBuf {
    let path = folder(name).join("sheet.png");
    let drawn = |x: u32, y: u32| match y {
        100..104 => (50..350).contains(&x),
        180..184 => (50..80).contains(&x),
        _ => false,
    };
    let colour = |x, y| Rgba(if drawn(x, y) { ink } else { [0; 4] });
    RgbaImage::from_fn(400, 300, colour).save(&path).unwrap();
    path
}

#[test]
fn strokes_tell_the_picture_s_verdict() {
    let output = run(&["strokes", STAR]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.lines().nth(1).is_some_and(|line| line.starts_with("good: contrast")), "{said}");
    let quality = &json(&["strokes", STAR])["quality"];
    assert_eq!(quality["verdict"], "good");
    assert_eq!(quality["remarks"], Value::Array(vec![]));
    for name in [
        "ink_percent",
        "contrast_percent",
        "contrast_to_noise",
        "noise_levels",
        "light_evenness",
        "edge_px",
        "clipped_percent",
        "pen_px",
    ] {
        assert!(quality[name].is_number(), "{name}: {quality}");
    }
}

#[test]
fn summary_and_report_carry_the_verdict() {
    let dir = folder("quality-report");
    let summary = trace(&[STAR], &dir);
    assert_eq!(summary["quality"]["verdict"], "good");
    let report = std::fs::read_to_string(dir.join("report.html")).unwrap();
    assert!(report.contains("Quality of the picture") && report.contains("good: contrast"));
}

#[test]
fn light_ink_on_a_clear_sheet_is_traced_like_dark_ink() {
    for (name, ink) in [("ink-white", [255, 255, 255, 255]), ("ink-black", [0, 0, 0, 255])] {
        let strokes = json(&["strokes", &text(&sheet(name, ink))]);
        assert_eq!(strokes["strokes"].as_array().unwrap().len(), 2, "{name}");
    }
}

#[test]
fn short_strokes_are_dropped_in_pixels_and_in_true_lengths() {
    let sheet = text(&sheet("short", [0, 0, 0, 255]));
    let count =
        |flags: &[&str]| json(&[&["strokes", &sheet], flags].concat())["strokes"].as_array().unwrap().len();
    assert_eq!(count(&["--min-length", "20px"]), 2);
    assert_eq!(count(&["--min-length", "60px"]), 1);
    // 1 mm a pixel: the dash is some 26 mm
    assert_eq!(count(&["--min-length", "20mm", "--width", "400mm"]), 2);
    assert_eq!(count(&["--min-length", "60mm", "--width", "400mm"]), 1);
    let output = run(&["strokes", &sheet, "--min-length", "1000px"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("the longest stroke is"));
}

#[test]
fn flags_out_of_bounds_name_flag_value_and_bound() {
    for (flag, value, bound) in [
        ("--threshold", "120", "between 0.4 and 99.6"),
        ("--despeckle", "-3", "between 0 and"),
        ("--min-length", "12", "no unit"),
        ("--tolerance", "50px", "between 0.05 and 10 px"),
        ("--corner-angle", "120deg", "between 5 and 90 deg"),
    ] {
        for command in ["strokes", "trace", "plan"] {
            let output = run(&[command, STAR, flag, value]);
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            assert_eq!(output.status.code(), Some(2), "{command} {flag} {value}: {said}");
            assert!([flag, value, bound].iter().all(|part| said.contains(part)), "{said}");
        }
    }
}

#[test]
fn defaults_said_aloud_change_nothing() {
    let flags =
        ["--threshold", "auto", "--despeckle", "auto", "--min-length", "0px", "--tolerance", "0.35px"];
    let aloud = json(&[&["strokes", STAR, "--corner-angle", "25deg"], &flags[..]].concat());
    assert_eq!(aloud, json(&["strokes", STAR]));
}

#[test]
fn a_batch_is_traced_again_when_its_threshold_changes() {
    let dir = folder("quality-batch");
    let out = format!("{}/", dir.join("out").display());
    let said = |flags: &[&str]| {
        let arguments = [&["strokes", STAR, "examples/house.png", "-o", &out], flags].concat();
        String::from_utf8(run(&arguments).stdout).unwrap()
    };
    assert!(said(&[]).contains("good"));
    assert!(said(&[]).contains("0 traced, 2 kept"));
    assert!(said(&["--threshold", "40"]).contains("2 traced, 0 kept"));
}

#[test]
fn a_pictures_way_to_ink_can_be_looked_at() {
    let dir = folder("stages");
    let shown = dir.join("stages.svg");
    let path = shown.to_str().unwrap();
    let output = run(&["strokes", "examples/house.png", "--stages", path]);
    assert!(output.status.success());
    let svg = std::fs::read_to_string(&shown).unwrap();
    assert_eq!(svg.matches("<image ").count(), 3, "grey, evened out, ink");
    assert!(svg.contains("house.png: from grey to ink") && svg.contains("darkness; ink from "));
    let drawing = dir.join("line.svg").to_str().unwrap().to_owned();
    std::fs::write(
        &drawing,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9mm\" height=\"9mm\" viewBox=\"0 0 9 9\"><path d=\"M1 1L8 8\" stroke=\"#000\"/></svg>",
    )
    .unwrap();
    for (pictures, what) in [
        (&[drawing.as_str()][..], "has strokes already"),
        (&["examples/house.png", "examples/star.png"][..], "--stages is of one picture"),
    ] {
        let output = run(&[&["strokes", "--stages", path], pictures].concat());
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && said.contains(what), "{said}");
    }
}

#[test]
fn a_photograph_is_refused_and_traced_by_force() {
    // a dark tree before hills and a bright sky, which its twigs let through at its edge
    let path = folder("a_photograph").join("photograph.png");
    let level = |x: f64, y: f64| {
        let hill = 120.0 + 30.0 * (x / 40.0).sin() + 12.0 * (x / 13.0).cos();
        let inside = 45.0 + 6.0 * (x / 5.0).sin() * (y / 7.0).cos() - (x - 90.0).hypot(1.3 * (y - 90.0));
        let tree = (0.5 + inside / 24.0).clamp(0.0, 1.0);
        let behind = match y > hill {
            true => 150.0 - 0.5 * (y - hill) + 35.0 * (x / 17.0).sin() * (y / 9.0).cos(),
            false => 235.0 - 0.25 * y,
        };
        tree * (30.0 + 25.0 * (x / 9.0).sin() * (y / 11.0).sin()) + (1.0 - tree) * behind
    };
    let colour = |x: u32, y: u32| {
        let grey = level(f64::from(x), f64::from(y)) as u8;
        Rgba([grey, grey, grey, 255])
    };
    RgbaImage::from_fn(320, 240, colour).save(&path).unwrap();
    let name = text(&path);
    let refused = run(&["strokes", &name]);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(1), "{said}");
    assert!(said.contains("whose edges fade") && said.contains("--force"), "{said}");
    let strokes = json(&["strokes", &name, "--force"])["strokes"].as_array().map_or(0, Vec::len);
    assert!(strokes > 0);
}
