//! A board that is emulated behind a wire, by the program: what it draws is what a controller in this process draws, and what becomes of it when the wire is bad.

use std::path::Path;

use serde_json::Value;

use crate::support::{folder, program, run};

const HOUSE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/house.png");
const STAR: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/star.png");

/// Traces a picture into a folder: exit status, what is told as JSON, and to people.
fn traced(picture: &str, out: &Path, flags: &[&str]) -> (i32, Value, String) {
    let mut args = vec!["trace", picture, "--out", out.to_str().unwrap(), "--json"];
    args.extend(flags);
    let output = run(&args);
    let said = String::from_utf8(output.stderr).unwrap();
    (output.status.code().unwrap(), serde_json::from_slice(&output.stdout).unwrap(), said)
}

/// The ticks of a run from its second on: before the first nobody can tell a board that he is there.
fn ticks(out: &Path) -> Vec<String> {
    let table = std::fs::read_to_string(out.join("trace.csv")).unwrap();
    table.lines().skip(2).map(str::to_owned).collect()
}

#[test]
fn behind_a_wire_every_count_volt_and_gate_is_as_in_this_process() {
    let dir = folder("emulated-equal");
    for (rig, emulated) in [("report", "emulated"), ("worn", "emulated:worn")] {
        let (here, there) = (dir.join(format!("{rig}-here")), dir.join(format!("{rig}-there")));
        assert_eq!(traced(HOUSE, &here, &["--rig", rig]).0, 0);
        assert_eq!(traced(HOUSE, &there, &["--rig", emulated]).0, 0);
        let (here, there) = (ticks(&here), ticks(&there));
        assert!(here.len() > 10_000);
        let first = here.iter().zip(&there).find(|(here, there)| here != there);
        assert_eq!((first, here.len()), (None, there.len()), "{rig}");
    }
}

#[test]
fn a_bad_wire_draws_as_well_as_a_good_one() {
    let dir = folder("emulated-bad");
    let flags = ["--rig", "emulated", "--sim-trouble", "link-loss=3%", "--sim-trouble", "link-delay=4ms"];
    let flags =
        [&flags[..], &["--sim-trouble", "link-corrupt=1%", "--sim-trouble", "host-stall=0.3@2"]].concat();
    let (code, answer, said) = traced(STAR, &dir.join("out"), &flags);
    assert_eq!(code, 0, "{said}");
    assert!(answer["tracking"]["max_mm"].as_f64().unwrap() < 0.2, "{answer}");
    assert_eq!(answer["laser"]["faults"][0]["code"], "host-silent", "it was waited for: {answer}");
}

#[test]
fn a_cable_that_is_pulled_ends_the_job_dark_and_the_rest_is_resumed() {
    let dir = folder("emulated-pulled");
    let out = dir.join("out");
    let (code, answer, _) = traced(STAR, &out, &["--rig", "emulated", "--sim-trouble", "unplug=0.4@3"]);
    assert_eq!((code, &answer["error"]["code"]), (1, &Value::from("disarmed")), "{answer}");
    let lit = |out: &Path| {
        let summary = std::fs::read(out.join("summary.json")).unwrap();
        serde_json::from_slice::<Value>(&summary).unwrap()["laser"]["lit_s"].as_f64().unwrap()
    };
    let resumed = run(&["resume", out.to_str().unwrap(), "--json"]);
    assert!(resumed.status.success(), "{}", String::from_utf8_lossy(&resumed.stderr));
    let both_s = lit(&out) + lit(&dir.join("out-2"));
    assert!((5.2..5.4).contains(&both_s), "{both_s} s of light, 5.26 in one go");
}

#[test]
fn what_is_wrong_with_a_wire_needs_one() {
    let dir = folder("emulated-none");
    for (flags, why) in [
        (&["--sim-trouble", "link-loss=1%"][..], "give --rig emulated"),
        (&["--sim-trouble", "head-bump=1@3"], "--camera sim:PICTURE or --rig emulated"),
        (&["--rig", "emulated", "--sim-trouble", "camera-black@3"], "give --camera sim:PICTURE"),
        (&["--rig", "emulated:wron"], "did you mean worn?"),
    ] {
        let (code, answer, _) = traced(STAR, &dir.join("out"), flags);
        let message = answer["error"]["message"].as_str().unwrap();
        assert!(code == 2 && message.contains(why), "{flags:?}: {message}");
    }
}

/// A board of another process, at a pseudo-terminal.
struct Served {
    child: std::process::Child,
    path: String,
}

impl Served {
    fn at(name: &str) -> Self {
        let path = folder(name).join("head").to_str().unwrap().to_owned();
        let child =
            program().args(["rig", "serve", "--pty", &path, "--for", "60s", "--quiet"]).spawn().unwrap();
        let until = std::time::Instant::now() + std::time::Duration::from_secs(10);
        while !Path::new(&path).exists() && std::time::Instant::now() < until {
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
        Self { child, path }
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn the_doctor_says_what_board_is_at_a_port() {
    let board = Served::at("emulated-doctor");
    let seen = run(&["doctor", "--rig", &board.path, "--json"]);
    let told: Value = serde_json::from_slice(&seen.stdout).unwrap();
    assert!(seen.status.success(), "{told}");
    assert_eq!((&told["kind"], &told["segments"]), (&"emulated board".into(), &384.into()), "{told}");
    assert!(told["round_trip_ms"]["median"].as_f64().unwrap() < 100.0, "{told}");
    drop(board);
    let nobody = run(&["doctor", "--rig", "/dev/ttyNONE3", "--json"]);
    let told: Value = serde_json::from_slice(&nobody.stdout).unwrap();
    assert_eq!((nobody.status.code(), &told["error"]["code"]), (Some(2), &"port".into()), "{told}");
}
