use clap::Args;
use tracelight_aim::cornered;
use tracelight_eye::corners::{CORNERS, Truth, angles, json, read, text};
use tracelight_eye::pointed::pointed;
use tracelight_files as files;
use tracelight_rig::PanTilt;
use tracelight_rigfile as rigfile;
use tracelight_rigfile::head::{HeadFile, HeadScore, NewHead};
use tracelight_task::Failure;
use tracelight_units::Offset;

use crate::cli::answer::{Answer, Voice};
use crate::cli::ending::toml;
use crate::named;
use tracelight_flags::positive_length;

/// Where the head stands, from the joint angles at which its dot is on the corners of a rectangle; without a camera
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight calibrate corners --size 2.4m,1.2m --simulate -o head.toml\n\n\
                  Mark the corners of a rectangle on the wall, or take those of a door or a board, and measure its width and height. Turn the head until its dot is on each \
                  corner, and write down pan and tilt there. Then tell them, --bottom-left 21.3deg,12.9deg and so on, or as a file: a line a corner, such as \
                  bottom-left,21.3deg,12.9deg. The middle of the rectangle becomes the target's middle. `trace` and `plan` take the file by --head.")]
pub(super) struct CornersArgs {
    /// Width and height of the rectangle, such as 2.4m,1.2m
    #[arg(long, value_name = "WIDTH,HEIGHT", allow_hyphen_values = true, value_parser = size)]
    size: Offset,
    /// Pan and tilt with the dot on the bottom left corner, such as 21.3deg,12.9deg
    #[arg(long, value_name = "PAN,TILT", allow_hyphen_values = true, value_parser = angles)]
    bottom_left: Option<PanTilt<f64>>,
    /// Pan and tilt with the dot on the bottom right corner
    #[arg(long, value_name = "PAN,TILT", allow_hyphen_values = true, value_parser = angles)]
    bottom_right: Option<PanTilt<f64>>,
    /// Pan and tilt with the dot on the top right corner
    #[arg(long, value_name = "PAN,TILT", allow_hyphen_values = true, value_parser = angles)]
    top_right: Option<PanTilt<f64>>,
    /// Pan and tilt with the dot on the top left corner
    #[arg(long, value_name = "PAN,TILT", allow_hyphen_values = true, value_parser = angles)]
    top_left: Option<PanTilt<f64>>,
    /// A file with the angles: a line a corner, such as bottom-left,21.3deg,12.9deg
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["bottom_left", "bottom_right", "top_right", "top_left"])]
    angles: Option<String>,
    /// A simulated person points a simulated head, which stands where nobody knows; how far the result truly is off is told
    #[arg(long, conflicts_with_all = ["angles", "bottom_left", "bottom_right", "top_right", "top_left"])]
    simulate: bool,
    /// Rig: a preset's name (see `tracelight rigs`) or a rig file
    #[arg(long, value_name = "RIG.toml|PRESET", default_value = "report")]
    rig: String,
    /// File for what is found
    #[arg(short, long, value_name = "FILE.toml", default_value = "head.toml", value_parser = toml)]
    output: String,
    /// Where a simulated head stands and how well somebody points is drawn from this seed
    #[arg(long, value_name = "N", default_value_t = 0, allow_hyphen_values = true)]
    seed: u64,
    #[command(flatten)]
    pub(super) voice: Voice,
}

fn size(text: &str) -> Result<Offset, String> {
    let (width, height) = text
        .split_once(',')
        .ok_or_else(|| format!("{text} is no size: give width and height, such as 2.4m,1.2m"))?;
    Ok(Offset(positive_length(width)?, positive_length(height)?))
}

pub(super) fn run(args: &CornersArgs) -> Result<Answer, Failure> {
    let rig = named::rig(&args.rig)?;
    let size_m = (args.size.0.0, args.size.1.0);
    let simulated = args.simulate.then(|| pointed(&rig, size_m, args.seed)).transpose()?;
    let angles = match &simulated {
        Some(pointed) => pointed.angles,
        None => told(args)?,
    };
    let found = cornered(&rig.model.geometry, size_m, &angles, rig.model.encoder.count_rad())
        .map_err(|e| Failure::failed("corners", format!("calibrate corners: {e}")))?;
    let file = HeadFile::of(&NewHead {
        date: &named::today(),
        rig: &rig.name,
        geometry: rig.model.geometry,
        pose: found.pose,
        score: HeadScore { rms_m: found.rms_m(), spots: 4, outliers: 0 },
        images: None,
        area_m: Some(size_m),
        frame: None,
        pages: &[],
    });
    files::write(&args.output, rigfile::head::write(&file)?)?;
    let truth = simulated.map(|pointed| Truth::of(&rig, size_m, &found.pose, &pointed));
    let text = format!("{}\nfile:     {}", text(&found, truth.as_ref()), args.output);
    Ok(Answer::new(text, json(&angles, &found, truth.as_ref())))
}

/// The angles of all four corners, from flags or a file.
fn told(args: &CornersArgs) -> Result<[PanTilt<f64>; 4], Failure> {
    if let Some(path) = &args.angles {
        return read(path, files::read(path)?);
    }
    let given = [args.bottom_left, args.bottom_right, args.top_right, args.top_left];
    let missing: Vec<String> = CORNERS
        .iter()
        .zip(&given)
        .filter(|(_, angle)| angle.is_none())
        .map(|(name, _)| format!("--{name}"))
        .collect();
    match given {
        [Some(a), Some(b), Some(c), Some(d)] => Ok([a, b, c, d]),
        _ => {
            let message = format!(
                "pan and tilt at all four corners are needed, {} missing: give them, such as --top-left 21.3deg,-12.9deg, or --simulate to try it",
                if missing.len() == 1 {
                    format!("{} is", missing[0])
                } else {
                    format!("{} are", missing.join(", "))
                }
            );
            Err(Failure::usage("usage", message))
        }
    }
}
