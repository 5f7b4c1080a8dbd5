//! Loops of plant and controller from the command line: gang of four, error constants, disturbances, measured loops, positive feedback.

use serde_json::Value;

use crate::support::{folder, lab, near, run};

fn text(arguments: &[&str]) -> String {
    let output = run(&[&["lab"][..], arguments].concat());
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn refused(arguments: &[&str]) -> String {
    let output = run(&[&["lab"][..], arguments].concat());
    assert!(!output.status.success(), "{arguments:?}");
    String::from_utf8(output.stderr).unwrap()
}

/// Values of 2 e^(−0.3 s)/(s + 1), or of 2/(s − 1), at 200 frequencies, as a CSV.
fn measured(name: &str, is_late: bool) -> String {
    let mut table = String::from("Frequency (rad/s),Gain (dB),Phase (deg)");
    for k in 0..200 {
        let w = 10_f64.powf(-2.0 + 4.5 * f64::from(k) / 199.0);
        let phase = if is_late { -w.atan() - 0.3 * w } else { w.atan() - std::f64::consts::PI };
        table += &format!("\n{w:.9e},{:.9e},{:.9e}", 20.0 * (2.0 / w.hypot(1.0)).log10(), phase.to_degrees());
    }
    let path = folder(&format!("gang_{name}")).join(name);
    std::fs::write(&path, table).unwrap();
    path.display().to_string()
}

/// Peaks as in `crates/linear/tests/all/feedback.rs`, where scipy's are.
#[test]
fn a_gang_of_four_tells_its_peaks_and_is_plotted() {
    let out = folder("gang");
    let [svg, png, csv] =
        ["gang.svg", "gang.png", "gang.csv"].map(|name| out.join(name).display().to_string());
    let found =
        lab(&["gang", "2exp(-0.3s)/(s+1)", "--controller", "0.8(s+2)/s", "-o", &svg, "-o", &png, "-o", &csv]);
    let one = &found["loops"][0];
    assert_eq!(one["closed_stable"], true);
    for (name, gain, rad_s) in [
        ("s", 2.006_418_48, 2.817_507_7),
        ("t", 1.581_665_65, 2.086_651_6),
        ("ps", 1.466_271_48, 2.325_446_0),
        ("cs", 1.999_886_48, 2.571_936_1),
    ] {
        let peak = &one["members"][name]["peak"];
        near(&peak["h_infinity"], gain, 1e-7);
        near(&peak["rad_s"], rad_s, 1e-4);
        near(&peak["db"], 20.0 * gain.log10(), 1e-6);
    }
    let plot = std::fs::read_to_string(svg).unwrap();
    for words in
        ["Ms 6.048 dB at 2.818 rad/s", "Mt 3.982 dB", "PS 3.324 dB", "CS 6.02 dB", "CS = C/(1 + PC), dB"]
    {
        assert!(plot.contains(words), "{words}");
    }
    let table = std::fs::read_to_string(csv).unwrap();
    assert!(table.starts_with("rad_s,hz,s_db_1,t_db_1,ps_db_1,cs_db_1\n") && table.lines().count() == 1001);
    let told = text(&["gangof4", "G11", "--controller", "K11", "--controller", "K11t"]);
    assert!(
        told.contains("G11 with K11t")
            && told.contains("S, peak Ms      6.017 dB (factor 1.999) at 17.65 rad/s (2.809 Hz)"),
        "{told}"
    );
}

#[test]
fn an_unstable_loop_has_no_norm_but_margins() {
    let told = text(&["gang", "1/(s-1)", "--controller", "0.5"]);
    assert!(told.contains("there is no H∞ norm") && told.contains("gain margin     6.021 dB"), "{told}");
    assert!(!told.contains("Ms "), "{told}");
    // a zero hides the pole that grows
    let hidden = lab(&["gang", "1/(s-1)", "--controller", "(s-1)/(s+1)"]);
    let one = &hidden["loops"][0];
    assert_eq!(
        (&one["closed_stable"], &one["members"]["s"]["peak"]["none"]),
        (&false.into(), &"unstable".into())
    );
}

#[test]
fn measured_loops_tell_stability_by_their_turns() {
    let (late, grows) = (measured("late.csv", true), measured("grows.csv", false));
    let found = lab(&["gang", &late, "--controller", "0.8(s+2)/s", "--unstable", "0"]);
    let one = &found["loops"][0];
    assert_eq!(one["closed_stable"], true);
    // beside the exact one; between points the data are interpolated
    for (name, gain) in [("s", 2.006_418_48), ("t", 1.581_665_65), ("ps", 1.466_271_48), ("cs", 1.999_886_48)]
    {
        near(&one["members"][name]["peak"]["h_infinity"], gain, 2e-3);
        assert_eq!(one["members"][name]["peak"]["at_end_of_data"], false);
    }
    let too_much = text(&["gang", &late, "--controller", "3(s+2)/s", "--unstable", "0"]);
    assert!(
        too_much.contains("not stable: 2 poles grow") && too_much.contains("gain margin     −2.9"),
        "{too_much}"
    );
    let stable = text(&["bode", &grows, "--unstable", "1"]);
    assert!(
        stable.contains("it is stable, by its turns round −1") && stable.contains("above 316.2 rad/s"),
        "{stable}"
    );
    let contradicted = text(&["bode", &grows, "--unstable", "0"]);
    assert!(contradicted.contains("the data do not tell"), "{contradicted}");
    assert!(text(&["nyquist", &grows]).contains("--unstable"));
    assert_eq!(lab(&["nyquist", &grows, "--unstable", "1"])["systems"][0]["closed_unstable"], 0);
    assert!(refused(&["bode", "1/s", "--unstable", "0"]).contains("of a formula the poles are known"));
}

#[test]
fn error_constants_are_told_of_stable_loops_alone() {
    // Kv = 10/2
    for command in [&["bode", "10/(s(s+2))"][..], &["response", "10/(s(s+2))", "--closed"]] {
        let found = lab(command);
        let constants = &found["systems"][0]["error_constants"];
        assert_eq!((&constants["type"], &constants["kp"]), (&1.into(), &Value::Null), "{command:?}");
        near(&constants["kv"], 5.0, 1e-12);
        near(&constants["steady_state_error"]["ramp"], 0.2, 1e-12);
        assert_eq!(constants["steady_state_error"]["parabola"], Value::Null);
        assert!(text(command).contains("steady-state error 0 of a step, 0.2 of a ramp, grows of a parabola"));
    }
    assert_eq!(lab(&["bode", "10/(s(s+1)(s+2))"])["systems"][0]["error_constants"], Value::Null);
    // the error to a ramp is what the sensitivity answers to one
    let ramp = lab(&["response", "10/(s(s+2))", "--closed", "--disturbance", "output", "--input", "ramp"]);
    near(&ramp["systems"][0]["final"], 0.2, 1e-12);
}

/// Values as in `crates/linear/tests/all/feedback.rs`, where Heun's method has them.
#[test]
fn a_loop_answers_to_disturbances() {
    let load = ["response", "2exp(-0.2s)/(s+1)", "--controller", "0.8(s+2)/s", "--disturbance", "input"];
    let found = lab(&load);
    let one = &found["systems"][0];
    near(&one["peak"], 0.656_782, 1e-5);
    near(&one["final"], 0.0, 1e-12);
    assert_eq!((&one["settle_s"], &one["rise_s"]), (&Value::Null, &Value::Null));
    assert!(text(&load).contains("a final value of 0 has no overshoot, rise or settling time"));
    assert!(refused(&["response", "1/s", "--disturbance", "input"]).contains("--controller"));
}

#[test]
fn positive_feedback_is_negative_feedback_of_the_negative() {
    let closed = lab(&["response", "0.5/(s+1)", "--closed", "--positive"]);
    near(&closed["systems"][0]["final"], 1.0, 1e-12);
    let late = lab(&["response", "0.5exp(-0.3s)/(s+1)", "--closed", "--positive"]);
    near(&late["systems"][0]["final"], 1.0, 1e-12);
    let (positive, negative) = (lab(&["nyquist", "2/(s+1)", "--positive"]), lab(&["nyquist", "-2/(s+1)"]));
    for key in ["margins", "closed_unstable", "values"] {
        assert_eq!(positive["systems"][0][key], negative["systems"][0][key], "{key}");
    }
    let locus = lab(&["locus", "1/(s(s+1))", "--positive"]);
    near(&locus["systems"][0]["closed_poles"][0][0], 0.5 * (5.0_f64.sqrt() - 1.0), 1e-12);
    assert!(refused(&["response", "1/s", "--positive"]).contains("--closed"));
}

#[test]
fn margins_of_a_closed_loop_are_those_of_the_loop_it_closes() {
    let open = lab(&["nyquist", "K11 G11"])["systems"][0]["margins"].clone();
    for command in ["nyquist", "nichols"] {
        let closed = lab(&[command, "K11 G11", "--closed"]);
        assert_eq!(closed["systems"][0]["margins"], open, "{command}");
        assert!(
            text(&[command, "K11 G11", "--closed"])
                .contains("the margins are those of the loop it closes, K11 G11")
        );
    }
}

#[test]
fn norms_are_told_or_why_there_is_none() {
    for (formula, words) in [
        ("2/(s^2+0.1s+1)", "H∞ norm         26.03 dB (factor 20.03) at 0.9975 rad/s (0.1588 Hz)"),
        ("1/s", "H∞ norm         infinite: a pole is on the edge of stability"),
        ("1/(s-1)", "H∞ norm         none: it is not stable"),
        ("s", "H∞ norm         infinite: its gain rises with the frequency"),
        // √(b²/(2 a)) of b/(s + a)
        ("6/(s+2)", "H2 norm         3\n"),
    ] {
        let told = text(&["bode", formula]);
        assert!(told.contains(words), "{formula}: {told}");
    }
}

/// At the frequency of the pre-warp the sampled system is the continuous one: |1/(1 + 10 j)|.
#[test]
fn a_prewarped_system_keeps_its_value_at_one_frequency() {
    let line = [
        "bode", "1/(s+1)", "--sample", "100ms", "--method", "tustin", "--from", "10rad/s", "--to", "20rad/s",
    ];
    let warped = lab(&[&line[..], &["--prewarp", "10rad/s"]].concat());
    near(&warped["systems"][0]["magnitude_db"][0], -10.0 * 101_f64.log10(), 1e-9);
    near(&warped["systems"][0]["phase_deg"][0], -10_f64.atan().to_degrees(), 1e-9);
    let plain = lab(&line)["systems"][0]["magnitude_db"][0].as_f64().unwrap();
    assert!((plain + 10.0 * 101_f64.log10()).abs() > 0.1, "{plain}");
    let other = ["bode", "1/(s+1)", "--sample", "100ms", "--prewarp", "10rad/s"];
    assert!(refused(&other).contains("--prewarp is of --method tustin"));
}
