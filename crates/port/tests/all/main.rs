//! Boards at pseudo-terminals: looked at, driven, shared and made dark.

#![cfg(unix)]
#![allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, in its helpers too")]

mod grbl;
mod served;
mod shared;

use std::time::{Duration, Instant};

use tracelight_aim::HeadPose;
use tracelight_pipeline::request_of;
use tracelight_port::{Device, Served, Serving, serve};
use tracelight_session::{Request, Session, State};
use tracelight_sim::{RigConfig, SimulatedRig, job_of};
use tracelight_stroke::{Drawing, Element, Path, Point, Stroke};
use tracelight_task::{Failure, NoProgress, Stop, Task};
use tracelight_trajectory::{Plan, plan};

pub(crate) fn serving<'a>(config: &'a RigConfig, at: &'a std::path::Path) -> Serving<'a> {
    Serving {
        rig: SimulatedRig::new(config, HeadPose::square_on(0.9144), 1).served(),
        name: &config.name,
        at,
        lasts_s: None,
    }
}

/// Serves a rig for as long as something is done with it.
pub(crate) fn served(rig: &str, name: &str, with: impl FnOnce(&std::path::Path)) -> Result<Served, Failure> {
    let path = std::env::temp_dir().join(format!("tracelight-{name}-{}", std::process::id()));
    let config = RigConfig::preset(rig).unwrap();
    let stop = Stop::default();
    std::thread::scope(|threads| {
        let (stop_it, at) = (&stop, path.clone());
        let board = threads.spawn(move || {
            let task = Task { progress: &NoProgress, stop: stop_it };
            serve(serving(&config, &at), task)
        });
        let until = Instant::now() + Duration::from_secs(5);
        while !path.exists() && Instant::now() < until && !board.is_finished() {
            std::thread::sleep(Duration::from_millis(2));
        }
        // whatever fails in there, the board ends
        let done = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| with(&path)));
        stop.want();
        let served = board.join().unwrap();
        done.unwrap();
        served
    })
}

/// A circle of 10 cm, by the head that boards have here.
pub(crate) fn circle() -> Plan {
    let config = RigConfig::report();
    let mut path = Path::new(Point::new(0.05, 0.0));
    path.push(Element::Arc { centre: Point::ORIGIN, sweep: std::f64::consts::TAU });
    path.close();
    let drawing = Drawing { strokes: vec![Stroke::new(path)] };
    plan(&drawing, &config.machine(HeadPose::square_on(0.9144)), &request_of(&config)).unwrap()
}

/// Asks what brings a session on its way to that plan, if anything does: it parks first, as the head sank while its motors had no volts.
pub(crate) fn bring_on(wall: &mut Session<Device>, plan: &Plan, parked: &mut bool) {
    let asked = match wall.state() {
        State::Ready if !std::mem::replace(parked, true) => wall.request(Request::Park),
        State::Ready => wall.request(Request::Arm),
        State::Armed => wall.request(Request::Trace(job_of(plan, false))),
        _ => Ok(()),
    };
    asked.unwrap();
}
