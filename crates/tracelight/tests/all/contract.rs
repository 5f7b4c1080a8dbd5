//! What users and scripts rely on: commands, files, columns, exit codes.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on may panic, and shows figures"
)]

use serde_json::Value;

use crate::support::{folder, lit_lines, program, root, rows, run, trace};

const STAR: &str = "examples/star.png";

fn stdout(output: &std::process::Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

#[test]
fn trace_leaves_exactly_its_files() {
    let dir = folder("files");
    trace(&[STAR], &dir);
    let mut names: Vec<_> =
        std::fs::read_dir(&dir).unwrap().map(|f| f.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    assert_eq!(
        names,
        [
            "job.toml",
            "progress",
            "report.html",
            "run.mcap",
            "strokes.svg",
            "summary.json",
            "trace.csv",
            "trace.png"
        ]
    );
    let report = std::fs::read_to_string(dir.join("report.html")).unwrap();
    let report = report.replace("http://www.w3.org/2000/svg", "");
    assert!(!report.contains("http://") && !report.contains("https://"), "the report asks the network");
}

#[test]
fn the_summary_has_the_fields_of_the_contract() {
    let dir = folder("summary");
    let printed = trace(&[STAR], &dir);
    let written: Value =
        serde_json::from_str(&std::fs::read_to_string(dir.join("summary.json")).unwrap()).unwrap();
    assert_eq!(printed, written);
    let fields = [
        ("picture", &["path", "width_px", "height_px"][..]),
        ("target", &["width_m", "height_m", "distance_m"]),
        ("strokes", &["count", "length_m", "travel_m"]),
        ("plan", &["duration_s", "lit_s", "speed_m_s", "torque_peak_fraction"]),
        (
            "tracking",
            &[
                "rms_mm",
                "max_mm",
                "off_stroke_rms_mm",
                "off_stroke_max_mm",
                "overshoot_percent",
                "final_error_mm",
                "lit_speed_m_s",
                "at_speed_share",
            ],
        ),
        ("laser", &["lit_s", "faults"]),
        ("timing_ms", &["vision", "plan", "run", "report"]),
    ];
    for (object, names) in fields {
        for name in names {
            assert!(!printed[object][name].is_null(), "{object}.{name}");
        }
    }
    assert!(printed["seed"] == 0 && printed["version"].is_string());
}

/// Without hardware every run is simulated, and nobody is to take its figures for a head's.
#[test]
fn a_simulated_run_is_called_so_wherever_it_is_shown() {
    let dir = folder("simulated");
    let output = program().args(["trace", STAR, "--out"]).arg(&dir).output().unwrap();
    assert!(stdout(&output).contains("\nrig:    simulated"), "{}", stdout(&output));
    let text = |file: &str| std::fs::read_to_string(dir.join(file)).unwrap();
    let summary: Value = serde_json::from_str(&text("summary.json")).unwrap();
    assert_eq!(summary["simulated"], true);
    let report = text("report.html");
    let head = report.split("<main>").next().unwrap();
    assert!(head.contains(">simulated</span>"), "{head}");
}

#[test]
fn the_table_begins_with_the_columns_of_the_contract() {
    let dir = folder("columns");
    trace(&[STAR], &dir);
    let text = std::fs::read_to_string(dir.join("trace.csv")).unwrap();
    let first =
        "t_s,x_m,y_m,laser,pan_rad,tilt_rad,pan_set_rad,tilt_set_rad,pan_count,tilt_count,pan_v,tilt_v";
    assert!(text.starts_with(first), "{}", text.lines().next().unwrap());
}

#[test]
fn equal_inputs_give_equal_bytes() {
    let dirs = ["same-1", "same-2"].map(folder);
    dirs.iter().for_each(|dir| drop(trace(&[STAR, "--rig", "worn", "--seed", "3"], dir)));
    for file in ["trace.csv", "trace.png", "strokes.svg", "run.mcap"] {
        let [a, b] = dirs.each_ref().map(|d| std::fs::read(d.join(file)).unwrap());
        assert!(a == b, "{file}");
    }
}

#[test]
fn the_planned_time_is_the_executed_time() {
    let dir = folder("time");
    let summary = trace(&[STAR], &dir);
    let plan: Value = serde_json::from_slice(&run(&["plan", STAR, "--json"]).stdout).unwrap();
    let ticks = rows(&dir).len() as f64;
    let planned = plan["plan"]["duration_s"].as_f64().unwrap();
    assert!((planned - (ticks - 1.0) * 1e-3).abs() < 1e-3, "{planned} s, {ticks} ticks");
    assert!((summary["plan"]["duration_s"].as_f64().unwrap() - planned).abs() < 1e-3);
    assert!(plan["order"]["travel_m"].as_f64() >= plan["order"]["lower_bound_m"].as_f64());
}

#[test]
fn placement_moves_turns_and_mirrors_the_light() {
    let centre = |arguments: &[&str], name: &str| {
        let dir = folder(name);
        let arguments: Vec<&str> = [STAR].iter().chain(arguments).copied().collect();
        trace(&arguments, &dir);
        let points: Vec<_> = lit_lines(&rows(&dir)).concat();
        let sum = points.iter().fold((0.0, 0.0), |s, p| (s.0 + p.x, s.1 + p.y));
        (sum.0 / points.len() as f64, sum.1 / points.len() as f64)
    };
    let plain = centre(&["--width", "12in"], "placed-plain");
    let moved = centre(&["--width", "12in", "--offset", "10cm,-5cm"], "placed-moved");
    assert!((moved.0 - plain.0 - 0.1).abs() < 2e-3 && (moved.1 - plain.1 + 0.05).abs() < 2e-3);
    let turned =
        centre(&["--width", "12in", "--offset", "10cm,0m", "--rotate", "90deg", "--flip"], "placed-turned");
    assert!((turned.0 - 0.1 + plain.1).abs() < 3e-3, "{turned:?} {plain:?}");
}

#[test]
fn every_profile_draws_the_picture() {
    for profile in ["trapezoid", "s-curve", "sine", "sigmoid", "optimal"] {
        let dir = folder(&format!("profile-{profile}"));
        let summary = trace(&[STAR, "--profile", profile, "--lit-speed", "stops"], &dir);
        assert!(summary["tracking"]["rms_mm"].as_f64().unwrap() < 0.25, "{profile}");
    }
}

/// At one speed: the plan's, which the drawing's tightest bend bounds, and it says so.
#[test]
fn lit_speed_exact_keeps_one_speed_and_says_which() {
    let dir = folder("exact");
    let summary = trace(&[STAR, "--lit-speed", "exact"], &dir);
    let (plan, tracking) = (&summary["plan"], &summary["tracking"]);
    let set = plan["set_speed_m_s"].as_f64().unwrap();
    assert!(0.05 < set && set < 0.3048, "{plan}");
    assert!((plan["speed_m_s"].as_f64().unwrap() / set - 1.0).abs() < 1e-3, "{plan}");
    assert!(tracking["at_speed_share"].as_f64().unwrap() >= 0.99, "{tracking}");
    let output = run(&["plan", STAR, "--lit-speed", "exact"]);
    let remark = String::from_utf8(output.stderr).unwrap();
    assert!(remark.contains("throughout instead of 0.3048") && remark.contains("radius"), "{remark}");
    // corners may be rounded off, but not by a hand's width
    let refused = run(&["plan", STAR, "--corner", "2cm"]);
    let message = String::from_utf8(refused.stderr).unwrap();
    assert!(refused.status.code() == Some(2) && message.contains("between 0 and 10 mm"), "{message}");
}

#[test]
fn a_dry_run_is_dark_and_laps_have_a_column() {
    let dry = folder("dry");
    trace(&[STAR, "--dry-run"], &dry);
    assert!(rows(&dry).iter().all(|r| !r.lit));
    let laps = folder("laps");
    trace(&[STAR, "--laps", "2"], &laps);
    let text = std::fs::read_to_string(laps.join("trace.csv")).unwrap();
    let lap = text.lines().next().unwrap().split(',').position(|c| c == "lap").unwrap();
    let of = |n: &str| text.lines().skip(1).filter(|l| l.split(',').nth(lap) == Some(n)).count();
    assert!(of("1") > 1000 && of("1") == of("2"), "{} and {} rows", of("1"), of("2"));
}

#[test]
fn strokes_come_in_every_format_and_read_back() {
    let dir = folder("formats");
    let json: Value = serde_json::from_slice(&run(&["strokes", STAR, "--json"]).stdout).unwrap();
    assert!(json["width_px"] == 640 && json["strokes"][0]["points"].is_array());
    for extension in ["svg", "json", "csv"] {
        let file = dir.join(format!("star.{extension}"));
        let file = file.to_str().unwrap();
        assert!(run(&["strokes", STAR, "-o", file]).status.success(), "{extension}");
        let plan = run(&["plan", file, "--json"]);
        let plan: Value = serde_json::from_slice(&plan.stdout).unwrap();
        let length = plan["strokes"]["length_m"].as_f64().unwrap();
        let direct: Value = serde_json::from_slice(&run(&["plan", STAR, "--json"]).stdout).unwrap();
        let expected = direct["strokes"]["length_m"].as_f64().unwrap();
        assert!((length / expected - 1.0).abs() < 1e-3, "{extension}: {length} m, not {expected} m");
    }
}

#[test]
fn standard_input_is_a_picture_too() {
    use std::io::Write;
    use std::process::Stdio;
    let mut child = program()
        .args(["strokes", "-", "--json"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let bytes = std::fs::read(root().join(STAR)).unwrap();
    child.stdin.take().unwrap().write_all(&bytes).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    assert_eq!(stdout(&output), stdout(&run(&["strokes", STAR, "--json"])));
}

#[test]
fn the_ruler_gives_twelve_pixels_an_inch_and_five_point_four_feet() {
    let output = run(&[
        "calibrate",
        "ruler",
        "examples/ruler-upright.png",
        "examples/ruler-level.png",
        "--marks",
        "4in",
        "--wish",
        "3ft,3ft",
        "--json",
    ]);
    let ruler: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!((ruler["across_px_per_in"].as_f64().unwrap() - 12.0).abs() < 0.03);
    assert!((ruler["upwards_px_per_in"].as_f64().unwrap() - 12.0).abs() < 0.03);
    assert!((ruler["wish_distance_m"].as_f64().unwrap() / 0.3048 - 5.4).abs() < 0.02);
}

#[test]
fn rigs_are_listed_and_shown_as_files_that_load() {
    assert!(stdout(&run(&["rigs"])).contains("report") && stdout(&run(&["rigs"])).contains("worn"));
    let dir = folder("rigs");
    let file = dir.join("my.toml");
    std::fs::write(&file, stdout(&run(&["rigs", "show", "worn"]))).unwrap();
    let again = stdout(&run(&["rigs", "show", file.to_str().unwrap()]));
    assert_eq!(again, std::fs::read_to_string(&file).unwrap());
}

#[test]
fn wishes_the_motors_cannot_fulfil_are_answered_in_volts() {
    let output = run(&["plan", STAR, "--amax", "100rad/s2"]);
    let remark = String::from_utf8(output.stderr).unwrap();
    assert!(
        remark.contains("on pan would need 123 V") && remark.contains("on tilt would need 98 V"),
        "{remark}"
    );
}

#[test]
fn a_speed_that_is_reached_nowhere_is_refused_with_the_best_possible() {
    let output = run(&["plan", STAR, "--speed", "100m/s", "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let error: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(error["error"]["code"], "speed-unreachable");
    assert!(error["error"]["message"].as_str().unwrap().contains("best possible is"));
}

#[test]
fn a_rig_fault_darkens_stops_and_exits_with_3() {
    let dir = folder("fault");
    let rig = dir.join("weak.toml");
    // believed to be as strong as ever, its pan motor does nothing
    std::fs::write(&rig, "base = \"report\"\n[truth.pan.motor]\ntorque_per_volt = \"0.0001Nm/V\"\n").unwrap();
    let out = dir.join("out");
    let output =
        program().args(["trace", STAR, "--json", "--rig"]).arg(&rig).arg("--out").arg(&out).output().unwrap();
    assert_eq!(output.status.code(), Some(3));
    let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
    let fault = summary["error"]["code"].as_str().unwrap();
    assert!(["encoder-dead", "hold-timed-out"].contains(&fault), "{fault}");
    assert_eq!(summary["run"]["finished"], false);
    assert!(!rows(&out).last().unwrap().lit);
}

#[test]
fn explain_knows_every_code_it_lists() {
    let list = stdout(&run(&["explain"]));
    for code in list.lines().filter_map(|l| l.split_whitespace().next()) {
        assert!(run(&["explain", code]).status.success(), "{code}");
    }
    assert_eq!(run(&["explain", "nonsense"]).status.code(), Some(2));
}

#[test]
fn completions_and_help_are_there() {
    assert!(stdout(&run(&["completions", "bash"])).contains("tracelight"));
    for command in ["trace", "strokes", "plan", "calibrate", "doctor", "rigs", "explain", "completions"] {
        assert!(run(&[command, "--help"]).status.success(), "{command}");
    }
}

/// Ctrl-C while the run goes on: dark first, the log closed, exit 130.
#[cfg(unix)]
#[test]
fn an_interrupt_darkens_closes_the_log_and_exits_with_130() {
    use std::time::{Duration, Instant};
    let dir = folder("interrupt");
    // 250 laps: long enough to be interrupted on any machine
    let mut child = program()
        .args(["trace", STAR, "--quiet", "--laps", "250", "--out"])
        .arg(&dir)
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let log = dir.join("run.mcap");
    let began = Instant::now();
    let begun = || std::fs::metadata(&log).is_ok_and(|m| m.len() > 100_000);
    while !begun() && began.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(5));
    }
    let id = child.id().to_string();
    assert!(std::process::Command::new("kill").args(["-INT", &id]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let bytes = std::fs::read(&log).unwrap();
    let messages: Vec<_> = mcap::MessageStream::new(&bytes).unwrap().collect::<Result<_, _>>().unwrap();
    assert!(messages.len() > 100);
    assert!(bytes.ends_with(mcap::MAGIC), "the log is closed");
    assert!(!rows(&dir).last().unwrap().lit, "the last tick is dark");
}
