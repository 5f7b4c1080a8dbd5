//! Heads without encoders, by the program: drawn to light on the wall, and refused what they cannot do.

use serde_json::Value;

use crate::support::{folder, run};

const STAR: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/star.png");

/// The exit status, what is told as JSON, and to people.
fn told(args: &[&str]) -> (i32, Value, String) {
    let output = run(args);
    let said = String::from_utf8(output.stderr).unwrap();
    (output.status.code().unwrap(), serde_json::from_slice(&output.stdout).unwrap(), said)
}

#[test]
fn both_presets_draw_a_star_and_say_what_is_not_measured() {
    for (rig, least_mm, most_mm) in [("stepper", 0.05, 1.0), ("servo", 1.0, 15.0)] {
        let dir = folder(&format!("drives-{rig}"));
        let out = dir.join("out").to_str().unwrap().to_owned();
        let (code, answer, notes) = told(&["trace", STAR, "--rig", rig, "--out", &out, "--json"]);
        assert_eq!(code, 0, "{rig}: {answer}");
        let rms_mm = answer["tracking"]["rms_mm"].as_f64().unwrap();
        assert!((least_mm..most_mm).contains(&rms_mm), "{rig}: {rms_mm} mm rms");
        for words in ["open loop", "nobody measured", "mm of error a joint"] {
            assert!(notes.contains(words), "{rig}: {notes}");
        }
        assert!(!notes.contains("steps were lost"), "{rig}: {notes}");
        let told = answer["notes"].as_array().unwrap();
        assert!(
            told.iter().any(|note| note.as_str().unwrap().contains("nobody measured")),
            "{rig}: {told:?}"
        );
        let page = std::fs::read_to_string(dir.join("out/report.html")).unwrap();
        assert!(page.contains("nobody measured"), "{rig}: the report does not say so");
    }
}

#[test]
fn a_motor_weaker_than_believed_loses_steps_and_the_simulation_tells() {
    let dir = folder("drives-lost");
    let rig = dir.join("hasty.toml");
    // bearings that the plan does not know of
    let text = "base = \"stepper\"\n[motion]\ntorque_share = 0.95\npan_acceleration = \"20000rad/s2\"\ntilt_acceleration = \"20000rad/s2\"\n\
                [truth.pan.friction]\ncoulomb_pos = \"0.9Nm\"\ncoulomb_neg = \"-0.9Nm\"\n\
                [truth.tilt.friction]\ncoulomb_pos = \"0.9Nm\"\ncoulomb_neg = \"-0.9Nm\"\n";
    std::fs::write(&rig, text).unwrap();
    let out = dir.join("out").to_str().unwrap().to_owned();
    let (code, answer, notes) =
        told(&["trace", STAR, "--rig", rig.to_str().unwrap(), "--out", &out, "--json"]);
    assert_eq!(code, 0, "no head without encoders notices: {answer}");
    assert!(notes.contains("steps were lost"), "{notes}");
}

#[test]
fn a_camera_homes_a_head_on_steppers_and_finds_the_steps_that_it_lost() {
    let dir = folder("drives-camera");
    let out = dir.join("out").to_str().unwrap().to_owned();
    let wall = concat!("sim:", env!("CARGO_MANIFEST_DIR"), "/../../examples/house.png");
    let what = ["trace", "--camera", wall, "--rig", "stepper", "--home", "--sim-trouble", "pan-slip=60@5"];
    let (code, answer, _) = told(&[&what[..], &["--out", &out, "--json"]].concat());
    assert_eq!(code, 0, "{answer}");
    let seen = &answer["camera"];
    assert_eq!(seen["homed"]["sought"], 3, "{seen}");
    let recoveries = seen["follow"]["recoveries"].as_array().unwrap();
    assert!(
        recoveries.len() == 1 && recoveries[0]["what"].as_str().unwrap().contains("found anew"),
        "{seen}"
    );
    // until it was seen to be off by 37 mm, and not after that
    assert!(seen["figure_mm"]["rms"].as_f64().unwrap() < 4.0, "{seen}");
}

#[test]
fn what_needs_encoders_is_refused() {
    for args in [
        &["trace", STAR, "--rig", "stepper", "--law", "pid", "--json"][..],
        &["lab", "step", "--rig", "servo", "--json"],
        &["lab", "tune", "--rig", "stepper", "--json"],
    ] {
        let (code, answer, _) = told(args);
        assert_eq!((code, &answer["error"]["code"]), (2, &"open-loop-rig".into()), "{args:?} {answer}");
        let message = answer["error"]["message"].as_str().unwrap();
        assert!(message.contains("needs encoders"), "{args:?} {message}");
    }
}
