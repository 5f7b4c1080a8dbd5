//! What holds of every command: its lines fit a terminal of eighty columns, its JSON is one object whose keys have no spaces.

use std::collections::BTreeSet;
use std::path::Path;

use serde_json::Value;
use unicode_width::UnicodeWidthStr;

use crate::ports::Served;
use crate::support::{program, run};

/// A line of every command; `@` is a folder, in which an emulated board is served.
const LINES: &[&str] = &[
    "doctor",
    "rig serve --pty @/pty --for 0.5s",
    "jog 2deg,1deg --rig @/board",
    "home --rig @/board",
    "park --rig @/board",
    "rig share @/board --for 0.2s",
    "stop @/board",
    "watch @/board --for 0.2s",
    "studio --port 0 --no-open --for 0.3s --folder @/studio",
    "rigs",
    "rigs show report",
    "explain",
    "explain rig-file",
    "completions bash",
    "man -o @/man",
    "strokes examples/star.png",
    "strokes examples/star.png examples/house.png",
    "plan examples/star.png",
    "trace examples/star.png --out @/dark --dry-run",
    "trace --camera sim:examples/star.png --out @/seen",
    "runs @",
    "resume @/dark",
    "compare @/dark @/seen",
    "recover @/dark/run.mcap -o @/whole.mcap",
    "calibrate sheet -o @/pages.pdf",
    "calibrate markers --camera sim -o @/camera.toml",
    "calibrate corners --size 2.4m,1.2m --simulate -o @/corners.toml",
    "calibrate head --camera sim -o @/head.toml",
    "calibrate look --camera sim -o @/wall.jpg",
    "calibrate show @/camera.toml @/corners.toml",
    "calibrate ruler examples/ruler-upright.png examples/ruler-level.png --marks 4in --wish 3ft,3ft",
    "lab amplifier --out @/amplifier",
    "lab backlash --rig worn --axis pan --out @/backlash",
    "lab bode G11",
    "lab bode K11*G11 --closed",
    "lab design pid G11 --crossover 60rad/s --phase-margin 55deg",
    "lab design lead-lag G11 --crossover 60rad/s --phase-margin 55deg",
    "lab design lqg G11",
    "lab design place G11 --poles -10,-11",
    "lab design pid 1/(10s+1) --type pi --crossover 0.3rad/s",
    "lab design pid G11 --sample 1ms --crossover 40rad/s --overshoot 10 --try pan --to 20deg",
    "lab design lqr G11 --q 1000,1",
    "lab design lqr G11 --most y=0.02 --most-input 0.6 --integral 0.01",
    "lab encoder --rig worn --out @/encoder",
    "lab frequency --axis tilt",
    "lab friction --fixture --most 2V --step 1V --out @/friction",
    "lab gang G11 --controller K11",
    "lab gravity --most 2V --step 0.25V --out @/gravity",
    "lab identify --rig worn --out @/identify",
    "lab inertia --fixture --most 2V --step 1V --hold 2s --out @/inertia",
    "lab lesson",
    "lab lesson 1",
    "lab lesson 1 --answer kp=10,sticks=4",
    "lab linearize",
    "lab linearize --rig report",
    "lab locus K11*G11",
    "lab pzmap G11",
    "lab sigma docs/linear/satellite.toml",
    "lab sigma P*K --with P=docs/linear/satellite.toml --with K=docs/linear/mixing.toml",
    "lab design given K11t G11 --also 0.8*G11 --also 1.2*G11",
    "lab nyquist K11*G11",
    "lab nichols K11*G11",
    "lab response G11",
    "lab montecarlo --plants 4 --shape line",
    "point 10cm,20cm -10cm,5cm --each 1s --out @/point",
    "lab move arc",
    "lab move line",
    "lab profile --distance 180deg",
    "lab relay --axis tilt",
    "lab simulate --random --law state,report-pd",
    "lab step --law state,report-zpk,pid,pid-ff",
    "lab step --gains kp=20,kd=1.5",
    "lab tune --plants 2",
    "lab velocity --speeds 0.1ft/s,1ft/s",
];

/// Commands that no line is of: a lens wants photographs from several sides, and the book is all other commands again.
const LEFT_OUT: [&str; 3] = ["calibrate lens", "lab reproduce", "help"];

fn words(line: &str, dir: &Path) -> Vec<String> {
    line.split(' ').map(|word| word.replace('@', dir.to_str().unwrap())).collect()
}

/// Commands below one, as its help lists them.
fn below(command: &str) -> Vec<String> {
    let line: Vec<&str> = command.split_whitespace().chain(["-h"]).collect();
    let help = String::from_utf8(run(&line).stdout).unwrap();
    let Some((_, list)) = help.split_once("\nCommands:\n") else { return vec![command.to_owned()] };
    let rows = list.lines().take_while(|row| !row.is_empty()).filter(|row| !row.starts_with("   "));
    let names = rows.filter_map(|row| row.split_whitespace().next()).filter(|name| *name != "help");
    names.flat_map(|name| below(format!("{command} {name}").trim())).collect()
}

#[test]
fn no_command_is_left_out() {
    for command in below("") {
        let is_run = LINES.iter().any(|line| format!("{line} ").starts_with(&format!("{command} ")));
        let is_left_out = LEFT_OUT.contains(&command.as_str());
        // of a command with commands below it that may also stand alone
        let is_below = command.ends_with("show");
        assert!(is_run || is_left_out || is_below, "no line of {command:?}");
    }
}

#[test]
fn what_a_command_prints_fits_eighty_columns() {
    const COLUMNS: usize = 80;
    let served = Served::new("eighty", &["--sim-unhomed"]);
    let dir = &served.dir;
    let mut wide = Vec::new();
    // what becomes a file keeps its lines
    for line in LINES.iter().filter(|line| !line.starts_with("completions") && !line.starts_with("rigs show"))
    {
        let output = program().args(words(line, dir)).env("COLUMNS", COLUMNS.to_string()).output().unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(!text.is_empty(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
        // a path is as long as it is
        let rows = text.lines().filter(|row| !row.contains(dir.to_str().unwrap()));
        wide.extend(rows.filter(|row| row.width() > COLUMNS).map(|row| format!("{line}: {row}")));
    }
    assert!(wide.is_empty(), "{}", wide.join("\n"));
}

/// Keys of an object and all below it.
fn keys(value: &Value, into: &mut BTreeSet<String>) {
    match value {
        Value::Object(object) => object.iter().for_each(|(key, value)| {
            into.insert(key.clone());
            keys(value, into);
        }),
        Value::Array(all) => all.iter().for_each(|value| keys(value, into)),
        _ => {}
    }
}

#[test]
fn every_answer_is_one_object_whose_keys_have_no_spaces() {
    let served = Served::new("objects", &["--sim-unhomed"]);
    let dir = &served.dir;
    for line in LINES {
        let output = program().args(words(line, dir)).arg("--json").output().unwrap();
        let object: Value = serde_json::from_slice(&output.stdout)
            .unwrap_or_else(|e| panic!("{line}: {e}: {}", String::from_utf8_lossy(&output.stderr)));
        assert!(object.is_object(), "{line}");
        let mut all = BTreeSet::new();
        keys(&object, &mut all);
        let wrong: Vec<_> = all.iter().filter(|key| key.contains(char::is_whitespace)).collect();
        assert!(wrong.is_empty(), "{line}: {wrong:?}");
    }
}
