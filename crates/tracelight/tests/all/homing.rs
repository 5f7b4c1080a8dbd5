//! A head that was just powered up, of which nobody knows where it points: homed by dots that a camera sees, and dark until then.

use serde_json::Value;

use crate::support::{check_at_most, folder, json, run};

const HOUSE: &str = concat!("sim:", env!("CARGO_MANIFEST_DIR"), "/../../examples/house.png");

/// What homing a head of a simulated room came to.
fn homed(seed: &str, more: &[&str]) -> Value {
    let all = [&["calibrate", "head", "--camera", "sim", "--home", "--seed", seed, "--json"], more].concat();
    json(&run(&all))
}

fn check_homed(found: &Value) {
    let off = |j: usize| found["homed"]["truth_mm"][j].as_f64().unwrap().abs();
    assert!(off(0) < 1.0 && off(1) < 1.0, "{}", found["homed"]);
}

#[test]
fn a_head_that_was_just_powered_up_is_homed_within_a_millimetre_wherever_it_points() {
    let dir = folder("home");
    let head = dir.join("head.toml").to_str().unwrap().to_owned();
    // neither is left looking where the camera does
    for seed in ["1", "2"] {
        let found = homed(seed, &["-o", &head]);
        check_homed(&found);
        assert!(found["homed"]["sought"].as_u64().unwrap() > 1, "{}", found["homed"]);
        check_at_most(&found, "/rms_mm", 0.3);
        check_at_most(&found, "/truth_mm/max", 0.8);
        // a head that is known is homed so that what is known of it holds again
        json(&run(&["calibrate", "head", "--camera", "sim", "--seed", seed, "-o", &head, "--json"]));
        let again = homed(seed, &["--head", &head]);
        assert_eq!(again["homed"]["truth_mm"], serde_json::json!([0.0, 0.0]), "{seed}");
    }
}

#[test]
fn stops_in_its_way_are_gone_round() {
    let dir = folder("home-stops");
    let [rig, head] = ["rig.toml", "head.toml"].map(|name| dir.join(name).to_str().unwrap().to_owned());
    let shown = run(&["rigs", "show", "report"]);
    let text = String::from_utf8(shown.stdout).unwrap();
    let mut ends = ["-0.7rad", "1.9rad", "-0.9rad", "0.5rad"].into_iter();
    let narrow = text.lines().map(|line| match line.split_once(" = ") {
        Some((key @ ("range_min" | "range_max"), _)) => format!("{key} = \"{}\"\n", ends.next().unwrap()),
        _ => format!("{line}\n"),
    });
    std::fs::write(&rig, narrow.collect::<String>()).unwrap();
    assert!(ends.next().is_none());
    let more = ["--rig", &rig, "-o", &head];
    let args = [&["calibrate", "head", "--camera", "sim", "--home", "--seed", "9"], &more[..]].concat();
    let output = run(&args);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.contains("something is in the way of tilt"), "{said}");
    check_homed(&homed("9", &more));
}

/// In this room tilt is sent 3° beyond its stop once, which is as far as it may stray: it pushes, and shows it, when its way is over.
#[test]
fn a_stop_just_before_the_end_of_a_way_is_gone_round() {
    let dir = folder("home-end");
    let head = dir.join("head.toml").to_str().unwrap().to_owned();
    let room = ["--sim-camera", "report"];
    let args = ["calibrate", "head", "--camera", "sim", "--seed", "15", "-o", &head, "--json"];
    json(&run(&[&args[..], &room].concat()));
    let found = homed("15", &[&room[..], &["--head", &head]].concat());
    assert_eq!(found["homed"]["stops"], 1, "{}", found["homed"]);
    check_homed(&found);
}

#[test]
fn a_head_is_homed_before_it_draws_what_a_camera_sees() {
    let dir = folder("home-trace");
    let out = dir.join("out").to_str().unwrap().to_owned();
    let found = json(&run(&["trace", "--camera", HOUSE, "--home", "--seed", "4", "--out", &out, "--json"]));
    check_at_most(&found, "/camera/figure_mm/rms", 0.5);
    assert!(found["camera"]["homed"]["sought"].as_u64().unwrap() >= 1, "{}", found["camera"]["homed"]);
    let report = std::fs::read_to_string(dir.join("out/report.html")).unwrap();
    assert!(report.contains("counts from where it was powered up"));
    for wrong in [
        &["trace", "examples/star.png", "--home"][..],
        &["trace", "--camera", "http://127.0.0.1:9/", "--home"],
        &["trace", "--camera", HOUSE, "--home", "--dry-run"],
    ] {
        assert_eq!(run(wrong).status.code(), Some(2), "{wrong:?}");
    }
}

#[test]
fn a_rig_that_is_not_homed_draws_nothing() {
    let dir = folder("unhomed");
    let [head, out] = ["head.toml", "out"].map(|name| dir.join(name).to_str().unwrap().to_owned());
    json(&run(&["calibrate", "head", "--camera", "sim", "--seed", "2", "-o", &head, "--json"]));
    let unhomed = |more: &[&str]| {
        let all = [&["trace", "--sim-unhomed", "--seed", "2", "--out", &out, "--json"], more].concat();
        let output = run(&all);
        assert_eq!(output.status.code(), Some(1), "{more:?}");
        let answer: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(answer["error"]["code"], "unhomed", "{more:?} {answer}");
        assert!(answer["error"]["message"].as_str().unwrap().contains("calibrate head --home"), "{answer}");
    };
    unhomed(&[HOUSE.strip_prefix("sim:").unwrap()]);
    unhomed(&["--camera", HOUSE]);
    unhomed(&["--camera", HOUSE, "--head", &head]);
}

#[test]
fn a_rig_that_loses_power_while_it_draws_is_told_of_with_what_it_drew() {
    let dir = folder("power-loss");
    let out = dir.join("out");
    let output = run(&[
        "trace",
        "--camera",
        HOUSE,
        "--seed",
        "7",
        "--sim-trouble",
        "power-loss@4",
        "--out",
        out.to_str().unwrap(),
        "--json",
    ]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("the rig lost power while it drew"));
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(found["error"]["code"], "unhomed");
    let summary: Value = serde_json::from_slice(&std::fs::read(out.join("summary.json")).unwrap()).unwrap();
    assert_eq!(summary["run"]["finished"], false);
    check_at_most(&summary, "/camera/figure_mm/rms", 0.5);
    check_at_most(&summary, "/tracking/off_stroke_max_mm", 1.0);
    assert!(summary["laser"]["lit_s"].as_f64().unwrap() > 1.5);
}
