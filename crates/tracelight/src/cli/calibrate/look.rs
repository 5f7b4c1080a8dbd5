use std::time::{Duration, Instant};

use clap::Args;
use serde_json::{Value, json};
use tracelight_eye::sight::Sight;
use tracelight_eye::wall::{readable, well_exposed, well_exposed_for};
use tracelight_files as files;
use tracelight_flags::PlacementArgs;
use tracelight_picture::Raster;
use tracelight_rigfile as rigfile;
use tracelight_rigfile::{Calibrated, Of};
use tracelight_task::{Failure, Stop};

use crate::cli::answer::{Answer, Voice};
use crate::cli::ending::ends_in;
use crate::cli::eyes::{EyeArgs, SimulatedWall, looking};

/// Quality of the JPEG that is written.
const QUALITY: u8 = 88;
/// How often whoever looks on is shown an image, and how often its exposure is found anew: the light changes.
const EACH: Duration = Duration::from_millis(250);
const EXPOSE: Duration = Duration::from_secs(10);

/// What a camera sees of the wall: which pages of markers are in sight, and whether a calibration still holds
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight calibrate look --camera sim:examples/house.png -o wall.jpg\n\n\
                  Before `calibrate markers`: pages that are missing, cut off or in the dark are named. With --calibration it is told whether the camera stands where it was calibrated.")]
pub(crate) struct LookArgs {
    #[command(flatten)]
    eye: EyeArgs,
    #[command(flatten, next_help_heading = "Simulation")]
    placement: PlacementArgs,
    /// Random seed for the simulated room
    #[arg(
        help_heading = "Simulation",
        long,
        value_name = "N",
        default_value_t = 0,
        allow_hyphen_values = true,
        requires = "camera"
    )]
    seed: u64,
    /// Write the image, as .jpg
    #[arg(short, long, value_name = "FILE.jpg", value_parser = jpeg)]
    output: Option<String>,
    #[command(flatten)]
    pub(super) voice: Voice,
}

fn jpeg(text: &str) -> Result<String, String> {
    ends_in(text, "jpg", "an image is written as JPEG: end it in .jpg")
}

pub(super) fn run(args: &LookArgs, stop: &Stop) -> Result<Answer, Failure> {
    let known = args.eye.known()?;
    let pixels = well_exposed(&mut *looking(args.eye.open()?, &args.wall()?)?, stop)?;
    let sight = Sight::of(&pixels, known.as_ref())?;
    if let Some(path) = &args.output {
        files::write(path, coded(&pixels)?)?;
    }
    let file = args.output.as_ref().map_or_else(String::new, |path| format!("\nfile:     {path}"));
    Ok(Answer::new(format!("{}{file}", sight.words()), sight.json().to_string()))
}

/// Shows somebody one image after the other, as JPEG and in figures, until he wants no more.
///
/// # Errors
/// What the camera fails with; or [`Failure::interrupted`].
pub(crate) fn watch(
    args: &LookArgs,
    stop: &Stop,
    each: &mut dyn FnMut(Vec<u8>, Value) -> bool,
) -> Result<(), Failure> {
    let known = args.eye.known()?;
    let mut camera = looking(args.eye.open()?, &args.wall()?)?;
    let mut exposed: Option<(Instant, f64)> = None;
    loop {
        let begun = Instant::now();
        let pixels = match exposed.filter(|(at, _)| at.elapsed() < EXPOSE) {
            Some((_, exposure_s)) => readable(&mut *camera, exposure_s, stop)?.0,
            None => {
                let (pixels, exposure_s) = well_exposed_for(&mut *camera, stop)?;
                exposed = Some((begun, exposure_s));
                pixels
            }
        };
        let sight = Sight::of(&pixels, known.as_ref())?;
        if !each(coded(&pixels)?, sight.json()) {
            return Ok(());
        }
        stop.check()?;
        std::thread::sleep(EACH.saturating_sub(begun.elapsed()));
    }
}

fn coded(pixels: &Raster) -> Result<Vec<u8>, Failure> {
    pixels.jpeg(QUALITY).map_err(|e| Failure::failed("camera-image", e))
}

impl LookArgs {
    fn wall(&self) -> Result<SimulatedWall, Failure> {
        Ok(SimulatedWall {
            eye: self.eye.sim_camera,
            placing: self.placement.placing(),
            pages: self.eye.has_pages()?,
            seed: self.seed,
        })
    }
}

/// What a calibration file says of itself: of what it is, from which day, and how exact
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight calibrate show examples/lens/camera.toml\n\n\
                  A point of the wall that is likely to be off by at most 0.2 mm is called great, by at most 1 mm usable, by more poor.")]
pub(super) struct ShowArgs {
    /// Files that `calibrate` has written: of cameras, lenses, heads
    #[arg(required = true, num_args = 1..)]
    files: Vec<String>,
    #[command(flatten)]
    pub(super) voice: Voice,
}

pub(super) fn show(args: &ShowArgs) -> Result<Answer, Failure> {
    let read = |path: &String| Ok((path.clone(), rigfile::calibrated(path, files::read(path)?)?));
    let all: Vec<(String, Calibrated)> = args.files.iter().map(read).collect::<Result<_, Failure>>()?;
    let text: Vec<String> = all.iter().map(|(path, told)| words(path, told)).collect();
    let json: Vec<Value> = all.iter().map(|(path, told)| object(path, told)).collect();
    Ok(Answer::new(text.join("\n"), json!({ "calibrations": json }).to_string()))
}

fn words(path: &str, told: &Calibrated) -> String {
    let Calibrated { of, date, off_m, size_px, pages, rig, area_m } = told;
    let off = match (of, off_m, told.verdict()) {
        (Of::Lens, ..) => "wherever it stands".to_owned(),
        (_, Some(m), Some(verdict)) => format!("{}: off by {:.2} mm, rms", verdict.word(), 1e3 * m),
        _ => "how far it is off is not known".to_owned(),
    };
    let size = size_px.map(|[width, height]| format!("{width} × {height} px"));
    let seen = (*pages > 0).then(|| format!("pages of markers: {pages}"));
    let area = area_m.map(|(width, height)| format!("by the corners of {width:.3} × {height:.3} m"));
    let rig = rig.as_ref().map(|rig| format!("rig {rig}"));
    let more: Vec<String> = [rig, size, seen, area].into_iter().flatten().collect();
    let more = if more.is_empty() { String::new() } else { format!("; {}", more.join(", ")) };
    format!("{:<9} {path}, of {date}; {off}{more}", format!("{}:", of.word()))
}

fn object(path: &str, told: &Calibrated) -> Value {
    json!({
        "file": path,
        "of": told.of.word(),
        "date": told.date,
        "off_mm": told.off_m.map(|m| 1e3 * m),
        "verdict": told.verdict().map(rigfile::Verdict::word),
        "size_px": told.size_px,
        "pages": told.pages,
        "rig": told.rig,
        "area_m": told.area_m.map(|(width, height)| [width, height]),
    })
}
