//! Amplifier, backlash, encoder, frequency response and relay, by the whole program: the simulated head's own truth comes back, and
//! its logs read back to the same.

use serde_json::Value;

use crate::support::{folder, lab, near, run};

fn written(name: &str, file: &str, text: &str) -> (std::path::PathBuf, String) {
    let dir = folder(name);
    let path = dir.join(file);
    std::fs::write(&path, text).unwrap();
    let path = path.to_str().unwrap().to_owned();
    (dir, path)
}

/// Where 95 of 100 are within their interval, none of a few is beyond twice that.
fn told(found: &Value, within: &Value, wanted: f64) {
    near(found, wanted, 2.0 * within.as_f64().unwrap() + 1e-9);
}

#[test]
fn an_amplifier_is_told_from_its_motors_own_voltage() {
    let (dir, rig) = written(
        "lab-amplifier",
        "rig.toml",
        "base = \"report\"\n[truth.wear]\nback_emf = \"0.005Nms/rad\"\n",
    );
    let out = dir.join("found");
    let command = ["amplifier", "--rig", &rig, "--out", out.to_str().unwrap()];
    let found = lab(&command);
    let torque_nm_per_a = 0.0432 * 6.3 * 2.8435;
    for (joint, a_per_v) in [("pan", 0.08), ("tilt", 0.1)] {
        let (is, within) = (&found[joint], &found[joint]["within"]);
        told(&is["a_per_v"], &within["a_per_v"], a_per_v);
        told(&is["back_emf_a_s_per_rad"], &within["back_emf_a_s_per_rad"], 0.005 / torque_nm_per_a);
        assert!(within["a_per_v"].as_f64().unwrap() < 2e-3 * a_per_v, "{joint}");
        assert!(is["as_read_a_per_v"].as_f64().unwrap() < 0.99 * a_per_v, "{joint}: turning it looks weaker");
        near(&is["torque_nm_per_v"], a_per_v * torque_nm_per_a, 2e-3 * a_per_v);
    }
    let log = out.join("readings.csv");
    let again = lab(&["amplifier", log.to_str().unwrap(), "--out", dir.join("again").to_str().unwrap()]);
    near(&again["pan"]["a_per_v"], found["pan"]["a_per_v"].as_f64().unwrap(), 1e-6);
    // nobody looked at the speeds; and the rig file is written
    let text = std::fs::read_to_string(&log).unwrap();
    let blind: String = text.lines().map(|l| l.rsplit_once(',').unwrap().0.to_owned() + "\n").collect();
    let (blind_dir, blind) = written("lab-amplifier-blind", "log.csv", &blind);
    let found = lab(&["amplifier", &blind, "--axis", "tilt", "--out", blind_dir.to_str().unwrap()]);
    assert!(found["tilt"]["back_emf_a_s_per_rad"].is_null() && found.get("pan").is_none());
    let rig = std::fs::read_to_string(blind_dir.join("rig.toml")).unwrap();
    assert!(rig.contains("[truth.tilt.motor]"), "what is believed of tilt is not what it is any more");
}

#[test]
fn play_and_slip_are_read_off_a_ruler() {
    let dir = folder("lab-backlash");
    let out = dir.to_str().unwrap();
    let found = lab(&["backlash", "--rig", "worn", "--out", out]);
    let arcminute_rad = (1.0_f64 / 60.0).to_radians();
    for joint in ["pan", "tilt"] {
        let is = &found[joint];
        told(&is["play_rad"], &is["within"]["play_rad"], arcminute_rad);
        assert!(is["within"]["play_rad"].as_f64().unwrap() < 2.5e-4 && is["slips"] == false, "{is}");
    }
    let log = dir.join("readings.csv").to_str().unwrap().to_owned();
    let again = lab(&["backlash", &log, "--rig", "worn", "--out", dir.join("again").to_str().unwrap()]);
    near(&again["tilt"]["play_rad"], found["tilt"]["play_rad"].as_f64().unwrap(), 1e-9);
    // a counter that loses three edges in ten thousand is found out
    let (lost_dir, rig) =
        written("lab-backlash-lost", "rig.toml", "base = \"report\"\n[truth.wear]\nlost_counts = 0.0003\n");
    let found = lab(&["backlash", "--rig", &rig, "--axis", "pan", "--out", lost_dir.to_str().unwrap()]);
    assert!(
        found["pan"]["slips"] == true && found["pan"]["slip_counts"].as_f64().unwrap().abs() > 0.5,
        "{found}"
    );
    let found = lab(&["backlash", "--axis", "pan", "--out", lost_dir.to_str().unwrap()]);
    assert_eq!(found["pan"]["slips"], false, "a new head does not");
}

#[test]
fn an_encoders_edges_tell_its_disc_and_what_it_lost() {
    let dir = folder("lab-encoder");
    let found = lab(&["encoder", "--rig", "worn", "--out", dir.to_str().unwrap()]);
    for joint in ["pan", "tilt"] {
        let is = &found[joint];
        near(&is["eccentricity_counts"], 0.1, 0.005);
        let kinds: Vec<f64> =
            is["kinds_counts"].as_array().unwrap().iter().map(|k| k.as_f64().unwrap()).collect();
        assert!(kinds.iter().sum::<f64>().abs() < 1e-9 && kinds.iter().all(|kind| kind.abs() < 0.2));
        assert!(kinds.iter().any(|kind| kind.abs() > 0.02) && is["lost"].as_array().unwrap().is_empty());
    }
    let log = dir.join("edges.csv").to_str().unwrap().to_owned();
    let again = lab(&["encoder", &log, "--rig", "worn", "--out", dir.join("again").to_str().unwrap()]);
    near(&again["pan"]["kinds_counts"][0], found["pan"]["kinds_counts"][0].as_f64().unwrap(), 1e-4);
    near(&again["tilt"]["eccentricity_counts"], 0.1, 0.005);
    let of = |lost_counts: f64| {
        let text =
            format!("base = \"report\"\n[truth.wear]\nedge_error = 0.1\nlost_counts = {lost_counts:?}\n");
        let (lost_dir, rig) = written("lab-encoder-lost", "rig.toml", &text);
        lab(&["encoder", "--rig", &rig, "--axis", "tilt", "--out", lost_dir.to_str().unwrap()])
    };
    let (none, lost) = (of(0.0), of(0.0001));
    for kind in 0..4 {
        // a count that is missing from the beginning only moves the kinds on
        let value = |found: &Value, kind: usize| found["tilt"]["kinds_counts"][kind].as_f64().unwrap();
        near(&lost["tilt"]["kinds_counts"][kind], value(&none, kind), 5e-3);
    }
    // 82 000 edges, an edge in ten thousand
    let lost = lost["tilt"]["lost"].as_array().unwrap().clone();
    assert!((3..=16).contains(&lost.len()) && lost.iter().all(|one| one["counts"] == 1), "{lost:?}");
}

#[test]
fn a_frequency_response_comes_back_from_its_log() {
    let dir = folder("lab-frequency-log");
    let [log, volts] = ["log.csv", "volts.csv"].map(|name| dir.join(name).to_str().unwrap().to_owned());
    let short = ["frequency", "--period", "2s", "--from", "4rad/s", "--to", "200rad/s", "--sines", "20"];
    let tried = lab(&[&short[..], &["--periods", "4", "--record", &log, "--volts", &volts]].concat());
    let read = lab(&["frequency", &log, "--period", "2s"]);
    let (tried, read) = (tried["points"].as_array().unwrap(), read["points"].as_array().unwrap());
    assert_eq!(tried.len(), read.len());
    for (tried, read) in tried.iter().zip(read) {
        let of = |point: &Value, what: &str| point[what].as_f64().unwrap();
        assert!((of(tried, "rad_s") - of(read, "rad_s")).abs() < 1e-9);
        assert!((of(tried, "magnitude") / of(read, "magnitude") - 1.0).abs() < 1e-4, "{tried} {read}");
        near(&read["phase_deg"], of(tried, "phase_deg"), 0.01);
    }
    assert_eq!(std::fs::read_to_string(&volts).unwrap().lines().count(), 2001);
}

#[test]
fn a_relay_tunes_a_joint_and_writes_it_down() {
    let (_, rig) = written(
        "lab-relay",
        "rig.toml",
        "# mine\nbase = \"report\"\n[control]\ntolerance = \"3mm\" # wide\n",
    );
    for (joint, seed) in [("pan", "0"), ("tilt", "3")] {
        let tuned = lab(&[
            "relay",
            "--axis",
            joint,
            "--rig",
            &rig,
            "--seed",
            seed,
            "--crossover",
            "30rad/s",
            "--save",
        ]);
        near(&tuned["inertia_kg_m2"], 0.0762, 0.004);
        near(&tuned["crossover_rad_s"], 30.0, 1e-9);
        assert!(tuned["step"]["overshoot_percent"].as_f64().unwrap() < 20.0, "{tuned}");
        assert!(tuned["step"]["linear"]["settle_s"].as_f64().unwrap() < 1.2, "{tuned}");
    }
    let text = std::fs::read_to_string(&rig).unwrap();
    for words in
        ["# mine", "# wide", "law = \"hand-tuned\"", "[control.hand_tuned.pan]", "[control.hand_tuned.tilt]"]
    {
        assert!(text.contains(words), "{words}: {text}");
    }
    let by_file = lab(&["step", "--rig", &rig, "--to", "5deg"]);
    assert_eq!(by_file["law"], "hand-tuned");
    assert!(by_file["overshoot_percent"].as_f64().unwrap() < 20.0);
    let weak = run(&["lab", "relay", "--level", "0.5V"]);
    let said = String::from_utf8(weak.stderr).unwrap();
    assert!(weak.status.code() == Some(1) && said.contains("give it more volts"), "{said}");
    let preset = run(&["lab", "relay", "--save"]);
    assert!(preset.status.code() == Some(2));
}

#[test]
fn logs_that_are_none_are_refused_by_their_line() {
    let wrong: [(&str, &str, &str); 9] = [
        ("amplifier", "axis,volt\n", "no column ampere"),
        ("amplifier", "axis,volt,ampere\nyaw,1,1\n", ":2: axis \"yaw\""),
        (
            "amplifier",
            "axis,volt,ampere\npan,1,1e9\n",
            ":2: 1000000000 in column 3 is more than any motor takes",
        ),
        ("backlash", "axis,count,way,spot_m\npan,1,0,0\n", ":2: way 0 is neither 1 nor -1"),
        ("backlash", "axis,count,way\n", "no column spot_m"),
        ("encoder", "axis,time_s,count\npan,0,0.5\n", ":2: \"0.5\" in column 3 is no count"),
        ("encoder", "axis,time_s\n", "no column count"),
        (
            "frequency",
            "axis,time_s,volt,count\npan,0,1,0\npan,0.5,1,0\n",
            ":3: 0.5 s comes 500.0000 ms after",
        ),
        ("frequency", "axis,time_s,volt,count\npan,0,1,0\n", "hold no two periods"),
    ];
    // readable, but they tell nothing
    let poor: [(&str, &str, &str); 3] = [
        ("amplifier", "axis,volt,ampere\npan,1,1\npan,1,1\npan,1,1\n", "tell no amplifier"),
        ("backlash", "axis,count,way,spot_m\npan,1,1,0\npan,1,1,0\npan,1,1,0\npan,1,1,0\n", "tell no play"),
        ("encoder", "axis,time_s,count\npan,0,0\npan,1,1\n", "192 are needed"),
    ];
    let all = wrong.map(|case| (2, case)).into_iter().chain(poor.map(|case| (1, case)));
    for (status, (command, text, what)) in all {
        let (_, log) = written("lab-parts-refused", "log.csv", text);
        let output = run(&["lab", command, &log]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(status) && said.contains(what), "{command}: {said}");
    }
}
