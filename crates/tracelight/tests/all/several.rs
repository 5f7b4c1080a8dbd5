//! Systems of several inputs and outputs, and controllers for several systems, from the command line.

use serde_json::{Value, json};

use crate::support::{folder, lab, near, root, run};

/// Disk margins as python-control's `margin_test.py` and MATLAB's documentation have them; the digits by scipy, the least of σ(D M D⁻¹)
/// over D at 6001 frequencies.
#[test]
fn a_system_of_several_channels_is_taken_as_a_whole() {
    let file = |name: &str| root().join("docs/linear").join(name).display().to_string();
    let [plant, mixing] = ["satellite.toml", "mixing.toml"].map(file);
    let alone = lab(&["sigma", &plant]);
    near(&alone["disk_margins"]["together"]["alpha"], 0.099_751_2, 1e-6);
    assert_eq!((&alone["inputs"], &alone["states"], &alone["minimal"]), (&json!(2), &json!(2), &json!(true)));
    for one in alone["disk_margins"]["each"].as_array().unwrap() {
        near(&one["alpha"], 2.0, 1e-6);
    }
    let dir = folder("sigma");
    let [svg, csv] = ["plot.svg", "table.csv"].map(|name| dir.join(name).to_str().unwrap().to_owned());
    let [p, k] = [format!("P={plant}"), format!("K={mixing}")];
    let both = lab(&["sigma", "P*K", "--with", &p, "--with", &k, "-o", &svg, "-o", &csv]);
    near(&both["disk_margins"]["together"]["alpha"], 0.376_152, 1e-5);
    near(&both["disk_margins"]["together"]["gain_db"]["high"], 3.3, 0.1);
    near(&both["disk_margins"]["together"]["phase_deg"], 21.26, 0.1);
    assert!(std::fs::read_to_string(&svg).unwrap().contains("singular values, dB"));
    assert!(std::fs::read_to_string(&csv).unwrap().starts_with("rad_s,sigma_1_db,sigma_2_db\n"));
    // of one channel it is the gain: the norm is the resonance
    let second = lab(&["sigma", "1/(s^2+0.2s+1)"]);
    near(&second["h_infinity"]["factor"], 1.0 / (0.2 * 0.99_f64.sqrt()), 1e-6);
    near(&second["h_infinity"]["rad_s"], 0.98_f64.sqrt(), 1e-4);
    near(&second["h2"], 2.5_f64.sqrt(), 1e-9);
    for arguments in [&["lab", "bode", &plant][..], &["lab", "bode", "2*P", "--with", &p]] {
        let said = String::from_utf8(run(arguments).stderr).unwrap();
        assert!(said.contains("lab sigma") && said.contains("P11"), "{said}");
    }
}

#[test]
fn hidden_states_of_a_file_are_named() {
    let file = folder("hidden_states").join("hidden.toml").display().to_string();
    let text = "A = [[-1, 0, 0], [0, -2, 0], [0, 0, -3]]\nB = [[1], [0], [1]]\nC = [[1, 1, 0]]\nD = 0\n";
    std::fs::write(&file, text).unwrap();
    let found = lab(&["sigma", &file]);
    assert_eq!((&found["minimal"], &found["minimal_states"]), (&json!(false), &json!(1)));
    assert_eq!(
        (&found["uncontrollable"]["states"], &found["unobservable"]["states"]),
        (&json!([2]), &json!([3]))
    );
    near(&found["h_infinity"]["factor"], 1.0, 1e-9);
}

/// What is designed for one system alone breaks its wish with the others.
#[test]
fn a_controller_for_several_systems_keeps_its_wish_with_each() {
    let line = ["design", "pid", "G22", "--crossover", "10rad/s"];
    let also = ["--also", "0.6*G22", "--also", "2*G22/(0.004s+1)"];
    let least = |set: &Value| {
        let all = set["each"].as_array().unwrap().iter();
        all.map(|one| one["phase_deg"].as_f64().unwrap()).fold(f64::INFINITY, f64::min)
    };
    let found = lab(&[&line[..], &also].concat());
    assert_eq!(found["set"]["each"].as_array().unwrap().len(), 3);
    assert!(least(&found["set"]) >= 55.0 - 1e-3, "{}", found["set"]);
    let alone = lab(&line);
    let k = alone["controller"]["text"].as_str().unwrap().to_owned();
    let tried = lab(&[&["design", "given", &k, "G22"][..], &also].concat());
    assert!(least(&tried["set"]) < 55.0 - 1e-3, "{}", tried["set"]);
    assert!(tried["set"]["worst"]["phase_deg"].is_string(), "{}", tried["set"]);
}
