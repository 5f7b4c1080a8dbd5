//! Somebody at the wall: keys in a terminal, and what the program tells while a job runs.

use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::support::{folder, program, rows, run};

/// After this long a program that does not tell what is awaited is ended, so that the test fails instead of waiting.
const LONGEST: Duration = Duration::from_secs(180);

/// A program with a terminal of its own as standard input, whose events are read.
pub(crate) struct Terminal {
    keyboard: File,
    pub(crate) child: Child,
    told: Receiver<String>,
    seen: Vec<String>,
    until: Instant,
}

impl Terminal {
    pub(crate) fn of(mut command: Command) -> Self {
        let pty = nix::pty::openpty(None, None).unwrap();
        let mut child = command
            .stdin(File::from(pty.slave))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let (tell, told) = channel();
        let lines = BufReader::new(child.stdout.take().unwrap()).lines();
        std::thread::spawn(move || lines.map_while(Result::ok).try_for_each(|line| tell.send(line)));
        Self {
            keyboard: File::from(pty.master),
            child,
            told,
            seen: Vec::new(),
            until: Instant::now() + LONGEST,
        }
    }

    pub(crate) fn press(&mut self, keys: &str) {
        self.keyboard.write_all(keys.as_bytes()).unwrap();
    }

    /// Reads on to an event that is wanted.
    pub(crate) fn until(&mut self, wanted: impl Fn(&Value) -> bool) -> Value {
        while let Ok(line) = self.told.recv_timeout(self.until.saturating_duration_since(Instant::now())) {
            let event: Value = serde_json::from_str(&line).unwrap();
            // of progress there are hundreds
            if event["event"] != "progress" {
                self.seen.push(line);
            }
            if wanted(&event) {
                return event;
            }
        }
        self.child.kill().ok();
        panic!("what is awaited was not told within {LONGEST:?}:\n{}", self.seen.join("\n"));
    }

    pub(crate) fn until_state(&mut self, state: &str) {
        self.until(|event| event["event"] == "state" && event["to"] == state);
    }
}

/// Light fell on its strokes, and beside where it belonged at that time by no more than a head that sets off again.
fn assert_light(summary: &Value) {
    let error = |name: &str| summary["summary"]["tracking"][name].as_f64().unwrap();
    assert!(error("off_stroke_max_mm") < 0.3 && error("max_mm") < 1.0, "{summary}");
}

fn traced(out: &Path) -> Command {
    let mut command = program();
    command.args(["trace", "examples/house.png", "--events", "--real-time", "8", "--out"]).arg(out);
    command
}

#[test]
fn keys_pause_and_stop_a_job_and_let_it_go_on() {
    let dir = folder("keys");
    let mut wall = Terminal::of(traced(&dir));
    wall.until(|event| event["event"] == "stroke" && event["stroke"] == 2);
    wall.press("-");
    wall.until(|event| event["event"] == "progress" && event["speed"] == 0.75);
    wall.press("=p");
    wall.until_state("paused");
    // in the dark, and its clock stands
    let one = wall.until(|event| event["event"] == "progress");
    let other = wall.until(|event| event["event"] == "progress");
    assert!(one["gate"] == false && one["plan_s"] == other["plan_s"], "{one} {other}");
    wall.press(" ");
    wall.until_state("tracing");
    wall.press(" ");
    wall.until_state("pausing");
    wall.until_state("paused");
    wall.press(" ");
    wall.until_state("tracing");
    wall.press("\x1b");
    wall.until_state("stopped");
    // light again needs two acts
    wall.press("\r");
    wall.until(|event| {
        event["event"] == "refused" && event["message"].as_str().unwrap().contains("arm first")
    });
    wall.press("a\r");
    wall.until_state("tracing");
    wall.until_state("done");
    let summary = wall.until(|event| event["event"] == "summary");
    assert_light(&summary);
    assert_eq!(wall.child.wait().unwrap().code(), Some(0));
    let report = std::fs::read_to_string(dir.join("report.html")).unwrap();
    assert!(
        ["paused after", "stopped after", "at 75 % of the planned speed"]
            .iter()
            .all(|note| report.contains(note)),
        "the report tells of them"
    );
}

#[test]
fn strokes_are_drawn_one_at_a_time_until_a_key_asks_for_the_next() {
    let dir = folder("steps");
    let mut command = program();
    command
        .args(["trace", "examples/house.png", "--step", "--events", "--real-time", "8", "--out"])
        .arg(&dir);
    let mut wall = Terminal::of(command);
    let began = |wall: &mut Terminal, number: u64| {
        let event = wall.until(|event| event["event"] == "stroke" && event["stroke"] == number);
        assert_eq!(event["strokes"], 28);
    };
    for number in 1..=28 {
        began(&mut wall, number);
        // again and again
        wall.until(|event| event["event"] == "progress" && event["laps"].as_u64() >= Some(1));
        if number == 3 {
            // back, forth, and past one that is not done
            wall.press("\x1b[D");
            began(&mut wall, 2);
            wall.press("\x1b[C");
            began(&mut wall, 3);
            wall.press("p");
            wall.until_state("paused");
            wall.press(" ");
            wall.until_state("stepping");
            // stopped on the way to the next one, or just after it began: it goes on when somebody arms
            wall.press("\x1b[D");
            wall.until_state("parking");
            wall.press("\x1b");
            wall.until(|event| event["to"] == "ready" || event["to"] == "stopped");
            wall.press("a");
            wall.until_state("armed");
            wall.press("\r");
            wall.until_state("stepping");
            wall.press("\x1b[C");
            began(&mut wall, 3);
        }
        wall.press(if number == 3 { "s" } else { " " });
        let left = wall.until(|event| event["event"] == "left");
        assert!(left["stroke"] == number && left["done"] == (number != 3), "{left}");
    }
    let summary = wall.until(|event| event["event"] == "summary");
    assert_eq!(wall.child.wait().unwrap().code(), Some(0), "{summary}");
    assert!(summary["summary"]["run"]["finished"] == true, "{summary}");
    let report = std::fs::read_to_string(dir.join("report.html")).unwrap();
    assert!(report.contains("27 of 28 strokes done; not 3"), "the report tells of it");
    assert_light(&summary);
}

/// A wall of 1.5 × 1 m with twelve sockets, each a block, and a nail.
fn sockets() -> String {
    let pairs = |text: &str| text.replace(", ", "\n").replace(' ', "\n") + "\n";
    let mut dxf = pairs(
        "0 SECTION, 2 HEADER, 9 $INSUNITS, 70 4, 0 ENDSEC, 0 SECTION, 2 BLOCKS, 0 BLOCK, 2 Socket, 10 5, 20 0",
    ) + &pairs("0 CIRCLE, 8 0, 10 5, 20 0, 40 30, 0 ENDBLK, 0 ENDSEC, 0 SECTION, 2 ENTITIES");
    for (x, y) in [100, 500, 900].into_iter().flat_map(|y| [150, 550, 950, 1350].map(|x| (x, y))) {
        dxf += &pairs(&format!("0 INSERT, 8 SOCKETS, 2 Socket, 10 {x}, 20 {y}"));
    }
    dxf += &pairs(
        "0 LWPOLYLINE, 8 WALL, 90 4, 70 1, 10 0, 20 0, 10 1500, 20 0, 10 1500, 20 1000, 10 0, 20 1000",
    );
    dxf + &pairs("0 POINT, 8 NAILS, 10 750, 20 750, 0 ENDSEC, 0 EOF")
}

/// The points of that wall, with more flags.
fn at_the_sockets(dir: &Path, flags: &[&str]) -> Terminal {
    let drawing = dir.with_extension("dxf");
    std::fs::write(&drawing, sockets()).unwrap();
    let mut command = program();
    command
        .arg("trace")
        .arg(&drawing)
        .args(["--points=block,point", "--distance", "3m", "--events", "--real-time", "8", "--out"])
        .arg(dir)
        .args(flags);
    Terminal::of(command)
}

/// How many points are ticked off in the table of a run under way.
fn ticked_off(dir: &Path) -> usize {
    let Ok(table) = std::fs::read_to_string(dir.join("points.csv")) else { return 0 };
    table.lines().skip(1).filter(|row| !row.ends_with(',')).count()
}

/// Reads on until a point was marked once, at least.
fn marked_once(wall: &mut Terminal) {
    wall.until_state("pointing");
    wall.until(|event| event["event"] == "progress" && event["laps"].as_u64() >= Some(1));
}

fn left_point(wall: &mut Terminal, number: u64, done: bool) {
    let left = wall.until(|event| event["event"] == "left");
    assert!(left["point"] == number && left["done"] == done, "{left}");
}

#[test]
fn points_are_ticked_off_one_after_the_other() {
    let dir = folder("points");
    let mut wall = at_the_sockets(&dir, &[]);
    for number in 1..=13 {
        let point = wall.until(|event| event["event"] == "point");
        assert!(point["point"] == number && point["points"] == 13, "{point}");
        marked_once(&mut wall);
        // kept as they are ticked off, whatever happens to the program
        assert_eq!(ticked_off(&dir), (1..number).filter(|&before| before != 5).count(), "before {number}");
        wall.press(if number == 5 { "s" } else { " " });
        left_point(&mut wall, number, number != 5);
    }
    let summary = wall.until(|event| event["event"] == "summary");
    assert_eq!(wall.child.wait().unwrap().code(), Some(0), "{summary}");
    assert_eq!(summary["summary"]["points"], serde_json::json!({ "count": 13, "done": 12 }));
    assert_light(&summary);
    let mut table = csv::Reader::from_path(dir.join("points.csv")).unwrap();
    let rows: Vec<csv::StringRecord> = table.records().collect::<Result<_, _>>().unwrap();
    let places: Vec<[String; 5]> =
        rows.iter().map(|row| [1, 2, 3, 5, 6].map(|k| row[k].to_owned())).collect();
    // from the top left, about the middle of the wall, and then what lies on another layer
    let mut wanted: Vec<[String; 5]> = Vec::new();
    for (x, y) in [400, 0, -400].into_iter().flat_map(|y| [-600, -200, 200, 600].map(|x| (x, y))) {
        wanted.push(
            ["block", "Socket", "SOCKETS", &format!("{x}.000"), &format!("{y}.000")].map(str::to_owned),
        );
    }
    wanted.push(["point", "", "NAILS", "0.000", "250.000"].map(str::to_owned));
    assert_eq!(places, wanted);
    let done: Vec<Option<f64>> = rows.iter().map(|row| row[7].parse().ok()).collect();
    assert!(done[4].is_none() && done.iter().flatten().is_sorted() && done.iter().flatten().count() == 12);
}

#[test]
fn the_rest_of_the_points_keeps_its_numbers_and_what_was_not_lit_is_not_done() {
    let dir = folder("points-rest");
    let mut wall = at_the_sockets(&dir, &["--from-stroke", "11", "--no-go=-70cm,-50cm,30cm,30cm"]);
    let checks = wall.until(|event| event["event"] == "preflight")["checks"].clone();
    let no_go = checks.as_array().unwrap().iter().find(|check| check["name"] == "no-go").unwrap();
    assert!(no_go["words"].as_str().unwrap().contains("in 1 no-go area"), "{no_go}");
    let point = wall.until(|event| event["event"] == "point");
    assert!(point["point"] == 11 && point["points"] == 12, "{point}");
    wall.press(" ");
    left_point(&mut wall, 11, false);
    marked_once(&mut wall);
    wall.press(" ");
    left_point(&mut wall, 12, true);
    let summary = wall.until(|event| event["event"] == "summary");
    assert_eq!(wall.child.wait().unwrap().code(), Some(0), "{summary}");
    assert_eq!(summary["summary"]["points"], serde_json::json!({ "count": 2, "done": 1 }));
    let table = std::fs::read_to_string(dir.join("points.csv")).unwrap();
    assert!(table.lines().nth(1).unwrap().starts_with("11,block,Socket"), "{table}");
}

#[test]
fn places_that_are_told_are_marked_in_their_order() {
    let dir = folder("told-points");
    let mut command = program();
    command
        .args(["point", "-20cm,-10cm", "90cm,1.2m", "30cm,40cm", "--mark", "dot", "--distance", "2m"])
        .args(["--from", "bottom-left", "--origin", "-70cm,-50cm", "--events", "--real-time", "8", "--out"])
        .arg(&dir);
    let mut wall = Terminal::of(command);
    for (number, at) in (1..).zip([(-900.0, -600.0), (200.0, 700.0), (-400.0, -100.0)]) {
        let point = wall.until(|event| event["event"] == "point");
        assert!(point["point"] == number && point["points"] == 3, "{point}");
        assert!((point["x_mm"].as_f64(), point["y_mm"].as_f64()) == (Some(at.0), Some(at.1)), "{point}");
        marked_once(&mut wall);
        wall.press(if number == 2 { "s" } else { " " });
        left_point(&mut wall, number, number != 2);
    }
    let summary = wall.until(|event| event["event"] == "summary");
    assert_eq!(wall.child.wait().unwrap().code(), Some(0), "{summary}");
    assert_eq!(summary["summary"]["points"], serde_json::json!({ "count": 3, "done": 2 }));
    assert_light(&summary);
    let listed = run(&["runs", dir.parent().unwrap().to_str().unwrap(), "--json"]);
    let listed: Value = serde_json::from_slice(&listed.stdout).unwrap();
    let own = listed["runs"].as_array().unwrap().iter().find(|run| run["folder"] == dir.to_str().unwrap());
    assert_eq!(own.unwrap()["points"], serde_json::json!({ "count": 3, "done": 2 }), "{listed}");
}

#[test]
fn a_frame_is_drawn_until_a_key_begins_the_drawing() {
    let framed = |dir: &Path, frame: &str| {
        let mut command = traced(dir);
        command.args(["--frame", frame]);
        let mut wall = Terminal::of(command);
        let checks = wall.until(|event| event["event"] == "preflight")["checks"].clone();
        assert!(checks.as_array().unwrap().iter().any(|check| check["name"] == "homed"), "{checks}");
        wall.until_state("framing");
        wall.until(|event| event["event"] == "progress" && event["laps"].as_u64() >= Some(1));
        wall
    };
    let dir = folder("frame");
    let mut wall = framed(&dir, "hull");
    wall.press(" ");
    wall.until(|event| event["event"] == "frame" && event["on"] == false);
    wall.until_state("tracing");
    let summary = wall.until(|event| event["event"] == "summary");
    assert_eq!(wall.child.wait().unwrap().code(), Some(0), "{summary}");
    // what is told is of the drawing alone
    let run_s = summary["summary"]["run"]["duration_s"].as_f64().unwrap();
    let plan_s = summary["summary"]["plan"]["duration_s"].as_f64().unwrap();
    assert!((run_s - plan_s).abs() < 0.05 && summary["summary"]["strokes"]["count"] == 28, "{summary}");
    // killed while the frame is drawn, nothing of the drawing is done
    let dir = folder("frame-killed");
    let mut wall = framed(&dir, "corners");
    wall.child.kill().unwrap();
    wall.child.wait().unwrap();
    let rest = folder("frame-rest");
    let output = program().arg("resume").arg(&dir).arg("--out").arg(&rest).arg("--json").output().unwrap();
    let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(summary["strokes"]["count"], 28, "{summary}");
    // stopped there, it may be ended
    let mut wall = framed(&folder("frame-ended"), "box");
    wall.press("\x1b");
    wall.until_state("stopped");
    wall.press("q");
    wall.until(|event| event["event"] == "summary");
    assert_eq!(wall.child.wait().unwrap().code(), Some(130));
}

#[test]
fn who_cannot_press_a_key_is_told_that_step_needs_one() {
    let output = run(&["trace", "examples/star.png", "--step"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("standard input is no terminal"));
}

#[test]
fn the_first_ctrl_c_pauses_and_the_second_ends() {
    let dir = folder("ctrl-c");
    let mut wall = Terminal::of(traced(&dir));
    wall.until(|event| event["event"] == "stroke" && event["stroke"] == 2);
    wall.press("\x03");
    wall.until_state("paused");
    wall.press("\x03");
    wall.until_state("stopped");
    assert_eq!(wall.child.wait().unwrap().code(), Some(130));
    assert!(!rows(&dir).last().unwrap().lit, "the last tick is dark");
}

#[test]
fn without_a_terminal_a_paced_job_runs_to_its_end_and_events_need_no_pace() {
    let dir = folder("events");
    let out = dir.to_string_lossy().into_owned();
    let output = run(&["trace", "examples/star.png", "--events", "--out", &out]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let events: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let states: Vec<_> =
        events.iter().filter(|e| e["event"] == "state").map(|e| e["to"].as_str().unwrap()).collect();
    assert_eq!(states, ["ready", "armed", "tracing", "done"]);
    assert_eq!(events.last().unwrap()["event"], "summary");
    let wrong = run(&["trace", "examples/star.png", "--real-time", "0.1"]);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&wrong.stderr).contains("between 0.25 and 8"));
}
