use std::path::PathBuf;

use clap::{Args, ValueEnum};
use tracelight_vision::Mode;

use crate::cli::driving::DrivingArgs;
use crate::cli::placing::PlacementArgs;
use crate::cli::{Answer, Voice};
use crate::failure::Failure;
use crate::job::{self, Outcome};
use crate::output::Summary;
use crate::stop::Stop;

/// Draw a picture on the target: find its strokes, plan them, run them, show how exact it was
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight trace examples/house.png --width 24in --speed 1ft/s --open")]
pub(crate) struct TraceArgs {
    /// PNG, JPEG, WebP, BMP, GIF, PNM, TIFF; or SVG, JSON, CSV with strokes to be taken as they are; - is standard
    /// input
    pub(crate) picture: String,
    /// How pixels become strokes
    #[arg(long, value_enum, default_value_t)]
    pub(crate) mode: ModeName,
    #[command(flatten)]
    pub(crate) placement: PlacementArgs,
    #[command(flatten)]
    pub(crate) driving: DrivingArgs,
    /// Draw it that many times, each from power-up; the figures are the last lap's
    #[arg(long, value_name = "N", default_value_t = 1, allow_hyphen_values = true, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) laps: u32,
    /// What differs from head to head is drawn from this seed
    #[arg(long, value_name = "N", default_value_t = 0, allow_hyphen_values = true)]
    pub(crate) seed: u64,
    /// Folder for the results [default: out/<the picture's name>/]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Everything, with the laser's gate held dark
    #[arg(long)]
    pub(crate) dry_run: bool,
    /// Show the report in the browser when done
    #[arg(long)]
    pub(crate) open: bool,
    #[command(flatten)]
    pub(crate) voice: Voice,
}

/// How pixels become strokes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum ModeName {
    /// Each part by its width: pen lines as centrelines, shapes as outlines
    #[default]
    Auto,
    /// The middle of every line
    Centreline,
    /// The edge of all ink
    Outline,
    /// The 2006 report's radial sweep round one closed figure, for comparison
    Sweep,
}

impl From<ModeName> for Mode {
    fn from(name: ModeName) -> Self {
        match name {
            ModeName::Auto => Mode::Auto,
            ModeName::Centreline => Mode::Centreline,
            ModeName::Outline => Mode::Outline,
            ModeName::Sweep => Mode::Sweep,
        }
    }
}

pub(crate) fn run(args: &TraceArgs, stop: &Stop) -> Result<Answer, Failure> {
    let Outcome { summary, dir, failure } = job::trace(args, stop)?;
    if args.open {
        open(&dir.join("report.html"));
    }
    let text = format!("{}\nreport: {}", text(&summary), dir.join("report.html").display());
    Ok(Answer { text, json: summary.json(), failure })
}

fn text(s: &Summary) -> String {
    let mm = |m: f64| m * 1e3;
    let mut text = format!(
        "{}: {} strokes, {:.3} m of line at {:.0} × {:.0} mm\n\
         time:   {:.2} s, of it lit {:.2} s at {:.3} m/s; torque up to {:.0} %",
        s.picture.path,
        s.strokes.count,
        s.strokes.length_m,
        mm(s.target.width_m),
        mm(s.target.height_m),
        s.run.duration_s,
        s.laser.lit_s,
        s.tracking.lit_speed_m_s,
        100.0 * s.plan.torque_peak_fraction,
    );
    if (s.run.duration_s - s.plan.duration_s).abs() > 0.01 {
        text += &format!("\n        (planned: {:.2} s)", s.plan.duration_s);
    }
    text += &match s.laser.lit_s > 0.0 {
        true => format!(
            "\nerror:  {:.3} mm rms, {:.3} mm at most; overshoot {:.2} %, {:.3} mm at rest",
            s.tracking.rms_mm, s.tracking.max_mm, s.tracking.overshoot_percent, s.tracking.final_error_mm,
        ),
        false => "\nerror:  none to measure, nothing was lit".to_owned(),
    };
    match s.laser.faults.len() {
        0 => {}
        1 => text += "\ndark:   once where light was planned; the report says when and why",
        n => text += &format!("\ndark:   {n} times where light was planned; the report says when and why"),
    }
    text
}

/// Hands a page to whatever shows pages here. Failing to is not worth an error: the path is printed.
fn open(page: &std::path::Path) {
    let opener = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };
    let quiet = std::process::Stdio::null;
    drop(std::process::Command::new(opener).arg(page).stdout(quiet()).stderr(quiet()).spawn());
}
