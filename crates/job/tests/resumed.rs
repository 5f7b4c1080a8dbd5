//! A run that ended anywhere is gone on with: all of its ink is there afterwards, and hardly any twice.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on may panic, and shows figures"
)]

mod ink;

use tracelight_aim::HeadPose;
use tracelight_job::{Keep, Prepared, Request, RunRequest, prepare};
use tracelight_picture::decode;
use tracelight_pipeline::{Asked, Driving, Placing, Tracing, request_of};
use tracelight_sim::{RigConfig, Tick};
use tracelight_stroke::Point;
use tracelight_task::{Failure, NoProgress, Stop, Task};
use tracelight_trajectory::Plan;

use crate::ink::{Lines, longest_mm};

/// Light this near to a line is on it, m.
const ON_IT_M: f64 = 3e-4;

/// A circle, a square and an open line, which do not cross: whatever is lit twice is doubled.
const DRAWING: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="400mm" height="300mm" viewBox="0 0 400 300" fill="none" stroke="black">
    <circle cx="90" cy="90" r="60"/><path d="M200 40h120v90h-120z"/><path d="M40 200 L150 270 L260 190 C300 160 330 250 370 210"/></svg>"#;

/// Keeps the light of a run, and ends it at a tick as a killed program would.
struct Killed {
    at: u32,
    plan_tick: u32,
    /// From where to where light went, tick by tick.
    lit: Vec<[Point; 2]>,
    last: Option<Point>,
}

impl Killed {
    fn at(at: u32) -> Self {
        Self { at, plan_tick: 0, lit: Vec::new(), last: None }
    }
}

impl Keep for Killed {
    fn tick(&mut self, _: &Plan, tick: &Tick) -> Result<(), Failure> {
        let spot = tick.spot.filter(|_| tick.light);
        if let (Some(from), Some(to)) = (self.last, tick.spot) {
            self.lit.push([from, to]);
        }
        self.last = spot;
        self.plan_tick = tick.telemetry.plan_tick;
        match tick.telemetry.tick >= self.at {
            true => Err(Failure::failed("killed", "it was killed")),
            false => Ok(()),
        }
    }
}

fn driving() -> Driving {
    let rig = RigConfig::report();
    let request = request_of(&rig);
    Driving::new(rig, HeadPose::square_on(0.9144), request, Asked::default())
}

fn prepared(task: Task<'_>) -> Prepared {
    let request = Request {
        name: "drawing.svg",
        tracing: Tracing::default(),
        placing: Placing::default(),
        driving: driving(),
        run: RunRequest::default(),
    };
    prepare(&request, decode("drawing.svg", DRAWING.as_bytes()).unwrap(), task).unwrap()
}

/// What is missing and what is doubled of a run that was killed at each of some moments and gone on with, up to `times` times, mm.
fn worst_of(moments: impl IntoIterator<Item = u64>, times: usize) -> (f64, f64) {
    let stop = Stop::default();
    let task = Task { progress: &NoProgress, stop: &stop };
    let whole = prepared(task).schedule.plan;
    let lines = Lines::of(&whole);
    let (mut missing_mm, mut doubled_mm) = (0.0_f64, 0.0_f64);
    for moment in moments {
        let mut dice = oorandom::Rand64::new(u128::from(moment));
        let mut job = prepared(task);
        let mut runs: Vec<Vec<bool>> = Vec::new();
        for _ in 0..times {
            let most = job.schedule.plan.points.len() as u64;
            let mut keep = Killed::at(dice.rand_range(0..most) as u32);
            assert_eq!(job.run(&mut keep, task).err().unwrap().code, "killed");
            runs.push(lines.passed(&keep.lit, ON_IT_M));
            match job.after(keep.plan_tick).unwrap() {
                Some(rest) => job = rest,
                // it was all but done
                None => {
                    job = prepared(task);
                    runs.clear();
                }
            }
        }
        let mut keep = Killed::at(u32::MAX);
        let ran = job.run(&mut keep, task).unwrap();
        assert!(ran.failure.is_none(), "{:?}", ran.failure);
        runs.push(lines.passed(&keep.lit, ON_IT_M));
        let drawn = |place: usize| runs.iter().filter(|run| run[place]).count();
        let all = 0..lines.len();
        missing_mm = missing_mm.max(longest_mm(all.clone().map(|place| drawn(place) == 0)));
        doubled_mm = doubled_mm.max(longest_mm(all.map(|place| drawn(place) > 1)));
    }
    (missing_mm, doubled_mm)
}

#[test]
fn a_run_killed_anywhere_is_whole_once_it_is_gone_on_with() {
    let (missing_mm, doubled_mm) = worst_of(0..100, 1);
    println!("killed at 100 moments: missing {missing_mm:.2} mm, doubled {doubled_mm:.2} mm");
    assert!(missing_mm <= 0.5 && doubled_mm <= 0.5, "missing {missing_mm} mm, doubled {doubled_mm} mm");
}

#[test]
fn and_once_more_when_that_is_killed_too() {
    let (missing_mm, doubled_mm) = worst_of(100..120, 3);
    println!("killed thrice at 20 moments each: missing {missing_mm:.2} mm, doubled {doubled_mm:.2} mm");
    assert!(missing_mm <= 0.5 && doubled_mm <= 0.5, "missing {missing_mm} mm, doubled {doubled_mm} mm");
}
