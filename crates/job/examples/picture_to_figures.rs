//! A picture to strokes, a plan, a run and its figures, without the command line: no file, no print.

use tracelight_aim::{HeadPose, SizeRequest};
use tracelight_job::{KeepNothing, Request, RunRequest, prepare};
use tracelight_picture::decode;
use tracelight_pipeline::{Asked, Driving, Placing, Tracing, request_of};
use tracelight_sim::{RigConfig, score};
use tracelight_task::{Failure, NoProgress, Stop, Task};

const STAR: &[u8] = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/star.png"));

fn main() -> Result<(), Failure> {
    let (progress, stop) = (NoProgress, Stop::default());
    let task = Task { progress: &progress, stop: &stop };
    let rig = RigConfig::report();
    let wishes = request_of(&rig);
    let request = Request {
        name: "star",
        tracing: Tracing::default(),
        placing: Placing { size: Some(SizeRequest::Width(0.6)), ..Placing::default() },
        driving: Driving::new(rig, HeadPose::square_on(0.9), wishes, Asked::default()),
        run: RunRequest::default(),
    };
    let prepared = prepare(&request, decode("star", STAR)?, task)?;
    let ran = prepared.run(&mut KeepNothing, task)?;
    let plan = ran.plan(&prepared);
    let figures = score(plan, &ran.last, plan.set_speed_m_s);
    assert!(ran.failure.is_none() && figures.rms_mm < 0.1, "{} mm off", figures.rms_mm);
    Ok(())
}
