//! Friction, inertia and weight from voltages, by the whole program.

use serde_json::Value;

use crate::support::{folder, lab, near, root, run};

/// The report's tables: viscous and Coulomb friction forwards and backwards.
const TABLES: [(&str, [f64; 4]); 2] =
    [("pan", [0.0009, 0.0009, 0.0406, -0.0385]), ("tilt", [0.0019, 0.0017, 0.0584, -0.0569])];
const NAMES: [&str; 4] = ["viscous_pos", "viscous_neg", "coulomb_pos", "coulomb_neg"];

fn check_tables(found: &Value, viscous_share: f64, coulomb_share: f64) {
    for (joint, table) in TABLES {
        for ((name, value), share) in
            NAMES.into_iter().zip(table).zip([viscous_share, viscous_share, coulomb_share, coulomb_share])
        {
            near(&found[joint][name], value, share * value.abs());
        }
        assert!(found[joint]["r2"].as_f64().unwrap() > 0.9999, "{joint}");
    }
}

#[test]
fn the_reports_tables_come_back_and_its_protocol_is_biased() {
    let dir = folder("lab-friction");
    let out = dir.to_str().unwrap();
    let found = lab(&["friction", "--fixture", "--out", out]);
    check_tables(&found, 0.01, 0.001);
    for (joint, table) in TABLES {
        let steady = &found[joint]["steady"];
        let ratio = steady["viscous_pos"].as_f64().unwrap() / table[0];
        let expected = if joint == "pan" { 3.3..3.5 } else { 1.85..2.0 };
        assert!(expected.contains(&ratio), "{joint}: {ratio}");
        assert_eq!(steady["points"].as_array().unwrap().len(), 41);
    }
    let plot = std::fs::read_to_string(dir.join("friction.svg")).unwrap();
    for word in ["pan speed, rad/s", "tilt speed, rad/s", "torque, mN m", "as the report did"] {
        assert!(plot.contains(word), "{word}");
    }
    // the log reads back to the same, and a rig file was written that is read
    let log = dir.join("log.csv");
    let again = folder("lab-friction-log");
    let read = lab(&["friction", log.to_str().unwrap(), "--fixture", "--out", again.to_str().unwrap()]);
    check_tables(&read, 0.01, 0.001);
    assert!(!again.join("log.csv").exists());
    let rig = dir.join("rig.toml");
    let step = lab(&["step", "--rig", rig.to_str().unwrap(), "--axis", "tilt"]);
    assert!(step["overshoot_percent"].as_f64().unwrap() < 0.1);
}

#[test]
fn on_parameter_set_b_the_reports_protocol_gives_the_reports_tables() {
    let out = folder("lab-friction-b");
    let found = lab(&["friction", "--fixture", "--rig", "report-b", "--out", out.to_str().unwrap()]);
    for (joint, table) in TABLES {
        for (name, value) in NAMES.into_iter().zip(table) {
            near(&found[joint]["steady"][name], value, 0.002 * value.abs());
        }
    }
}

#[test]
fn on_its_feet_a_head_tells_friction_and_weight_within_its_range() {
    let out = folder("lab-friction-standing");
    let found = lab(&["friction", "--out", out.to_str().unwrap()]);
    check_tables(&found, 0.05, 0.01);
    near(&found["tilt"]["gravity_level_nm"], 0.149_68, 1e-4);
    assert!(found["pan"]["steady"]["viscous_pos"].is_null());
    let out = folder("lab-gravity");
    let weight =
        lab(&["gravity", "--out", out.to_str().unwrap(), "--step", "0.25V", "--most", "2V", "--pulse", "2V"]);
    near(&weight["tilt"]["gravity_level_nm"], 0.149_68, 1e-4);
    near(&weight["tilt"]["gravity_upright_nm"], 0.009_18, 2e-4);
    let out = folder("lab-inertia");
    let inertia =
        lab(&["inertia", "--out", out.to_str().unwrap(), "--fixture", "--hold", "5s", "--step", "0.25V"]);
    near(&inertia["pan"]["inertia_kg_m2"], 0.076_158, 1e-4);
    near(&inertia["tilt"]["inertia_kg_m2"], 0.075_029, 1e-4);
}

#[test]
fn a_frequency_response_coheres_where_a_count_does_not_hide_it() {
    let dir = folder("lab-frequency");
    let [csv, svg] = ["response.csv", "response.svg"].map(|name| dir.join(name).to_str().unwrap().to_owned());
    let found = lab(&["frequency", "--axis", "tilt", "--speed=-8rad/s", "-o", &csv, "-o", &svg]);
    assert_eq!(found["one_way"], true);
    let points = found["points"].as_array().unwrap();
    assert!(points.len() > 35);
    let value = |point: &Value, name: &str| point[name].as_f64().unwrap();
    for point in points.iter().filter(|point| value(point, "coherence") > 0.99) {
        let ratio = value(point, "magnitude") / value(point, "model_magnitude");
        assert!((ratio - 1.0).abs() < 0.002 + 4.0 * value(point, "deviation"), "{point}");
    }
    assert!(value(&found, "coherent_to_rad_s") > 50.0, "{found}");
    assert!(value(points.last().unwrap(), "coherence") < 0.7, "two thousandths of a count");
    assert_eq!(std::fs::read_to_string(csv).unwrap().lines().count(), points.len() + 1);
    let plot = std::fs::read_to_string(svg).unwrap();
    assert!(plot.contains("coherence") && plot.contains("phase, °"));
    let refused = run(&["lab", "frequency", "--from", "0.1rad/s"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("--from"));
}

#[test]
fn measured_torques_are_a_line_a_direction() {
    let dir = folder("lab-friction-measured");
    let log = dir.join("log.csv");
    let mut text = String::from("axis,torque_nm,velocity_rad_s\n");
    for k in 1..=8 {
        let rate = f64::from(k);
        text +=
            &format!("pan,{},{rate}\npan,{},{}\n", 0.0406 + 0.0009 * rate, -0.0385 - 0.0009 * rate, -rate);
    }
    std::fs::write(&log, text).unwrap();
    let found = lab(&["friction", log.to_str().unwrap(), "--out", dir.to_str().unwrap()]);
    for (name, value) in NAMES.into_iter().zip(TABLES[0].1) {
        near(&found["pan"][name], value, 1e-9);
    }
    assert!(found["tilt"].is_null());
    near(&found["pan"]["r2"], 1.0, 1e-9);
}

#[test]
fn what_was_found_is_saved_with_the_files_comments() {
    let dir = folder("lab-friction-save");
    let rig = dir.join("mine.toml");
    std::fs::write(
        &rig,
        "name = \"mine\" # ours\nbase = \"report\"\n[model.pan.friction]\nviscous_pos = \"0.002Nms/rad\" # a guess\n[truth.pan.friction]\nviscous_pos = \"0.0009Nms/rad\"\n",
    )
    .unwrap();
    let before = std::fs::read_to_string(&rig).unwrap();
    let arguments =
        ["friction", "--fixture", "--axis", "pan", "--step", "0.1V", "--rig", rig.to_str().unwrap()];
    let out = dir.join("out");
    let with_out = [&arguments[..], &["--out", out.to_str().unwrap()]].concat();
    lab(&with_out);
    assert_eq!(std::fs::read_to_string(&rig).unwrap(), before, "only with --save");
    lab(&[&with_out[..], &["--save"]].concat());
    let after = std::fs::read_to_string(&rig).unwrap();
    assert!(after.contains("# ours") && after.contains("# a guess"), "{after}");
    assert!(after.contains("viscous_pos = \"0.0009") || after.contains("viscous_pos = \"0.00090"), "{after}");
}

#[test]
fn what_cannot_be_is_refused_in_a_sentence() {
    let refused = |arguments: &[&str], status: i32, word: &str| {
        let output = run(&[&["lab"], arguments].concat());
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(status), "{arguments:?}: {said}");
        assert!(said.contains(word), "{arguments:?}: {said}");
    };
    let dir = folder("lab-friction-wrong");
    let out = ["--out", dir.to_str().unwrap()];
    let with_out =
        |arguments: &[&'static str]| -> Vec<&str> { arguments.iter().copied().chain(out).collect() };
    refused(&with_out(&["friction", "--most", "0.1V", "--pulse", "0.1V"]), 1, "give more volts");
    refused(&with_out(&["friction", "--most", "1"]), 2, "no unit");
    refused(&with_out(&["friction", "--most", "20V"]), 2, "of the amplifier");
    refused(&with_out(&["friction", "--step", "1mV"]), 2, "--step");
    refused(&with_out(&["friction", "--save"]), 2, "--save");
    refused(&with_out(&["friction", "no-such.csv"]), 2, "no-such.csv");
    refused(&with_out(&["gravity", "--fixture"]), 2, "--fixture");
    refused(&with_out(&["gravity", "--axis", "pan"]), 2, "tilt");
    let readme = root().join("README.md");
    refused(
        &with_out(&["friction"]).into_iter().chain([readme.to_str().unwrap()]).collect::<Vec<_>>(),
        2,
        "axis,volt",
    );
}
