//! A folder with results is one job's: not two at a time, not half an old one's, and told from others by the hash of its log.

use std::fs;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use sha2::{Digest, Sha256};

use crate::support::{folder, program, root};

fn tracing(example: &str, out: &Path) -> Child {
    let mut command = program();
    command.current_dir(root()).args(["trace", &format!("examples/{example}.png"), "--quiet", "--out"]);
    command.arg(out).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    command.spawn().unwrap()
}

/// Whether the figures in a folder are of the log beside them.
fn belongs_together(dir: &Path) -> Value {
    let summary: Value = serde_json::from_slice(&fs::read(dir.join("summary.json")).unwrap()).unwrap();
    let log = fs::read(dir.join("run.mcap")).unwrap();
    let hash: String = Sha256::digest(&log).iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(summary["log"]["sha256"], hash.as_str());
    assert_eq!(summary["log"]["bytes"], log.len());
    summary
}

#[test]
fn two_jobs_do_not_write_to_one_folder() {
    let dir = folder("results-two");
    for pair in 0..4 {
        let mut jobs = [tracing("star", &dir), tracing("shapes", &dir)];
        let done: Vec<(bool, String)> = jobs
            .iter_mut()
            .map(|job| {
                let mut said = String::new();
                std::io::Read::read_to_string(job.stderr.as_mut().unwrap(), &mut said).unwrap();
                (job.wait().unwrap().success(), said)
            })
            .collect();
        // one may be over before the other begins
        assert!(done.iter().any(|(well, _)| *well), "pair {pair}: {done:?}");
        for (_, said) in done.iter().filter(|(well, _)| !well) {
            assert!(said.contains("another job is writing to") && said.contains("--out"), "{said}");
        }
        let summary = belongs_together(&dir);
        let path = summary["picture"]["path"].as_str().unwrap();
        assert!(["examples/star.png", "examples/shapes.png"].contains(&path), "{path}");
        assert!(!dir.join("previous").exists());
    }
}

#[test]
fn what_a_killed_job_leaves_is_never_mixed_with_what_was_there() {
    let dir = folder("results-killed");
    assert!(tracing("star", &dir).wait().unwrap().success());
    let before = fs::read(dir.join("summary.json")).unwrap();
    let mut job = tracing("house", &dir);
    let began = Instant::now();
    while !fs::metadata(dir.join("run.mcap")).is_ok_and(|log| log.len() > 200_000)
        || dir.join("summary.json").exists()
    {
        assert!(
            began.elapsed() < Duration::from_secs(60) && job.try_wait().unwrap().is_none(),
            "too late to kill"
        );
        std::thread::sleep(Duration::from_millis(1));
    }
    job.kill().unwrap();
    job.wait().unwrap();
    let log = dir.join("run.mcap");
    let done = program().arg("recover").arg(&log).output().unwrap();
    let said = String::from_utf8_lossy(&done.stdout);
    assert!(done.status.success() && said.contains("messages, indexed"), "{said}");
    assert!(mcap::Summary::read(&fs::read(&log).unwrap()).unwrap().is_some());
    for name in ["summary.json", "report.html", "trace.csv", "strokes.svg", "trace.png"] {
        assert!(!dir.join(name).exists() || name != "summary.json", "{name} is another job's");
    }
    assert_eq!(fs::read(dir.join("previous/summary.json")).unwrap(), before);
    assert!(tracing("star", &dir).wait().unwrap().success());
    belongs_together(&dir);
    assert!(!dir.join("previous").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn an_answer_that_cannot_be_written_is_told() {
    for arguments in [&["rigs", "show", "worn"][..], &["strokes", "examples/star.png", "--json"]] {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let done = program().current_dir(root()).args(arguments).stdout(full).output().unwrap();
        let said = String::from_utf8_lossy(&done.stderr);
        assert_eq!(done.status.code(), Some(1), "{arguments:?}: {said}");
        assert!(said.contains("standard output") && said.contains("space"), "{said}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_that_was_there_outlives_a_disk_that_is_full() {
    let dir = folder("results-full");
    let file = dir.join("plan.csv");
    fs::write(&file, "precious").unwrap();
    // the shell's bound on the size of a file stands for a full disk
    let line = format!(
        "trap '' XFSZ; ulimit -f 8; exec {} plan examples/star.png -o {}",
        program().get_program().to_string_lossy(),
        file.display()
    );
    let done = std::process::Command::new("sh").args(["-c", &line]).current_dir(root()).output().unwrap();
    assert_eq!(done.status.code(), Some(1), "{}", String::from_utf8_lossy(&done.stderr));
    assert_eq!(fs::read_to_string(&file).unwrap(), "precious");
    assert_eq!(fs::read_dir(&dir).unwrap().count(), 1, "no half is left");
}

/// One signal is enough, whatever a command does: reads what never comes, or computes.
#[cfg(unix)]
#[test]
fn one_signal_ends_any_command() {
    let dir = folder("results-signal");
    let many = dir.join("many.csv");
    let strokes: String = (0..50_000).map(|n| format!("{n},0.1,0.1\n{n},0.1001,0.1\n")).collect();
    let strokes = format!("stroke,x_m,y_m\n{strokes}");
    fs::write(&many, strokes).unwrap();
    let many = many.to_str().unwrap();
    let pipe = dir.join("pipe.png");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let pipe = pipe.to_str().unwrap();
    let out = dir.join("out");
    let out = out.to_str().unwrap();
    let commands: [&[&str]; 6] = [
        &["strokes", "-"],
        &["trace", pipe, "--out", out],
        &["trace", many, "--out", out],
        &["lab", "montecarlo", "--plants", "1000"],
        &["calibrate", "markers", "--camera", pipe, "-o", out],
        &["trace", "examples/star.png", "--laps", "250", "--out", out],
    ];
    for arguments in commands {
        for signal in ["-INT", "-TERM", "-HUP"] {
            let mut command = program();
            command.current_dir(root()).args(arguments).stdin(Stdio::piped());
            let mut job = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
            // waiting for its end would close it
            let stdin = job.stdin.take();
            std::thread::sleep(Duration::from_millis(500));
            if let Some(over) = job.try_wait().unwrap() {
                panic!("{arguments:?} was over before the signal: {over}");
            }
            let id = job.id().to_string();
            assert!(std::process::Command::new("kill").args([signal, &id]).status().unwrap().success());
            let asked = Instant::now();
            assert_eq!(job.wait().unwrap().code(), Some(130), "{arguments:?} {signal}");
            // what was run is written down before the end
            assert!(
                asked.elapsed() < Duration::from_secs(4),
                "{arguments:?} {signal}: {:?}",
                asked.elapsed()
            );
            drop(stdin);
            println!("{arguments:?} {signal}: {:?}", asked.elapsed());
        }
    }
}
