use clap::Args;
use serde_json::{Value, json};
use tracelight_camera::{camera_json, camera_text, devices, look_at, shown};
use tracelight_sim::RigConfig;
use tracelight_task::{Failure, Stop, Task};

use crate::bar::Bar;
use crate::cli::answer::{Answer, Voice};
use crate::cli::eyes::ImageSize;

/// List connected cameras: their modes, frame rate and latency
#[derive(Args, Debug)]
#[command(after_help = "Examples: tracelight doctor\n          \
                  tracelight doctor --camera /dev/video2 --camera-size 640x480\n          \
                  tracelight doctor --camera http://192.168.1.20:8080/video\n\n\
                  Each camera is used for about three seconds. Its exposure and gain are changed during the test and restored afterwards.")]
pub(crate) struct DoctorArgs {
    /// Look at this camera only: /dev/video0, or an http:// network camera [default: all connected cameras]
    #[arg(long, value_name = "SOURCE")]
    camera: Option<String>,
    /// Columns and rows of its images [default: about 1280x720]
    #[arg(long, value_name = "WxH")]
    camera_size: Option<ImageSize>,
    #[command(flatten)]
    pub(crate) voice: Voice,
}

pub(crate) fn run(args: &DoctorArgs, stop: &Stop) -> Result<Answer, Failure> {
    let bar = Bar::new(args.voice.quiet);
    let task = Task { progress: &bar, stop };
    let names: Vec<String> = match &args.camera {
        Some(name) => vec![name.clone()],
        None => devices().iter().map(|path| path.display().to_string()).collect(),
    };
    task.stage("cameras", names.len() as u64);
    let mut cameras = Vec::new();
    for (step, name) in (0..).zip(names) {
        stop.check()?;
        task.at(step);
        let seen = look_at(&name, args.camera_size.map(|size| size.0), stop);
        // a second device of a camera is no news
        let is_other = seen.as_ref().is_err_and(|failure| failure.code == "not-a-camera");
        if args.camera.is_some() || !is_other {
            cameras.push((shown(&name), seen));
        }
    }
    stop.check()?;
    let presets = RigConfig::presets();
    let rigs: Vec<&str> = presets.iter().map(|rig| rig.name.as_str()).collect();
    let (os, arch) = (std::env::consts::OS, std::env::consts::ARCH);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let version = env!("CARGO_PKG_VERSION");
    let told = cameras.iter().map(|(name, seen)| camera_text(name, seen));
    let none = match os {
        "linux" => "cameras:  none is plugged in; one on the net is looked at with --camera http://…",
        _ => {
            "cameras:  those that are plugged in are read on Linux only; one on the net is looked at with --camera http://…"
        }
    };
    let text = [
        format!("program:  tracelight {version} for {os} on {arch}, {cores} cores"),
        format!("rigs:     {}, simulated; none can be plugged in yet", rigs.join(", ")),
    ]
    .into_iter()
    .chain(cameras.is_empty().then(|| none.to_owned()))
    .chain(told)
    .collect::<Vec<_>>()
    .join("\n");
    let all: Vec<Value> = cameras.iter().map(|(name, seen)| camera_json(name, seen)).collect();
    let json = json!({
        "version": version, "os": os, "arch": arch, "cores": cores, "rigs": rigs, "cameras": all,
    });
    let asked = args.camera.as_ref().and_then(|_| cameras.into_iter().next());
    let failure = asked.and_then(|(_, seen)| seen.err());
    match failure {
        Some(failure) if failure.code == "usage" => Err(failure),
        failure => Ok(Answer { failure, ..Answer::new(text, json.to_string()) }),
    }
}
