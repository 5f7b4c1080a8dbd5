//! A camera looks, the head is found from dots, the figure is traced where it is seen: in simulated rooms whose truth the program tells.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on may panic")]

mod support;

use std::process::Output;

use serde_json::Value;
use support::{folder, run};

const HOUSE: &str = concat!("sim:", env!("CARGO_MANIFEST_DIR"), "/../../examples/house.png");

fn json(output: &Output) -> Value {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn check_at_most(object: &Value, path: &str, most: f64) {
    let value = object.pointer(path).and_then(Value::as_f64);
    assert!(
        value.is_some_and(|value| (0.0..=most).contains(&value)),
        "{path}: {value:?}, at most {most}; {object}"
    );
}

#[test]
fn a_webcam_finds_the_head_and_the_figure_and_the_light_is_on_it() {
    let dir = folder("camera-webcam");
    let [out, camera] = ["out", "camera.toml"].map(|name| dir.join(name).to_str().unwrap().to_owned());
    // where it stood is made two millimetres another, as if somebody had moved it since
    json(&run(&["calibrate", "markers", "--camera", HOUSE, "--seed", "7", "-o", &camera, "--json"]));
    let file = std::fs::read_to_string(&camera).unwrap();
    let first = file.split_once("translation_m = [").unwrap().1.split_once(',').unwrap().0.trim();
    let moved = first.parse::<f64>().unwrap() + 0.002;
    std::fs::write(&camera, file.replace(first, &moved.to_string())).unwrap();
    let output =
        run(&["trace", "--camera", HOUSE, "--seed", "7", "--calibration", &camera, "--out", &out, "--json"]);
    let summary = json(&output);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("the camera moved 1.") || said.contains("the camera moved 2."), "{said}");
    check_at_most(&summary, "/camera/figure_mm/rms", 0.5);
    check_at_most(&summary, "/camera/figure_mm/p99", 1.5);
    check_at_most(&summary, "/camera/head/truth_rms_mm", 0.3);
    check_at_most(&summary, "/camera/head/truth_max_mm", 0.8);
    assert!(summary["camera"]["figure_mm"]["covered_share"].as_f64().unwrap() > 0.99, "{summary}");
    assert_eq!(summary["camera"]["markers"], 80);
    assert_eq!(summary["camera"]["head"]["dots"], 25);
    for file in ["report.html", "trace.png", "strokes.svg", "trace.csv", "run.mcap"] {
        assert!(dir.join("out").join(file).exists(), "{file}");
    }
}

#[test]
fn the_reports_camera_is_calibrated_first_and_a_known_head_draws_no_dots() {
    let dir = folder("camera-report");
    let [out, camera, head] =
        ["out", "camera.toml", "head.toml"].map(|name| dir.join(name).to_str().unwrap().to_owned());
    let report = ["--sim-camera", "report", "--seed", "3"];
    let with = |args: &[&'static str], more: &[&str]| {
        let all: Vec<String> = args.iter().chain(&report).chain(more).map(|s| (*s).to_owned()).collect();
        let all: Vec<&str> = all.iter().map(String::as_str).collect();
        run(&all)
    };
    let refused = with(&["trace", "--camera", HOUSE], &["--out", &out]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("calibrate markers"), "says what to do");
    json(&with(&["calibrate", "markers", "--camera", "sim", "--json"], &["-o", &camera]));
    let found = json(&with(
        &["calibrate", "head", "--camera", "sim", "--json"],
        &["--calibration", &camera, "-o", &head],
    ));
    check_at_most(&found, "/truth_mm/rms", 0.5);
    check_at_most(&found, "/truth_mm/max", 1.2);
    // its rows are read one after the other in 25 ms, and its stamps are right
    assert!((found["images"]["readout_s"].as_f64().unwrap() - 0.025).abs() < 2e-3, "{found}");
    assert!(found["images"]["late_s"].as_f64().unwrap().abs() < 2e-3, "{found}");
    let traced = json(&with(
        &["trace", "--camera", HOUSE, "--json"],
        &["--calibration", &camera, "--head", &head, "--out", &out],
    ));
    check_at_most(&traced, "/camera/figure_mm/rms", 1.2);
    check_at_most(&traced, "/camera/figure_mm/p99", 3.0);
    assert_eq!(traced["camera"]["head"], Value::Null);
    assert_eq!(traced["camera"]["markers"], 0);
    // the head of one rig is not another's
    let other = with(
        &["trace", "--camera", HOUSE, "--rig", "worn"],
        &["--calibration", &camera, "--head", &head, "--out", &out],
    );
    assert_eq!(other.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&other.stderr).contains("it is of the rig report, and this is worn"));
}

#[test]
fn a_source_that_is_no_camera_is_refused() {
    for args in [
        &["trace"][..],
        &["trace", "--camera", "nothing"],
        &["trace", "--camera", "sim:"],
        &["trace", "picture.png", "--camera", "sim"],
        &["trace", "picture.png", "--head", "head.toml"],
        &["calibrate", "markers"],
        &["calibrate", "head", "--camera", "/dev/nothing"],
    ] {
        let output = run(args);
        assert_eq!(output.status.code(), Some(2), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    }
}
