//! A job whose light would stand is refused before anything is lit.

use serde_json::Value;

use crate::support::{folder, run};

/// A tenth of a millimetre, and the star a millimetre wide.
const SPOT: &str = "stroke,x_m,y_m\n0,0,0\n0,0.0001,0\n";
const STAR: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/star.png");

/// Exit status and answer.
fn told(output: &std::process::Output) -> (i32, Value) {
    (output.status.code().unwrap(), serde_json::from_slice(&output.stdout).unwrap())
}

#[test]
fn a_spot_that_creeps_is_refused_with_its_place_by_whatever_plans_it() {
    let dir = folder("standing");
    let spot = dir.join("spot.csv").to_str().unwrap().to_owned();
    let out = dir.join("out").to_str().unwrap().to_owned();
    std::fs::write(&spot, SPOT).unwrap();
    let creeps = ["--speed", "0.000001m/s"];
    for command in [&["trace", "--out", &out][..], &["trace", "--dry-run", "--out", &out], &["plan"]] {
        let args = [command, &[spot.as_str(), "--json"], &creeps].concat();
        let (code, answer) = told(&run(&args));
        assert_eq!((code, &answer["error"]["code"]), (1, &"standing-light".into()), "{args:?} {answer}");
        let message = answer["error"]["message"].as_str().unwrap();
        for words in [
            "100.",
            "(0.000, 0.000) m of stroke 1",
            "0.90 s are planned at most",
            "--speed",
            "safety.standing",
        ] {
            assert!(message.contains(words), "{words}: {message}");
        }
    }
    assert!(!dir.join("out/run.mcap").exists());
    let small = ["plan", STAR, "--width", "1mm", "--speed", "0.00004m/s", "--json"];
    assert_eq!(told(&run(&small)).1["error"]["code"], "standing-light");
}

#[test]
fn a_drawings_dots_do_not_stand_with_a_pointer_and_do_with_what_burns() {
    let dir = folder("standing-dots");
    let dots = dir.join("dots.svg").to_str().unwrap().to_owned();
    let circles: String = (0..40)
        .map(|k| {
            format!(
                "<circle cx='{}' cy='{}' r='{}' fill='none' stroke='black'/>",
                5 + 9 * (k % 8),
                5 + 9 * (k / 8),
                0.3
            )
        })
        .collect();
    std::fs::write(&dots, format!("<svg xmlns='http://www.w3.org/2000/svg' width='80mm' height='50mm' viewBox='0 0 80 50'>{circles}</svg>")).unwrap();
    let planned = |rig: &[&str]| told(&run(&[&["plan", &dots, "--width", "80mm", "--json"], rig].concat()));
    let (code, answer) = planned(&[]);
    assert_eq!(code, 0, "{answer}");
    let rig = dir.join("rig.toml").to_str().unwrap().to_owned();
    std::fs::write(&rig, "base = \"report\"\n[laser]\nclass = \"3B\"\npower = \"100mW\"\n").unwrap();
    assert_eq!(planned(&["--rig", &rig]).1["error"]["code"], "standing-light");
}
