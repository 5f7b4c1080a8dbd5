//! What `trace` is asked for; other commands share parts of it.

use std::io::IsTerminal as _;
use std::path::PathBuf;

use clap::Args;
use tracelight_camera::Source;
use tracelight_pipeline::{PointMark, Points, TypedKinds};
use tracelight_task::Failure;
use tracelight_units::{Offset, Speed};

use crate::cli::answer::Voice;
use crate::cli::driving::{DrivingArgs, positive_speed};
use crate::cli::eyes::{EyeArgs, FollowArgs, SimulatedEyeName};
use tracelight_flags::ByHandArgs;
use tracelight_flags::LawArgs;
use tracelight_flags::LetteringArgs;
use tracelight_flags::PlacementArgs;
use tracelight_flags::ReadingArgs;
use tracelight_flags::SequenceArgs;
use tracelight_flags::TracingArgs;
use tracelight_flags::WallArgs;

/// Draw a picture on the target: find its strokes, plan them, run them, show how exact it was
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight trace examples/house.png --width 24in --speed 1ft/s --open\n\
                  What a camera sees: tracelight trace --camera sim:examples/house.png")]
pub(crate) struct TraceArgs {
    /// PNG, JPEG, WebP, BMP, GIF, PNM, TIFF; or SVG, DXF, JSON, CSV with strokes to be taken as they are; - is
    /// standard input
    #[arg(required_unless_present_any = ["camera", "text"], conflicts_with_all = ["camera", "text"])]
    picture: Option<String>,
    #[command(flatten, next_help_heading = "Picture")]
    pub(crate) tracing: TracingArgs,
    #[command(flatten, next_help_heading = "Picture")]
    pub(crate) reading: ReadingArgs,
    #[command(flatten, next_help_heading = "Picture")]
    pub(crate) lettering: LetteringArgs,
    #[command(flatten, next_help_heading = "Size and place")]
    pub(crate) placement: PlacementArgs,
    #[command(flatten, next_help_heading = "Size and place")]
    pub(crate) wall: WallArgs,
    #[command(flatten)]
    pub(crate) driving: DrivingArgs,
    #[command(flatten, next_help_heading = "Rig and law")]
    pub(crate) law: LawArgs,
    #[command(flatten, next_help_heading = "Camera")]
    pub(crate) eye: EyeArgs,
    /// Where the head stands, as `calibrate corners` or `calibrate head` has found it; with a camera and without this the laser draws dots first, and the
    /// camera finds it
    #[arg(help_heading = "Size and place", long, value_name = "FILE.toml")]
    pub(crate) head: Option<String>,
    /// Home first, for a head that was just powered up or lost count: it draws dots that the camera sees and finds out where it points,
    /// as with `calibrate head --home`. The dots may fall anywhere: keep eyes away. A simulated head then starts at a random position
    #[arg(help_heading = "Camera", long, requires = "camera", conflicts_with = "dry_run")]
    pub(crate) home: bool,
    /// Maximum number of further images to take if one shows no markers or no figure
    #[arg(help_heading = "Camera", long, value_name = "N", default_value_t = 5, requires = "camera", allow_hyphen_values = true, value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub(crate) retakes: u32,
    #[command(flatten, next_help_heading = "Camera")]
    pub(crate) follow: FollowArgs,
    #[command(flatten, next_help_heading = "Time and order")]
    pub(crate) sequence: SequenceArgs,
    /// Draw N times, powering up anew each time and re-identifying the head between laps; the last lap is reported
    #[arg(help_heading = "Time and order", long, value_name = "N", default_value_t = 1, allow_hyphen_values = true, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) laps: u32,
    /// Random seed for the differences between simulated heads
    #[arg(
        help_heading = "Simulation",
        long,
        value_name = "N",
        default_value_t = 0,
        allow_hyphen_values = true
    )]
    pub(crate) seed: u64,
    /// Start the simulated head unhomed, to check that it refuses to draw
    #[arg(help_heading = "Simulation", long)]
    pub(crate) sim_unhomed: bool,
    #[command(flatten, next_help_heading = "At the wall")]
    pub(crate) by_hand: ByHandArgs,
    /// Draw one stroke again and again, there and back where it is open, until Space, Enter, → or a pedal asks for the next; in real time
    #[arg(help_heading = "At the wall", long, conflicts_with_all = ["laps", "camera"])]
    pub(crate) step: bool,
    /// Mark its points on the target, one after the other, as --step draws strokes: points and blocks of a DXF, centres of circles and arcs, corners, ends; with
    /// --points=KINDS only those, such as --points=block,centre. Layer by layer, row by row; points.csv says which were ticked off
    #[arg(help_heading = "At the wall", long, value_name = "KINDS", num_args = 0..=1, require_equals = true, default_missing_value = "all", conflicts_with_all = ["laps", "camera", "step"])]
    pub(crate) points: Option<TypedKinds>,
    /// What marks a point: a cross of that length, or a dot [default: 20mm]
    #[arg(
        help_heading = "At the wall",
        long,
        value_name = "LENGTH|dot",
        allow_hyphen_values = true,
        requires = "points"
    )]
    pub(crate) mark: Option<PointMark>,
    /// Speed of the spot with --step and --points, such as 5cm/s: slow enough for a pencil to follow [default: --speed]
    #[arg(help_heading = "At the wall", long, value_name = "SPEED", allow_hyphen_values = true, value_parser = positive_speed)]
    pub(crate) pace: Option<Speed>,
    /// Leave out the strokes, or points, before this one, in the order in which they are drawn
    #[arg(help_heading = "At the wall", long, value_name = "N", default_value_t = 1, allow_hyphen_values = true, value_parser = clap::value_parser!(u32).range(1..), conflicts_with = "camera")]
    pub(crate) from_stroke: u32,
    /// Folder for the results [default: out/<the picture's name>/, or the first of …-2/, …-3/ that is not there yet]
    #[arg(help_heading = "Output", long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Write a moving picture of the run too: an SVG that plays by itself in browsers and on pages, at most 12 s long
    #[arg(help_heading = "Output", long, value_name = "FILE.svg", value_parser = film)]
    pub(crate) film: Option<String>,
    /// Everything, with the laser's gate held dark
    #[arg(help_heading = "Rig and law", long)]
    pub(crate) dry_run: bool,
    /// Show the report in the browser when done
    #[arg(help_heading = "Output", long)]
    pub(crate) open: bool,
    #[command(flatten, next_help_heading = "Output")]
    pub(crate) voice: Voice,
    /// Places that are marked in place of a picture's, as `point` was told.
    #[arg(skip)]
    pub(crate) at: Vec<Offset>,
    /// The command as it was given, without the program's name.
    #[arg(skip)]
    pub(crate) typed: Vec<String>,
}

/// The name of a film.
fn film(text: &str) -> Result<String, String> {
    let is_svg = text.to_ascii_lowercase().ends_with(".svg");
    is_svg.then(|| text.to_owned()).ok_or_else(|| format!("{text} does not end in .svg, which a film is"))
}

impl TraceArgs {
    /// Refuses what only a camera has use for without one: of a flag whose camera conflicts with the picture the parser asks no camera.
    pub(crate) fn check_camera(&self) -> Result<(), Failure> {
        let flags = [
            ("--home", self.home),
            ("--calibration", self.eye.calibration.is_some()),
            ("--open-loop", self.follow.open_loop),
            ("--sim-camera", self.eye.sim_camera != SimulatedEyeName::default()),
        ];
        if self.wall.is_given() && self.eye.camera.is_some() {
            let message = "--align, --from, --fit and --no-go place a drawing, and what a camera sees is drawn where it is: leave them or --camera out";
            return Err(Failure::usage("usage", message));
        }
        if self.head.is_some() && self.eye.camera.is_none() && self.driving.distance.is_some() {
            let message = "--head says where the head stands, and --distance too: leave one of them out";
            return Err(Failure::usage("usage", message));
        }
        if self.eye.camera.is_some() && self.by_hand.frame.is_some() {
            let message = "--frame shows where a drawing will be, and what a camera sees is drawn where it is: leave --frame or --camera out";
            return Err(Failure::usage("usage", message));
        }
        let follows = self.follow.open_loop || !self.follow.sim_trouble.is_empty() || self.home;
        if follows && self.eye.camera.is_some() && !self.is_simulated() {
            let message = "--home, --open-loop and --sim-trouble are for simulated rooms, as no real head is driven yet: give --camera sim:PICTURE";
            return Err(Failure::usage("usage", message));
        }
        match flags.iter().find(|(_, is_set)| *is_set && self.eye.camera.is_none()) {
            Some((flag, _)) => {
                Err(Failure::usage("usage", format!("{flag} is for what a camera sees: give --camera")))
            }
            None => Ok(()),
        }
    }

    /// Refuses of a head at a port what only a simulated one can do.
    pub(crate) fn check_port(&self) -> Result<(), Failure> {
        let flags = [
            ("--camera", self.eye.camera.is_some(), "a real camera does not follow a real head yet"),
            ("--laps", self.laps > 1, "what is identified between laps is not sent to a board yet"),
            ("--sim-trouble", !self.follow.sim_trouble.is_empty(), "that goes wrong in simulations alone"),
            ("--sim-unhomed", self.sim_unhomed, "that is for simulated heads"),
            ("--real-time", self.by_hand.real_time.is_some(), "a board keeps real time by itself"),
        ];
        match flags.into_iter().find(|(_, is_set, _)| *is_set) {
            Some((flag, _, why)) => {
                let message = format!("{flag} with --rig {}: {why}; leave it out", self.driving.rig);
                Err(Failure::usage("usage", message))
            }
            None => Ok(()),
        }
    }

    /// Why a run of it cannot be gone on with, and what to do; nothing where it can.
    pub(crate) fn cannot_resume(&self) -> Option<String> {
        let anew = format!("begin anew with tracelight {}", self.typed.join(" "));
        if self.eye.camera.is_some() {
            let why = "a camera followed it, and where the head then stood only that run knew";
            return Some(format!("{why}; {anew}"));
        }
        if self.laps > 1 {
            return Some(format!("it was to be drawn {} times; {anew}, or with fewer --laps", self.laps));
        }
        if self.is_by_steps() {
            let word = if self.step { "stroke" } else { "point" };
            return Some(format!(
                "it went from {word} to {word}; begin anew with {}, the first one that is not done yet",
                if self.at.is_empty() { "--from-stroke N" } else { "the places that are left" }
            ));
        }
        let is_gone = self.name() == "-";
        is_gone.then(|| format!("its picture came from standard input, and is gone; {anew}, or from a file"))
    }

    /// Whether somebody goes from stroke to stroke, or from point to point.
    pub(crate) const fn is_by_steps(&self) -> bool {
        self.step || self.points.is_some()
    }

    /// The places that are to be marked, where some are.
    pub(crate) fn points(&self) -> Option<Points> {
        let TypedKinds(kinds) = self.points.clone()?;
        let (mark, corner_rad) = (self.mark.unwrap_or_default(), self.tracing.corner_angle.0);
        Some(Points { kinds, mark, corner_rad, as_told: !self.at.is_empty() })
    }

    /// Refuses to go from stroke to stroke where nobody can ask for the next; who has a seat elsewhere can.
    pub(crate) fn check_keys(&self, is_seated: bool) -> Result<(), Failure> {
        let by_keys = self.by_hand.each.is_none();
        let flags = [
            ("--step", self.step && by_keys),
            (if self.at.is_empty() { "--points" } else { "point" }, self.points.is_some() && by_keys),
            ("--frame", self.by_hand.frame.is_some()),
        ];
        let waits = flags.iter().find(|(_, is_set)| *is_set);
        let message = match waits {
            _ if self.pace.is_some() && !self.is_by_steps() => {
                "--pace is the speed of --step and --points: give one of them, or --speed".to_owned()
            }
            _ if self.by_hand.frame.is_some() && self.laps > 1 => {
                "--frame shows one drawing before it is drawn once: leave it or --laps out".to_owned()
            }
            _ if self.by_hand.each.is_some() && !self.is_by_steps() => {
                "--each is how long --step and --points stay on one: give one of them".to_owned()
            }
            Some((flag, _)) if !is_seated && !std::io::stdin().is_terminal() => {
                let each = if *flag == "--frame" { "" } else { ", or give --each TIME" };
                format!(
                    "{flag} waits for keys, and standard input is no terminal: start it in one, without < or |{each}"
                )
            }
            _ => return Ok(()),
        };
        Err(Failure::usage("usage", message))
    }

    /// What of a camera was set, flag and value; nothing without one.
    pub(crate) fn seen_settings(&self) -> Vec<(&'static str, String)> {
        if self.eye.camera.is_none() {
            return Vec::new();
        }
        let file = |file: Option<&String>| file.cloned().unwrap_or_else(|| "none".to_owned());
        vec![
            ("simulated camera", format!("{:?}", self.eye.sim_camera).to_lowercase()),
            ("calibration", file(self.eye.calibration.as_ref())),
            ("head", file(self.head.as_ref())),
            ("homed first", if self.home { "yes" } else { "no" }.to_owned()),
            ("retakes", self.retakes.to_string()),
            ("loop through the camera", self.loop_words().to_owned()),
        ]
    }

    /// Whether a simulated head was just powered up.
    pub(crate) const fn is_powered_up(&self) -> bool {
        self.sim_unhomed || self.home
    }

    fn is_simulated(&self) -> bool {
        self.eye.source().is_ok_and(|source| matches!(source, Source::Simulated(_)))
    }

    fn loop_words(&self) -> &'static str {
        match (self.is_simulated(), self.follow.open_loop) {
            (false, _) => "none",
            (true, true) => "open",
            (true, false) => "closed",
        }
    }

    /// The picture's name, or the camera's.
    pub(crate) fn name(&self) -> &str {
        self.picture.as_deref().or(self.lettering.name()).or(self.eye.camera.as_deref()).unwrap_or_default()
    }
}
