//! Runs that end on their way are gone on with, and none takes the place of another.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;

use crate::support::{folder, json, program, root};

/// The program in a folder of its own, with a picture in it.
fn within(dir: &Path) -> Command {
    let picture = dir.join("house.png");
    if !picture.exists() {
        fs::copy(root().join("examples/house.png"), picture).unwrap();
    }
    let mut command = program();
    command.current_dir(dir);
    command
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn runs(dir: &Path) -> Vec<Value> {
    let listed = json(&within(dir).args(["runs", "--json"]).output().unwrap());
    listed["runs"].as_array().unwrap().clone()
}

/// Traces and kills it once the stroke is begun; how far it was told to be then, s.
fn killed(dir: &Path, arguments: &[&str], stroke: u64) -> f64 {
    let mut command = within(dir);
    command.args(arguments).args(["--events", "--real-time", "8"]);
    let mut child =
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    let mut told_s = 0.0_f64;
    for line in BufReader::new(child.stdout.take().unwrap()).lines() {
        let event: Value = serde_json::from_str(&line.unwrap()).unwrap();
        told_s = event["plan_s"].as_f64().unwrap_or(told_s);
        if event["event"] == "stroke" && event["stroke"] == stroke {
            break;
        }
    }
    child.kill().unwrap();
    child.wait().unwrap();
    told_s
}

#[test]
fn a_killed_run_is_gone_on_with_again_and_again() {
    let dir = folder("resume");
    let told_s = killed(&dir, &["trace", "house.png", "--width", "50cm"], 2);
    let listed = runs(&dir);
    assert_eq!(listed.len(), 1);
    let progress = &listed[0]["progress"];
    assert!(listed[0]["finished"] == false && progress["stroke"] == 2, "{listed:#?}");
    assert!(progress["plan_s"].as_f64().unwrap() >= told_s, "{progress} {told_s}");
    let whole_m = listed[0]["length_m"].as_f64().unwrap();
    let text = String::from_utf8(within(&dir).arg("runs").output().unwrap().stdout).unwrap();
    assert!(text.contains("killed") && text.contains("1 run not finished: tracelight resume"), "{text}");
    // the rest is killed too
    killed(&dir, &["resume", "out/house"], 2);
    let output = within(&dir).args(["resume", "out/house-2", "--json"]).output().unwrap();
    let summary = json(&output);
    assert!(summary["run"]["finished"] == true && summary["target"]["width_m"] == 0.5, "{summary}");
    let (left_m, left) =
        (summary["strokes"]["length_m"].as_f64().unwrap(), summary["strokes"]["count"].as_u64().unwrap());
    assert!(left_m > 0.0 && left_m < whole_m && left < listed[0]["strokes"].as_u64().unwrap(), "{summary}");
    let page = fs::read_to_string(dir.join("out/house-3/report.html")).unwrap();
    assert!(page.contains("goes on with"), "the report says that it is the rest of another");
    let listed = runs(&dir);
    let far: Vec<_> =
        listed.iter().map(|run| (run["folder"].as_str().unwrap(), run["finished"] == true)).collect();
    assert_eq!(far, [("out/house", false), ("out/house-2", false), ("out/house-3", true)]);
    let text = String::from_utf8(within(&dir).arg("runs").output().unwrap().stdout).unwrap();
    assert!(text.contains("500 × ") && text.contains("went on in out/house-3"), "{text}");
    assert!(!text.contains("not finished") && text.contains("simulated"), "{text}");
}

#[test]
fn what_cannot_be_gone_on_with_is_told() {
    let dir = folder("resume-refused");
    let refused = |arguments: &[&str], status: i32, why: &str| {
        let output = within(&dir).args(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(status), "{arguments:?}: {}", said(&output));
        assert!(said(&output).contains(why), "{arguments:?}: {}", said(&output));
    };
    refused(&["resume", "out/house"], 2, "is no folder of a run");
    json(&within(&dir).args(["trace", "house.png", "--json"]).output().unwrap());
    let output = within(&dir).args(["resume", "out/house"]).output().unwrap();
    assert!(output.status.success() && String::from_utf8_lossy(&output.stdout).contains("nothing is left"));
    killed(&dir, &["trace", "house.png"], 2);
    let picture = dir.join("house.png");
    let old = fs::read(&picture).unwrap();
    fs::copy(root().join("examples/star.png"), &picture).unwrap();
    refused(&["resume", "out/house-2"], 2, "it has changed since");
    fs::write(&picture, old).unwrap();
    let job = fs::read_to_string(dir.join("out/house-2/job.toml")).unwrap();
    fs::write(dir.join("out/house-2/job.toml"), &job[..job.len() / 2]).unwrap();
    refused(&["resume", "out/house-2"], 2, "damaged");
    let other = job.replace("\"house.png\"", "\"house.png\", \"--width\", \"40cm\"");
    fs::write(dir.join("out/house-2/job.toml"), other).unwrap();
    refused(&["resume", "out/house-2"], 1, "other strokes");
    // no refusal has made a folder
    assert!(!dir.join("out/house-3").exists());
}

#[test]
fn a_folder_that_is_there_stays_as_it_is() {
    let dir = folder("resume-numbers");
    let trace = || json(&within(&dir).args(["trace", "house.png", "--dry-run", "--json"]).output().unwrap());
    trace();
    let first = fs::read(dir.join("out/house/report.html")).unwrap();
    trace();
    trace();
    assert_eq!(fs::read(dir.join("out/house/report.html")).unwrap(), first);
    assert!(
        ["house-2", "house-3"].iter().all(|name| dir.join("out").join(name).join("summary.json").is_file())
    );
    // as it was asked for
    let told = ["trace", "house.png", "--dry-run", "--out", "out/house"];
    assert!(within(&dir).args(told).output().unwrap().status.success());
    assert!(!dir.join("out/house-4").exists());
}

#[test]
fn two_runs_are_compared_by_what_they_were_asked_and_how_they_came_out() {
    let dir = folder("compared");
    for (out, speed) in [("slow", "--speed=0.5ft/s"), ("fast", "--speed=1ft/s")] {
        let traced =
            within(&dir).args(["trace", "house.png", speed, "--out", out, "--quiet"]).output().unwrap();
        assert!(traced.status.success(), "{}", said(&traced));
    }
    let compared = json(&within(&dir).args(["compare", "slow", "fast", "--json"]).output().unwrap());
    assert_eq!(compared["same_drawing"], true);
    assert_eq!(compared["only_first_asked"], serde_json::json!(["--speed=0.5ft/s"]));
    assert_eq!(compared["only_second_asked"], serde_json::json!(["--speed=1ft/s"]));
    let figure = |name: &str| {
        let all = compared["figures"].as_array().unwrap();
        let found = all.iter().find(|figure| figure["name"] == name).unwrap();
        ["first", "second", "difference"].map(|of| found[of].as_f64().unwrap())
    };
    let [slow_s, fast_s, difference_s] = figure("time");
    assert!(difference_s < -5.0 && (fast_s - slow_s - difference_s).abs() < 1e-9, "{slow_s} {fast_s}");
    assert!(figure("width")[2] == 0.0 && figure("error, rms")[0] > 0.0);
    let told = within(&dir).args(["compare", "slow", "fast"]).output().unwrap();
    let text = String::from_utf8_lossy(&told.stdout).into_owned();
    assert!(text.contains("only slow was asked: --speed=0.5ft/s"), "{text}");
    let none = within(&dir).args(["compare", "slow", "."]).output().unwrap();
    assert!(said(&none).contains("is no folder of a run"), "{}", said(&none));
}
