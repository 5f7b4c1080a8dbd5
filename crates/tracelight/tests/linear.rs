//! Linear models from the command line, held against the 2006 report and other tools.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on may panic")]

mod support;

use serde_json::Value;
use support::{folder, run};

fn lab(arguments: &[&str]) -> Value {
    let output = run(&[&["lab"], arguments, &["--json"]].concat());
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn near(value: &Value, wanted: f64, tolerance: f64) {
    let number = value.as_f64().unwrap();
    assert!((number - wanted).abs() <= tolerance, "{number}, not {wanted}");
}

/// To the last digit the report printed.
fn printed_as(value: &Value, digits: &[f64], places: &[i32]) {
    let numbers = value.as_array().unwrap();
    assert_eq!(numbers.len(), digits.len(), "{value}");
    for ((number, digit), place) in numbers.iter().zip(digits).zip(places) {
        near(number, *digit, 0.5 * 10_f64.powi(-place));
    }
}

#[test]
fn a_linear_head_is_the_reports_to_every_digit() {
    let whole = lab(&["linearize", "--keep-cancellations"]);
    printed_as(&whole["G11"]["num"], &[13.16, 1.754, 10.29], &[2, 3, 2]);
    printed_as(&whole["G11"]["den"], &[1.0, 0.2649, 0.7997, 0.1029, 0.0], &[9, 4, 4, 4, 9]);
    let own = lab(&["linearize"]);
    printed_as(&own["G22"]["num"], &[13.33], &[2]);
    printed_as(&own["G22"]["den"], &[1.0, 0.1333, 0.7822], &[9, 4, 4]);
    printed_as(&own["G11"]["den"], &[1.0, 0.1316, 0.0], &[9, 4, 9]);
    // tilt's friction is the mean of both directions, nearly all inertia the motors' own
    let rig = lab(&["linearize", "--rig", "report", "--at", "0deg,0deg"]);
    near(&rig["A"][3][3], -0.0018 / 0.0750286, 1e-6);
    near(&rig["holding_nm"][1], -0.149_679, 1e-5);
}

#[test]
fn margins_of_the_reports_loops_are_those_of_other_tools() {
    let bode = lab(&["bode", "K11 G11", "K22 G22", "K11t G11", "K22t G22"]);
    for (system, degrees, rad_s, delay_s, modulus) in [
        (0, 29.0, 17.5, 28.8e-3, 0.50),
        (1, 29.2, 11.9, 43.0e-3, 0.50),
        (2, 64.5, 138.0, f64::NAN, f64::NAN),
        (3, 64.0, 114.0, f64::NAN, f64::NAN),
    ] {
        let margins = &bode["systems"][system]["margins"];
        near(&margins["phase"]["deg"], degrees, 0.05);
        near(&margins["phase"]["rad_s"], rad_s, 0.6);
        assert!(margins["gain"].is_null(), "{margins}");
        if delay_s.is_finite() {
            near(&margins["delay_s"], delay_s, 0.05e-3);
            near(&margins["modulus"]["distance"], modulus, 0.005);
        }
    }
    // at 1 kHz behind a hold there is a gain margin: 44 dB
    let sampled = lab(&["bode", "K11 G11", "--sample", "1ms"]);
    assert!(
        sampled["systems"][0]["margins"]["gain"]["db"].as_f64().is_some_and(|db| (40.0..60.0).contains(&db)),
        "{sampled}"
    );
    let closed = lab(&["pzmap", "K11 G11", "--closed"]);
    let slow = &closed["systems"][0]["poles"][0];
    near(&slow[0], -4.26, 0.005);
    near(&slow[1], 15.85, 0.005);
}

#[test]
fn linear_systems_are_plotted_and_tabled() {
    let dir = folder("lab-linear");
    let [svg, csv] = ["plot.svg", "table.csv"].map(|name| dir.join(name).to_str().unwrap().to_owned());
    for (command, words, rows) in [
        ("bode", "amplification, dB", 1001),
        ("nyquist", "imaginary part", 1001),
        ("nichols", "closed loop", 1001),
        ("locus", "Root locus", 1002),
        ("pzmap", "crosses", 6),
    ] {
        for extra in [&[][..], &["--dark"], &["--sample", "2ms"]] {
            let arguments =
                [&[command, "(s+2)/(s (s+1)(s+9)^2)", "-o", &svg, "-o", &csv][..], extra].concat();
            assert!(lab(&arguments)["systems"][0]["poles"].is_array());
            let plot = std::fs::read_to_string(&svg).unwrap();
            assert!(plot.contains(words) && plot.trim_end().ends_with("</svg>"), "{arguments:?}");
            let table = std::fs::read_to_string(&csv).unwrap();
            assert!(
                table.lines().count() >= rows && !table.contains("NaN"),
                "{arguments:?}: {}",
                table.lines().count()
            );
        }
    }
    // nothing, a number, a loop whose highest powers cancel for one gain, poles on the edge
    for strange in
        ["0", "5", "s", "-s/(s+1)", "1/(s^2+1)^3", "(s+1)^40", "1/s^4 - 1/s^4", "1/(s+1e300)", "(1-s)/(1+s)"]
    {
        for command in ["bode", "nyquist", "nichols", "locus", "pzmap"] {
            let formula = format!("0+{strange}");
            assert!(
                lab(&[command, &formula, "-o", &svg, "-o", &csv, "--gain", "1"]
                    [..if command == "locus" { 8 } else { 6 }])["systems"]
                    .is_array()
            );
        }
    }
    let locus = lab(&["locus", "1/(s(s+1)(s+2))"]);
    near(&locus["systems"][0]["oscillating"][0]["gain"], 6.0, 1e-9);
    near(&locus["systems"][0]["breakaways"][0]["gain"], 0.3849, 1e-4);
}
