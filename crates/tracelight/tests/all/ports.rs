//! A head at a port: an emulated board that another process serves in real time, as a device node.
#![cfg(unix)]

use std::path::PathBuf;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::at_wall::Terminal;
use crate::support::{folder, program};

/// A board that is served until this is dropped.
pub(crate) struct Served {
    board: Child,
    pub(crate) dir: PathBuf,
}

impl Served {
    pub(crate) fn new(name: &str, more: &[&str]) -> Self {
        let dir = folder(name);
        let mut command = program();
        command.args(["rig", "serve", "--quiet", "--pty"]).arg(dir.join("board")).args(more);
        let board = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        let served = Self { board, dir };
        let until = Instant::now() + Duration::from_secs(20);
        while !served.port().exists() {
            assert!(Instant::now() < until, "no board is served");
            std::thread::sleep(Duration::from_millis(5));
        }
        // a line of some centimetres, and one beside it
        std::fs::write(served.dir.join("lines.csv"), LINES).unwrap();
        served
    }

    fn port(&self) -> PathBuf {
        self.dir.join("board")
    }

    fn out(&self, name: &str) -> PathBuf {
        self.dir.join(name)
    }

    fn command(&self, args: &[&str]) -> Command {
        let mut command = program();
        command.args(args).arg("--rig").arg(self.port()).stdin(Stdio::null());
        command
    }

    fn ask(&self, args: &[&str]) -> Output {
        self.command(args).output().unwrap()
    }

    /// Draws the lines into a folder of that name.
    fn trace(&self, out: &str, more: &[&str]) -> Command {
        let mut command = self.command(&["trace"]);
        command.arg(self.dir.join("lines.csv")).args(["--width", "20cm", "--out"]).arg(self.out(out));
        command.args(more);
        command
    }

    /// Waits until a run has told how far it came.
    fn until_on_its_way(&self, out: &str) {
        let progress = self.out(out).join("progress");
        let until = Instant::now() + Duration::from_secs(60);
        while std::fs::metadata(&progress).map_or(0, |file| file.len()) < 20 && Instant::now() < until {
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    fn summary(&self, out: &str) -> Value {
        let text = std::fs::read_to_string(self.out(out).join("summary.json")).unwrap();
        serde_json::from_str(&text).unwrap()
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        self.board.kill().ok();
        self.board.wait().ok();
        std::fs::remove_file(self.port()).ok();
    }
}

const LINES: &str = "stroke,x,y\n0,0,0\n0,0.2,0\n1,0.2,0.05\n1,0,0.05\n";

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{}", text(output)))
}

#[test]
fn a_picture_is_drawn_by_the_head_at_a_port_and_again_by_the_next_program() {
    let served = Served::new("port-trace", &[]);
    for out in ["first", "second"] {
        let ran = served.trace(out, &[]).output().unwrap();
        assert!(ran.status.success(), "{out}: {}", text(&ran));
        let told = text(&ran);
        assert!(told.contains("by the encoders, nobody saw the light"), "{told}");
        // light may have been anywhere before, so the second one waits, unless it comes late by itself
        assert!(out == "second" || !told.contains("it stays dark for"), "{told}");
        let figures = served.summary(out);
        assert_eq!(
            (&figures["simulated"], &figures["light_from"], &figures["run"]["finished"]),
            (&true.into(), &"encoders".into(), &true.into())
        );
        let (rms, lit_s) = (&figures["tracking"]["rms_mm"], &figures["laser"]["lit_s"]);
        assert!(rms.as_f64().unwrap() < 0.05 && lit_s.as_f64().unwrap() > 0.7, "{figures}");
        // a machine that is busy may let its host fall silent for a moment
        let faults = figures["laser"]["faults"].as_array().unwrap();
        assert!(faults.iter().all(|fault| fault["stops"] == false), "{figures}");
        let page = std::fs::read_to_string(served.out(out).join("report.html")).unwrap();
        assert!(page.contains("simulated, by its encoders") && !page.contains("Where the light fell"));
        // the run's own time, not the board's, which has been up for longer than both
        let csv = std::fs::read_to_string(served.out(out).join("trace.csv")).unwrap();
        let first_s: f64 = csv.lines().nth(1).unwrap().split(',').next().unwrap().parse().unwrap();
        assert!(first_s < 3.0, "{first_s} s");
    }
}

#[test]
fn a_head_that_does_not_know_where_it_points_is_jogged_and_homed_for_the_programs_that_follow() {
    let served = Served::new("port-home", &["--sim-unhomed", "--seed", "3"]);
    let refused = served.trace("unhomed", &[]).output().unwrap();
    assert!(!refused.status.success() && text(&refused).contains("tracelight home"), "{}", text(&refused));
    assert!(!served.out("unhomed").exists(), "nothing is written of a run that cannot begin");
    let nowhere = served.ask(&["home", "--at", "300deg,0deg"]);
    assert!(text(&nowhere).contains("out of its range of"), "{}", text(&nowhere));
    for (args, why) in [
        (["jog", "10cm,0cm"], "nobody knows where on the target it points"),
        (["jog", "31deg,0deg"], "at most 30"),
    ] {
        let refused = served.ask(&args);
        assert!(!refused.status.success() && text(&refused).contains(why), "{}", text(&refused));
    }
    let jogged = json(&served.ask(&["jog", "-4deg,3deg", "--dot", "300ms", "--json"]));
    assert!(jogged["homed"] == false && jogged["spot_mm"] == Value::Null, "{jogged}");
    assert!((jogged["pan_deg"].as_f64().unwrap() + 4.0).abs() < 0.1, "{jogged}");
    let open_s = jogged["gate_open_s"].as_f64().unwrap();
    assert!((0.25..0.35).contains(&open_s), "{jogged}");
    let homed = json(&served.ask(&["home", "--at", "10deg,-5deg", "--json"]));
    assert!(homed["homed"] == true && homed["simulated"] == true, "{homed}");
    assert!((homed["pan_deg"].as_f64().unwrap() - 10.0).abs() < 0.1, "{homed}");
    // that is known to the next programs, at once, and also with another law
    for _ in 0..4 {
        let there = json(&served.ask(&["jog", "0deg,0deg", "--json"]));
        assert!(there["homed"] == true && (there["pan_deg"].as_f64().unwrap() - 10.0).abs() < 0.2, "{there}");
    }
    let moved = json(&served.ask(&["jog", "--to", "10cm,5cm", "--json"]));
    let spot = |at: usize| moved["spot_mm"][at].as_f64().unwrap();
    assert!((spot(0) - 100.0).abs() < 0.5 && (spot(1) - 50.0).abs() < 0.5, "{moved}");
    let dot = served.ask(&["jog", "1cm,0cm", "--dot", "1s"]);
    assert!(text(&dot).contains("tracelight point 100."), "{}", text(&dot));
    let traced = served.trace("homed", &["--law", "pid-ff"]).output().unwrap();
    assert!(traced.status.success(), "{}", text(&traced));
    let parked = json(&served.ask(&["park", "--json"]));
    assert!(parked["pan_deg"].as_f64().unwrap().abs() < 0.1, "{parked}");
}

#[test]
fn a_head_that_was_just_powered_up_homes_itself_by_its_end_stops() {
    let rig = folder("port-stops-rig").join("narrow.toml");
    let ranges = [
        "pan.range_min = \"-3deg\"",
        "pan.range_max = \"4deg\"",
        "tilt.range_min = \"-3deg\"",
        "tilt.range_max = \"3deg\"",
    ];
    let told = |stops: &str| {
        format!("base = \"report\"\nname = \"narrow\"\n[model]\n{}\n{stops}", ranges.join("\n"))
    };
    std::fs::write(&rig, told("")).unwrap();
    let served = Served::new("port-stops", &["--sim-unhomed", "--seed", "5", "--rig", rig.to_str().unwrap()]);
    let port = format!("{}:{}", served.port().display(), rig.display());
    let home = |how: &str| program().args(["home", how, "--json", "--rig", &port]).output().unwrap();
    let unknown = home("--by-stops");
    assert!(!unknown.status.success() && text(&unknown).contains("--find-stops"), "{}", text(&unknown));
    let stops = |pan_max: &str| {
        format!(
            "[homing]\npan_stop_min = \"-4deg\"\npan_stop_max = \"{pan_max}\"\ntilt_stop_min = \"-4deg\"\ntilt_stop_max = \"4deg\"\n"
        )
    };
    std::fs::write(&rig, told(&stops("3.9deg"))).unwrap();
    let within = home("--by-stops");
    assert!(text(&within).contains("model.pan.range_max must end before it"), "{}", text(&within));
    std::fs::write(&rig, told(&stops("5deg"))).unwrap();
    let homed = json(&home("--by-stops"));
    assert!(homed["homed"] == true && homed["pan_deg"].as_f64().unwrap().abs() < 0.1, "{homed}");
    let found = json(&home("--find-stops"));
    for (joint, ends) in [("pan", [-4.0, 5.0]), ("tilt", [-4.0, 4.0])] {
        for (at, end) in ends.into_iter().enumerate() {
            let stop = found["stops_deg"][joint][at].as_f64().unwrap();
            assert!((stop - end).abs() < 0.15, "{found}");
        }
    }
}

#[test]
fn a_program_that_is_killed_leaves_the_head_dark_and_the_rest_to_resume() {
    let served = Served::new("port-killed", &[]);
    let mut killed = served.trace("killed", &["--speed", "10cm/s"]).stdout(Stdio::null()).spawn().unwrap();
    served.until_on_its_way("killed");
    std::thread::sleep(Duration::from_millis(1500));
    killed.kill().unwrap();
    killed.wait().unwrap();
    let out = served.out("killed");
    let rest = program().args(["resume"]).arg(&out).stdin(Stdio::null()).output().unwrap();
    assert!(rest.status.success(), "{}", text(&rest));
    let figures = served.summary("killed-2");
    assert!(figures["run"]["finished"] == true && figures["light_from"] == "encoders", "{figures}");
}

#[test]
fn who_is_interrupted_ends_dark_and_is_gone_on_with() {
    let served = Served::new("port-interrupted", &[]);
    let mut traced = served.trace("interrupted", &["--speed", "5cm/s"]);
    let child = traced.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    served.until_on_its_way("interrupted");
    std::thread::sleep(Duration::from_millis(2500));
    let pid = nix::unistd::Pid::from_raw(child.id().cast_signed());
    // a signal that means nothing here is no broken line either
    nix::sys::signal::kill(pid, nix::sys::signal::Signal::SIGWINCH).unwrap();
    std::thread::sleep(Duration::from_millis(300));
    nix::sys::signal::kill(pid, nix::sys::signal::Signal::SIGINT).unwrap();
    let ended = child.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(130), "{}", text(&ended));
    let figures = served.summary("interrupted");
    assert!(
        figures["run"]["finished"] == false && figures["laser"]["lit_s"].as_f64().unwrap() > 0.3,
        "{figures}"
    );
    let rest = program().arg("resume").arg(served.out("interrupted")).stdin(Stdio::null()).output().unwrap();
    assert!(rest.status.success(), "{}", text(&rest));
}

#[test]
fn a_real_head_is_lit_only_after_a_person_has_armed_it() {
    let served = Served::new("port-real", &["--sim-real"]);
    // whose head it is has to be said
    let whose = served.trace("whose", &[]).output().unwrap();
    assert!(text(&whose).contains("which head does the board at"), "{}", text(&whose));
    let port = format!("{}:report", served.port().display());
    let lines = served.dir.join("lines.csv");
    let trace = |out: &str, more: &[&str]| {
        let mut command = program();
        command.arg("trace").arg(&lines).args(["--width", "20cm", "--rig", &port, "--out"]);
        command.arg(served.out(out)).args(more).stdin(Stdio::null());
        command
    };
    let alone = trace("alone", &[]).output().unwrap();
    assert!(!alone.status.success() && text(&alone).contains("armed it by a key"), "{}", text(&alone));
    let dry = trace("dry", &["--dry-run"]).output().unwrap();
    assert!(dry.status.success(), "{}", text(&dry));
    assert_eq!(served.summary("dry")["laser"]["lit_s"], 0.0);
    let mut wall = Terminal::of(trace("armed", &["--events"]));
    wall.until(|event| event["event"] == "preflight");
    // Enter alone begins nothing
    wall.press("\r");
    wall.until(|event| event["event"] == "refused");
    let waits = wall.until(|event| event["event"] == "progress");
    assert!(waits["gate"] == false && waits["state"] == "ready", "{waits}");
    wall.press("a");
    wall.until_state("armed");
    wall.press("\r");
    wall.until_state("tracing");
    wall.until_state("done");
    let summary = wall.until(|event| event["event"] == "summary")["summary"].clone();
    assert!(wall.child.wait().unwrap().success());
    assert!(
        summary["run"]["finished"] == true && summary["laser"]["lit_s"].as_f64().unwrap() > 0.7,
        "{summary}"
    );
    // it is a simulation all the same
    assert_eq!((&summary["simulated"], &summary["light_from"]), (&true.into(), &"encoders".into()));
}

#[test]
fn what_a_head_at_a_port_cannot_do_is_told_before_it_moves() {
    let served = Served::new("port-refused", &[]);
    for (flags, why) in [
        (vec!["--laps", "2"], "--laps with --rig"),
        (vec!["--sim-trouble", "unplug=1@1"], "--sim-trouble with --rig"),
        (vec!["--real-time"], "keeps real time by itself"),
        (vec!["--sim-unhomed"], "--sim-unhomed with --rig"),
    ] {
        let refused = served.trace("never", &flags).output().unwrap();
        assert!(!refused.status.success() && text(&refused).contains(why), "{flags:?}: {}", text(&refused));
        assert!(!served.out("never").exists(), "{flags:?}");
    }
    let lab = served.ask(&["lab", "step"]);
    assert!(text(&lab).contains("this command drives no head"), "{}", text(&lab));
    let simulated = program().args(["park", "--rig", "report"]).output().unwrap();
    assert!(text(&simulated).contains("rig serve --pty"), "{}", text(&simulated));
    let none = program().args(["park", "--rig", "/dev/ttyNONE3:worn"]).output().unwrap();
    assert!(text(&none).contains("is the board plugged in?"), "{}", text(&none));
}
