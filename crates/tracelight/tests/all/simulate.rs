//! Arrays of times and angles through the nonlinear loop, and laws picked, by the whole program.

use std::path::Path;

use serde_json::Value;

use crate::support::{folder, lab, run};

/// The feasible half turn of the 2006 report's start file, vmax 5, amax 4, dmax 1, with tilt at half of it.
fn half_turn(dir: &Path) -> String {
    let profile = dir.join("profile.csv");
    let limits = ["--vmax", "5rad/s", "--amax", "4rad/s2", "--dmax", "1rad/s2"];
    lab(&[&["profile", "--distance", "180deg"], &limits[..], &["-o", profile.to_str().unwrap()]].concat());
    let rows = std::fs::read_to_string(profile).unwrap();
    let mut text = String::new();
    for row in rows.lines().skip(1) {
        let fields: Vec<f64> = row.split(',').map(|field| field.parse().unwrap()).collect();
        text += &format!("{},{},{}\n", fields[0], fields[1], 0.5 * fields[1]);
    }
    let path = dir.join("array.csv");
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

fn figure(found: &Value, run: usize, joint: &str, name: &str) -> f64 {
    found["runs"][run][joint][name].as_f64().unwrap()
}

#[test]
fn the_reports_pd_lags_on_its_own_array_and_ours_does_not() {
    let dir = folder("lab-simulate");
    let array = half_turn(&dir);
    let csv = dir.join("scopes.csv");
    let pd = ["--controller", "2 + 10 s/(1 + s/50)", "2 + 5 s/(1 + s/50)"];
    let scopes = ["--law", "state", "-o", csv.to_str().unwrap()];
    let found = lab(&[&["simulate", &array], &pd[..], &scopes].concat());
    for joint in ["pan", "tilt"] {
        // a constant error is left: friction and weight against a gain of 2 N m/rad
        assert!(figure(&found, 0, joint, "final_error_rad") > 4e-3, "{found}");
        assert!(figure(&found, 1, joint, "final_error_rad") < 1e-4, "{found}");
        assert!(figure(&found, 0, joint, "rms_rad") > 30.0 * figure(&found, 1, joint, "rms_rad"), "{found}");
    }
    let text = std::fs::read_to_string(&csv).unwrap();
    let mut lines = text.lines();
    let header = "t_s,pan_set_rad,tilt_set_rad,pan_rad,tilt_rad,pan_error_rad,tilt_error_rad,pan_nm,tilt_nm";
    assert_eq!(lines.next(), Some(header));
    for line in lines.clone().step_by(97) {
        let row: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
        assert!((row[1] - row[3] - row[5]).abs() < 2e-7, "error is set less actual: {line}");
        assert!(row[7].abs() <= 0.62, "the rig's own cap: {line}");
    }
    assert_eq!(lines.count(), 3304, "2.8025 s of array, 0.5 s of rest, both ends");
    // what it wrote is an array itself
    let again = lab(&["simulate", csv.to_str().unwrap(), "--law", "state"]);
    assert!(figure(&again, 0, "pan", "rms_rad") < 1e-4, "{again}");
}

#[test]
fn quantizer_hold_cap_and_masses_can_be_changed() {
    let dir = folder("lab-simulate-switches");
    let array = half_turn(&dir);
    let k = ["--controller", "K11t", "K22t"];
    let with = |more: &[&str]| lab(&[&["simulate", &array], &k[..], more].concat());
    let all = with(&[]);
    let smooth = with(&["--quantizer", "off", "--hold", "off"]);
    let strong = with(&["--quantizer", "off", "--cap", "500Nm"]);
    // one count is 5.9 N m through this compensator: it hammers, and without a quantizer it does not
    assert!(figure(&all, 0, "pan", "capped_share") > 0.3, "{all}");
    assert!(figure(&smooth, 0, "pan", "capped_share") < 0.01, "{smooth}");
    assert!(figure(&strong, 0, "pan", "capped_share") == 0.0, "{strong}");
    assert!(figure(&smooth, 0, "pan", "rms_rad") < 0.5 * figure(&all, 0, "pan", "rms_rad"));
    // set B has a tenth of the inertia, and friction as it was
    let light = lab(&["simulate", &array, "--law", "state", "--set", "b"]);
    assert!(figure(&light, 0, "tilt", "rms_rad") < 1e-3, "{light}");
    let random = |seed: &str| lab(&["simulate", "--random", "4s", "--seed", seed]);
    assert_eq!(random("3"), random("3"));
    assert_ne!(random("3")["runs"], random("4")["runs"]);
}

#[test]
fn what_is_no_motion_is_refused_in_a_sentence() {
    let dir = folder("lab-simulate-wrong");
    let refused = |text: &str, more: &[&str], status: i32, word: &str| {
        let path = dir.join("array.csv");
        std::fs::write(&path, text).unwrap();
        let output = run(&[&["lab", "simulate", path.to_str().unwrap()], more].concat());
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(status), "{said}");
        assert!(said.contains(word), "{said}");
    };
    refused("0,0,0\n", &[], 2, "two rows");
    refused("0,0,0\n1,4,0\n", &[], 2, ":2: pan at 4 rad is out of its range");
    refused("0,0,0\n1,nan,0\n", &[], 2, "no number");
    refused("0,0,0\n1,1,0\n", &["--hold", "off"], 2, "--controller");
    refused("0,0,0\n1,1,0\n", &["--controller", "2+10s", "1"], 1, "filter");
    refused("0,0,0\n1,1,0\n", &["--controller", "2+*", "1"], 2, "^");
    refused("0,0,0\n1,1,0\n", &["--cap", "5"], 2, "no unit");
    assert_eq!(run(&["lab", "simulate"]).status.code(), Some(2));
}

#[test]
fn a_law_is_picked_that_bears_what_is_asked_and_is_saved() {
    let dir = folder("lab-tune");
    let rig = dir.join("mine.toml");
    std::fs::write(
        &rig,
        "name = \"mine\" # ours\nbase = \"report\"\n[control]\nlaw = \"pid\" # for now\npan_bandwidth = \"12rad/s\"\n",
    )
    .unwrap();
    let out = dir.join("out");
    let common = ["tune", "--rig", rig.to_str().unwrap(), "--plants", "2", "--out", out.to_str().unwrap()];
    let found = lab(&[&common[..], &["--laws", "state,pid-ff", "--save"]].concat());
    let (picked, was) = (&found["picked"], &found["was"]);
    assert_eq!(picked["bears"], true);
    assert_eq!(was["law"], "pid");
    let error = |tried: &Value| tried["max_mm_p95"].as_f64().unwrap_or(f64::INFINITY);
    assert!(error(picked) < 0.6 && error(picked) < error(was), "{found}");
    for tried in found["tried"].as_array().unwrap() {
        assert!(tried["bears"] == false || error(tried) >= error(picked), "{tried}");
    }
    let text = std::fs::read_to_string(&rig).unwrap();
    assert!(text.contains("# ours") && text.contains("# for now") && !text.contains("\"pid\""), "{text}");
    // the saved rig is the picked one
    let again =
        lab(&[&common[..], &["--laws", "state", "--slowest", "50rad/s", "--fastest", "60rad/s"]].concat());
    assert_eq!(again["was"]["law"], picked["law"]);
    assert!((error(&again["was"]) - error(picked)).abs() < 0.02, "{again}");
    let plot = std::fs::read_to_string(out.join("tune.svg")).unwrap();
    assert!(plot.contains("bandwidth, rad/s") && plot.contains("largest error, mm"));
    // no loop bears motors five times as strong and as weak, and 50 ms of lag
    let hopeless =
        [&["lab"], &common[..], &["--gain-margin", "5", "--lag", "50ms", "--laws", "pid"]].concat();
    let refused = run(&hopeless);
    assert_eq!(refused.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("--gain-margin"));
}
