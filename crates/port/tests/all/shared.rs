//! A board that one program drives while others watch it, and anybody may disarm it.

use std::ops::ControlFlow;
use std::path::Path;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use tracelight_port::{Device, Port, SharedFor, darken, darkened_text, seen_text, share, watch};
use tracelight_session::{Session, State};
use tracelight_sim::RigConfig;
use tracelight_task::{Failure, NoProgress, Stop, Task};

use crate::{bring_on, circle, served};

/// Traces a circle at a port until it is done, stopped, or was long enough; how it ended.
fn trace(at: &Path, stop: &Stop) -> State {
    let config = RigConfig::preset("report").unwrap();
    let plan = circle();
    let mut device = Device::connect(at, &config, |_| Ok(()), stop).unwrap();
    // whoever drove it before may have lit it
    device.wait_for_light(Task { progress: &NoProgress, stop }).unwrap();
    let mut wall = Session::new(device);
    let until = Instant::now() + Duration::from_secs(30);
    let mut parked = false;
    while !matches!(wall.state(), State::Done | State::Stopped) && Instant::now() < until && !stop.is_wanted()
    {
        let Some(told) = wall.tick() else {
            // whoever was stopped from elsewhere knows it, and does not go on
            let why = wall.rig().failure().unwrap();
            assert!(why.code == "disarmed" && why.message.contains("tracelight stop"), "{}", why.message);
            break;
        };
        assert_eq!(told.fault(), None);
        bring_on(&mut wall, &plan, &mut parked);
    }
    wall.state()
}

/// Waits until the head at a port is lit; what whoever watches it saw until then.
fn until_lit(at: &Path) -> Vec<serde_json::Value> {
    let (mut seen, since) = (Vec::new(), Instant::now());
    while since.elapsed() < Duration::from_secs(20) {
        let look = |line: &serde_json::Value| {
            seen.push(line.clone());
            if line["gate"] == true { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let stop = Stop::default();
        watch(Some(at), Some(20.0), look, Task { progress: &NoProgress, stop: &stop }).unwrap();
        if seen.last().is_some_and(|line| line["gate"] == true) {
            return seen;
        }
    }
    panic!("it was never lit: {seen:?}");
}

/// Shares a port in another thread until it is stopped, or that long, s.
fn shared(at: &Path, lasts_s: Option<f64>, stop: &Stop) -> JoinHandle<Result<SharedFor, Failure>> {
    let (at, stop) = (at.to_owned(), stop.clone());
    thread::spawn(move || share(&at, lasts_s, Task { progress: &NoProgress, stop: &stop }))
}

#[test]
fn a_head_that_another_program_drives_is_watched_and_made_dark_by_anybody() {
    served("report", "darkened", |at| {
        assert_eq!(darken(Some(at)).unwrap(), []);
        let (traced, stop) = (at.to_owned(), Stop::default());
        let driver = thread::spawn(move || trace(&traced, &stop));
        let seen = until_lit(at);
        assert!(seen[0]["owner"].is_string() && seen[0]["pid"] == std::process::id(), "{}", seen[0]);
        let lit = seen.last().unwrap();
        assert!(lit["phase"] == "tracing" && lit["pan_deg"].is_number() && lit["homed"] == true, "{lit}");
        let text = seen_text(&seen[0], lit);
        assert!(text.contains("GATE OPEN, tracing, pan"), "{text}");
        // it is told so who wants to drive it meanwhile, and by whom
        let refused = Port::open(at).unwrap_err().message;
        assert!(
            refused.contains(&format!("pid {}", std::process::id())) && refused.contains("tracelight stop"),
            "{refused}"
        );
        let dark = darken(Some(at)).unwrap();
        let within_s = dark[0].within_s.unwrap_or_else(|| panic!("{dark:?}"));
        assert!(within_s < 0.3, "{within_s} s");
        assert!(darkened_text(&dark).starts_with("dark: "), "{}", darkened_text(&dark));
        assert!(matches!(driver.join().unwrap(), State::Stopped | State::Lost));
        // and nobody lights it again who was told to stop
        assert_eq!(darken(Some(at)).unwrap(), []);
    })
    .unwrap();
}

#[test]
fn of_those_who_share_a_port_one_drives_at_a_time_and_anybody_makes_it_dark() {
    served("report", "lent", |at| {
        let stop = Stop::default();
        let owner = shared(at, None, &stop);
        let since = Instant::now();
        while darken(Some(at)).unwrap().is_empty() && since.elapsed() < Duration::from_secs(5) {
            thread::sleep(Duration::from_millis(5));
        }
        let idle = darken(Some(at)).unwrap();
        assert!(!idle[0].driven && darkened_text(&idle).contains("which nobody drives"), "{idle:?}");
        let traced = at.to_owned();
        let driver = thread::spawn(move || trace(&traced, &Stop::default()));
        let seen = until_lit(at);
        assert!(seen[0]["lends"] == true && seen.last().unwrap()["pan_deg"].is_null(), "{:?}", seen.last());
        assert!(Port::open(at).unwrap_err().message.contains("it is in use by"));
        let dark = darken(Some(at)).unwrap();
        assert!(dark[0].within_s.is_some_and(|s| s < 0.3), "{dark:?}");
        assert!(matches!(driver.join().unwrap(), State::Stopped | State::Lost));
        // who was stopped does not come back; after some seconds the next one may drive it
        let since = Instant::now();
        while let Err(why) = Port::open(at) {
            assert!(why.code == "disarmed" && since.elapsed() < Duration::from_secs(20), "{}", why.message);
            thread::sleep(Duration::from_millis(200));
        }
        assert!(since.elapsed() > Duration::from_secs(5), "{:?}", since.elapsed());
        thread::sleep(Duration::from_millis(100));
        assert_eq!(trace(at, &Stop::default()), State::Done);
        stop.want();
        let told = owner.join().unwrap().unwrap();
        assert!(told.drivers == 3 && told.from_board > 10_000 && told.to_board > 1000, "{told:?}");
    })
    .unwrap();
}

/// Who is silent for two seconds, his line open, has nothing to say any more.
#[test]
fn who_drives_and_says_nothing_makes_room_for_another_one() {
    served("report", "silent", |at| {
        let stop = Stop::default();
        let owner = shared(at, Some(20.0), &stop);
        let since = Instant::now();
        let mut first = None;
        while first.is_none() && since.elapsed() < Duration::from_secs(5) {
            first = Port::open(at).ok().filter(|port| !port.is_own());
            thread::sleep(Duration::from_millis(5));
        }
        assert!(first.is_some());
        assert!(Port::open(at).is_err(), "it was lent a moment ago");
        thread::sleep(Duration::from_millis(2300));
        assert!(Port::open(at).is_ok());
        stop.want();
        owner.join().unwrap().unwrap();
    })
    .unwrap();
}
