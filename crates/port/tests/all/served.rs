//! An emulated board at a pseudo-terminal: looked at, driven by a host of another thread in real time, held by one program at a time.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use tracelight_device::{Host, Stage};
use tracelight_port::{Device, Port, examine, examined_json, examined_text, serve};
use tracelight_rig::{Command, PanTilt, Phase, RateLimit, Segment};
use tracelight_session::{Session, State};
use tracelight_sim::RigConfig;
use tracelight_task::{NoProgress, Stop, Task};

use crate::{bring_on, circle, served, serving};

#[test]
fn a_board_says_what_it_is_and_how_good_its_line_is() {
    let stop = Stop::default();
    let mut left = PathBuf::new();
    let ran = served("report", "looked-at", |path| {
        left = path.to_owned();
        let seen = examine(path, &stop).unwrap();
        assert!(seen.round_trips_ms.len() > 50 && seen.unanswered == 0, "{seen:?}");
        let text = examined_text(&seen);
        for words in [
            "emulated board",
            "stamped edges",
            "emergency stop",
            "absolute encoders",
            "power-up",
            "there and back in",
            "its ticks are known to",
        ] {
            assert!(text.contains(words), "{words}: {text}");
        }
        // half of the way there and back at most
        assert!(seen.ticks_known_ms.is_some_and(|ms| ms < 5.0), "{:?}", seen.ticks_known_ms);
        let json = examined_json(&seen);
        assert_eq!((&json["segments"], &json["tick_ns"]), (&384.into(), &1_000_000.into()));
        // and again: who has left it leaves it as it was
        assert_eq!(examine(path, &stop).unwrap().board.id, seen.board.id);
    });
    assert!(ran.unwrap().came > 1000);
    assert!(std::fs::symlink_metadata(&left).is_err(), "it is taken away");
}

#[test]
fn one_program_at_a_time_has_a_port() {
    served("report", "held", |path| {
        let port = Port::open(path).unwrap();
        let refused = Port::open(path).unwrap_err();
        assert!(refused.message.contains("another program has it open"), "{}", refused.message);
        drop(port);
        assert!(Port::open(path).is_ok());
        // nor is a second board put in the place of the first
        let stop = Stop::default();
        let task = Task { progress: &NoProgress, stop: &stop };
        let twice = serve(serving(&RigConfig::report(), path), task).unwrap_err();
        assert!(twice.message.contains("a board perhaps"), "{}", twice.message);
        assert!(examine(path, &stop).is_ok(), "the first is still there");
    })
    .unwrap();
}

#[test]
fn what_is_no_port_is_told() {
    let file = std::env::temp_dir().join(format!("tracelight-no-port-{}", std::process::id()));
    std::fs::write(&file, "text").unwrap();
    let (no, none) =
        (Port::open(&file).unwrap_err(), Port::open(std::path::Path::new("/dev/ttyNONE7")).unwrap_err());
    assert!(no.message.contains("is no serial port"), "{}", no.message);
    assert!(none.message.contains("is the board plugged in?"), "{}", none.message);
    // and what is somebody's is not written over
    let stop = Stop::default();
    stop.want();
    let task = Task { progress: &NoProgress, stop: &stop };
    let refused = serve(serving(&RigConfig::report(), &file), task).unwrap_err();
    assert!(refused.message.contains("no pseudo-terminal"), "{}", refused.message);
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "text");
    std::fs::remove_file(&file).unwrap();
    // what a killed board has left behind is in nobody's way
    std::os::unix::fs::symlink("/dev/pts/999999", &file).unwrap();
    let task = Task { progress: &NoProgress, stop: &stop };
    serve(serving(&RigConfig::report(), &file), task).unwrap();
    assert!(std::fs::symlink_metadata(&file).is_err());
}

/// A stretch of a slow sway from zero on.
fn segment(number: u32) -> Segment {
    let (way, n) = (if number.is_multiple_of(2) { 0.02 } else { -0.02 }, 250.0_f32);
    let from = if number.is_multiple_of(2) { 0.0 } else { 0.02 };
    let n3 = n * n * n;
    let quintic = [from, 0.0, 0.0, 10.0 * way / n3, -15.0 * way / (n3 * n), 6.0 * way / (n3 * n * n)];
    Segment {
        start_tick: 250 * number,
        ticks: 250,
        coefficients: PanTilt::new(quintic, [0.0; 6]),
        tolerance_rad: PanTilt::new(5e-3, 5e-3),
        gate: number > 0,
        rate_limit: RateLimit::PLANNED,
    }
}

/// A line of the operating system, its clock and its scheduler are between them: the twin does what the board does all the same.
#[test]
fn a_host_of_another_thread_configures_arms_and_lights_it() {
    let ran = served("stepper", "driven", |path| {
        let mut port = Port::open(path).unwrap();
        let mut host = Host::new(RigConfig::preset("stepper").unwrap().control_config(), 77);
        let began = Instant::now();
        let (mut bytes, mut next, mut armed, mut done, mut ticks) = (Vec::new(), 0, false, false, 0);
        while !done && began.elapsed() < Duration::from_secs(20) {
            let now_us = |began: Instant| u64::try_from(began.elapsed().as_micros()).unwrap();
            host.send(Command::KeepAlive).unwrap();
            if host.stage() == Stage::Running && ticks > 10 && !armed {
                armed = host.send(Command::Arm { acknowledges: 0 }).is_ok();
            }
            while armed && next < 8 && host.send(Command::Append(segment(next))).is_ok() {
                next += 1;
            }
            if next == 8 && host.send(Command::Finish).is_ok() {
                next += 1;
            }
            bytes.clear();
            host.give(now_us(began), &mut bytes);
            port.write(&bytes).unwrap();
            bytes.clear();
            port.read(&mut bytes, Duration::from_millis(1)).unwrap();
            host.take(&bytes, now_us(began));
            while let Some(told) = host.telemetry() {
                ticks += 1;
                assert_eq!(told.fault(), None, "tick {}", told.tick);
                done |= told.phase == Phase::Done;
            }
            assert!(!matches!(host.stage(), Stage::Failed(_)), "{:?}", host.stage());
        }
        assert!(done, "{ticks} ticks, {:?}", host.stage());
        let (middle_us, _) = host.clock().round_trip_us().unwrap();
        assert!(middle_us < 50_000.0, "{middle_us} us there and back");
    });
    let lit_s = ran.unwrap().lit_s;
    assert!((1.5..2.0).contains(&lit_s), "{lit_s} s of light of 1.75");
}

/// The whole way but the program: a session drives a head that it knows by its telemetry alone, through a port, by the clock.
#[test]
fn a_session_parks_arms_and_traces_a_drawing_through_a_port() {
    let config = RigConfig::preset("report").unwrap();
    let plan = circle();
    let planned_lit_s =
        plan.lit_ticks().iter().flatten().map(|[from, to]| f64::from(to - from) * 1e-3).sum::<f64>();
    let ran = served("report", "traced", |at| {
        let device = Device::connect(at, &config, |_| Ok(()), &Stop::default()).unwrap();
        let mut wall = Session::new(device);
        let until = Instant::now() + Duration::from_secs(40);
        let (mut reached, mut parked) = (Vec::new(), false);
        while wall.state() != State::Done && Instant::now() < until {
            let told = wall.tick().unwrap_or_else(|| panic!("{:?}", wall.rig().failure()));
            assert_eq!(told.fault(), None, "{reached:?}");
            if reached.last() != Some(&wall.state()) {
                reached.push(wall.state());
            }
            bring_on(&mut wall, &plan, &mut parked);
        }
        assert_eq!(wall.state(), State::Done, "{reached:?}");
        assert_eq!(wall.rig().host().stage(), Stage::Running);
    });
    let lit_s = ran.unwrap().lit_s;
    assert!((lit_s - planned_lit_s).abs() < 0.05, "{lit_s} s of light of {planned_lit_s}");
}
