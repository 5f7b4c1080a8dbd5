//! How well a session keeps real time on this machine: ticks that are late, and how long a stop takes from the request to the dark.
//!
//! `cargo run --release -p tracelight-job --example by_the_clock -- 60` runs for a minute.

#![allow(clippy::print_stdout, reason = "a measurement shows figures")]

use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

use tracelight_aim::{HeadPose, SizeRequest};
use tracelight_job::{Request as JobRequest, RunRequest, prepare};
use tracelight_picture::decode;
use tracelight_pipeline::{Asked, Driving, Placing, Tracing, request_of};
use tracelight_rig::TICK_F64_S;
use tracelight_session::{Job, Request, Session, State};
use tracelight_sim::{RigConfig, SimulatedRig, job_of, tick};
use tracelight_task::{Failure, NoProgress, Pace, Stop, Task};

const STAR: &[u8] = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/star.png"));
const POSE: HeadPose = HeadPose::square_on(0.9);
/// How often somebody stops it.
const STOPS_EVERY: Duration = Duration::from_millis(1300);

fn job() -> Result<Job, Failure> {
    let (progress, stop) = (NoProgress, Stop::default());
    let rig = RigConfig::report();
    let wishes = request_of(&rig);
    let request = JobRequest {
        name: "star",
        tracing: Tracing::default(),
        placing: Placing { size: Some(SizeRequest::Width(0.6)), ..Placing::default() },
        driving: Driving::new(rig, POSE, wishes, Asked::default()),
        run: RunRequest::default(),
    };
    let task = Task { progress: &progress, stop: &stop };
    Ok(job_of(&prepare(&request, decode("star", STAR)?, task)?.schedule.plan, false))
}

/// The value below which so large a share of them lie, ms.
fn quantile(of: &mut [f64], share: f64) -> f64 {
    of.sort_by(f64::total_cmp);
    of.get(((of.len() as f64 * share) as usize).min(of.len().saturating_sub(1))).copied().unwrap_or(f64::NAN)
}

fn main() -> Result<(), Failure> {
    let seconds: f64 = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(10.0);
    let job = job()?;
    let mut wall = Session::new(SimulatedRig::new(&RigConfig::report(), POSE, 0));
    // somebody stops it at any time, also in the middle of a tick
    let (ask, asked) = channel();
    std::thread::spawn(move || {
        while ask.send(Instant::now()).is_ok() {
            std::thread::sleep(STOPS_EVERY);
        }
    });
    let ticks = (seconds / TICK_F64_S) as u64;
    let mut pace = Pace::new(TICK_F64_S);
    let began = Instant::now();
    let (mut late_ms, mut dark_ms, mut asking) = (Vec::new(), Vec::new(), None);
    for number in 1..=ticks {
        pace.wait();
        late_ms.push(1e3 * (began.elapsed().as_secs_f64() - number as f64 * TICK_F64_S));
        let was_lit = wall.told().actuation.lights();
        if let Ok(at) = asked.try_recv()
            && wall.request(Request::Stop).is_ok()
            && was_lit
        {
            asking = Some(at);
        }
        let told = tick(&mut wall);
        let is_dark = !told.telemetry.actuation.lights();
        if let Some(at) = asking.take_if(|_| is_dark) {
            dark_ms.push(1e3 * at.elapsed().as_secs_f64());
        }
        // and goes on, or begins anew
        let next = match wall.state() {
            State::Stopped | State::Ready => Some(Request::Arm),
            State::Armed if wall.snapshot().plan_ticks > 0 => Some(Request::Resume),
            State::Armed => Some(Request::Trace(job.clone())),
            State::Done => Some(Request::Park),
            _ => None,
        };
        if let Some(request) = next {
            // what is refused now is asked again in the next tick
            let _ = wall.request(request);
        }
    }
    let late = late_ms.iter().filter(|&&ms| ms > 1.0).count();
    println!("{ticks} ticks in {:.3} s of {seconds:.3}", began.elapsed().as_secs_f64());
    println!(
        "late by more than 1 ms: {late}, {:.4} %; 99.9 % within {:.2} ms, most {:.2} ms",
        100.0 * late as f64 / ticks as f64,
        quantile(&mut late_ms, 0.999),
        quantile(&mut late_ms, 1.0)
    );
    println!(
        "stop to dark: {} times, 99 % within {:.2} ms, most {:.2} ms",
        dark_ms.len(),
        quantile(&mut dark_ms, 0.99),
        quantile(&mut dark_ms, 1.0)
    );
    Ok(())
}
