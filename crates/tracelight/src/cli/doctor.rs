use clap::Args;
use serde_json::{Value, json};
use tracelight_camera::{camera_json, camera_text, look_at_all, no_camera_text};
use tracelight_port::{Found, ask, asked_json, asked_text, examine, examined_json, examined_text, found};
use tracelight_rigfile::on_grbl;
use tracelight_sim::RigConfig;
use tracelight_task::{Failure, Stop};

use crate::cli::answer::{Answer, Voice, watched};
use crate::cli::eyes::ImageSize;
use crate::named;

/// List connected boards and cameras: what a board is and how good its line; modes, frame rate and latency of a camera
#[derive(Args, Debug)]
#[command(after_help = "Examples: tracelight doctor\n          \
                  tracelight doctor --camera /dev/video2 --camera-size 640x480\n          \
                  tracelight doctor --camera http://192.168.1.20:8080/video\n          \
                  tracelight doctor --rig /dev/ttyACM0\n          \
                  tracelight doctor --rig grbl:/dev/ttyUSB0\n\n\
                  A port is opened only if its device says that it is a board of Tracelight's, or if --rig names it. Each camera is used for about three seconds. Its exposure and gain are changed during the test and restored afterwards.")]
pub(crate) struct DoctorArgs {
    /// Look at this camera only: /dev/video0, or an http:// network camera [default: all connected cameras]
    #[arg(long, value_name = "SOURCE")]
    camera: Option<String>,
    /// Columns and rows of its images [default: about 1280x720]
    #[arg(long, value_name = "WxH")]
    camera_size: Option<ImageSize>,
    /// Look at the board at this port only, which is disarmed: what it is, and how good the line is; at grbl:PORT how a Grbl board is set
    #[arg(long, value_name = "PORT", conflicts_with = "camera")]
    rig: Option<String>,
    #[command(flatten)]
    pub(crate) voice: Voice,
}

pub(crate) fn run(args: &DoctorArgs, stop: &Stop) -> Result<Answer, Failure> {
    if let Some((port, _)) = args.rig.as_deref().and_then(on_grbl) {
        let board = ask(port, stop)?;
        return Ok(Answer::new(asked_text(port, &board), asked_json(port, &board).to_string()));
    }
    if let Some(port) = &args.rig {
        let seen = examine(&named::port(port), stop)?;
        return Ok(Answer::new(examined_text(&seen), examined_json(&seen).to_string()));
    }
    let size_px = args.camera_size.map(|size| size.0);
    let cameras = watched(args.voice, stop, |task| look_at_all(args.camera.as_deref(), size_px, task))?;
    let rigs: Vec<String> = RigConfig::presets().into_iter().map(|rig| rig.name).collect();
    let (os, arch) = (std::env::consts::OS, std::env::consts::ARCH);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let version = env!("CARGO_PKG_VERSION");
    let ports = found();
    let boards: Vec<_> = ports.iter().map(|found| looked_at(found, stop)).collect();
    let told = cameras.iter().map(|(name, seen)| camera_text(name, seen));
    let text = [
        format!("program:  tracelight {version} for {os} on {arch}, {cores} cores"),
        format!("rigs:     {}, simulated", rigs.join(", ")),
    ]
    .into_iter()
    .chain(boards.iter().map(|(text, _)| text.clone()))
    .chain(boards.is_empty().then(|| "boards:   no serial port is there".to_owned()))
    .chain(cameras.is_empty().then(|| no_camera_text().to_owned()))
    .chain(told)
    .collect::<Vec<_>>()
    .join("\n");
    let all: Vec<Value> = cameras.iter().map(|(name, seen)| camera_json(name, seen)).collect();
    let json = json!({
        "version": version, "os": os, "arch": arch, "cores": cores, "rigs": rigs,
        "ports": boards.into_iter().map(|(_, json)| json).collect::<Vec<Value>>(), "cameras": all,
    });
    let asked = args.camera.as_ref().and_then(|_| cameras.into_iter().next());
    match asked.and_then(|(_, seen)| seen.err()) {
        Some(failure) if failure.code == "usage" => Err(failure),
        failure => Ok(Answer { failure, ..Answer::new(text, json.to_string()) }),
    }
}

/// What is at a port, for people and for scripts. Only a board is spoken to: others may take offence.
fn looked_at(found: &Found, stop: &Stop) -> (String, Value) {
    let port = found.port.display().to_string();
    let name = found.name.as_deref().map_or_else(String::new, |name| format!(" ({name})"));
    if !found.is_board() {
        let text =
            format!("port:     {port}{name}; tracelight doctor --rig {port} looks whether a board is there");
        return (text, json!({ "port": port, "name": found.name }));
    }
    match examine(&found.port, stop) {
        Ok(seen) => (examined_text(&seen), examined_json(&seen)),
        Err(failure) => {
            let text = format!("board:    {port}{name}: {}", failure.message);
            (text, json!({ "port": port, "name": found.name, "error": failure.message }))
        }
    }
}
