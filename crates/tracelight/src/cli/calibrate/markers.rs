use clap::Args;
use serde_json::{Value, json};
use tracelight_aim::{Board, LensBelief, PlacedPage, SeenTag, Survey, SurveyedCamera, survey};
use tracelight_camera::Source;
use tracelight_eye::board::BAR_M;
use tracelight_eye::grey;
use tracelight_eye::wall::{doubts, markers, well_exposed};
use tracelight_files as files;
use tracelight_image::Grey;
use tracelight_maths::atan;
use tracelight_picture as picture;
use tracelight_pipeline::Placing;
use tracelight_rigfile as rigfile;
use tracelight_rigfile::PageName;
use tracelight_rigfile::camera::{CameraFile, Wall};
use tracelight_stroke::Point;
use tracelight_task::{Failure, Stop};
use tracelight_units::Length;

use crate::cli::answer::{Answer, Voice};
use crate::cli::ending::toml;
use crate::cli::eyes::{ImageSize, SimulatedEyeName, SimulatedWall, looking};
use crate::named;
use tracelight_flags::positive_length;

/// Camera in front of the wall, from an image of printed markers on it: lens, pose and scale
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight calibrate markers examples/lens/near.jpg -o camera.toml\n\n\
                  `tracelight calibrate sheet` prints the pages. Stick them on the wall near the corners of where you will draw, take an image that shows them \
                  all, sharp and not glared at, and leave the camera where it is. Perspective and the lens's distortion are found from that one image; \
                  a lens that was calibrated before (--lens) makes it surer, above all with one page. The target's frame is that of the first page: \
                  origin in the middle of its markers, x to its right. What is likely to be off is told in mm.")]
pub(super) struct MarkersArgs {
    /// Image of the wall with the marker pages on it
    #[arg(required_unless_present = "camera", conflicts_with = "camera")]
    image: Option<String>,
    /// Camera that takes the image: sim (simulated), /dev/video0 (connected), http://… (network camera)
    #[arg(long, value_name = "SOURCE")]
    camera: Option<String>,
    /// Columns and rows of the images of a connected camera [default: those of --lens, or else about 1280x720]
    #[arg(long, value_name = "WxH", requires = "camera")]
    camera_size: Option<ImageSize>,
    /// Simulated camera
    #[arg(long, value_enum, default_value_t, requires = "camera")]
    sim_camera: SimulatedEyeName,
    /// Random seed for the simulated room
    #[arg(long, value_name = "N", default_value_t = 0, allow_hyphen_values = true, requires = "camera")]
    seed: u64,
    /// Calibrated lens: a file that `calibrate lens` or `calibrate markers` has written
    #[arg(long, value_name = "FILE.toml")]
    lens: Option<String>,
    /// Printed length of the bar at the foot of a page [default: 150mm]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = positive_length)]
    bar: Option<Length>,
    /// Camera file to write
    #[arg(short, long, value_name = "FILE.toml", default_value = "camera.toml", value_parser = toml)]
    output: String,
    #[command(flatten)]
    pub(super) voice: Voice,
}

/// Camera's lens, from images of printed markers taken from several sides
#[derive(Args, Debug)]
#[command(
    after_help = "Example: tracelight calibrate lens examples/lens/left.jpg examples/lens/right.jpg examples/lens/above.jpg -o lens.toml\n\n\
                  `tracelight calibrate sheet` prints the pages. Leave them where they are and take at least three images from several sides, the pages \
                  large and out in the corners, too; zoom and focus as they will be. The first is as good as any."
)]
pub(super) struct LensArgs {
    /// Images of the same pages
    #[arg(required = true, num_args = 1..)]
    images: Vec<String>,
    /// Printed length of the bar at the foot of a page [default: 150mm]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = positive_length)]
    bar: Option<Length>,
    /// Camera file to write
    #[arg(short, long, value_name = "FILE.toml", default_value = "lens.toml", value_parser = toml)]
    output: String,
    #[command(flatten)]
    pub(super) voice: Voice,
}

/// Fewest images that tell a lens.
const FEWEST_IMAGES: usize = 3;
/// A lens is known if its focal length is, to this share.
const KNOWN_FOCAL: f64 = 0.005;

pub(super) fn run(args: &MarkersArgs, stop: &Stop) -> Result<Answer, Failure> {
    let known = args.lens.as_deref().map(named::camera).transpose()?.map(|known| known.lens);
    let seen = match (&args.image, &args.camera) {
        (Some(path), _) => Seen::of(vec![found(path)?], args.bar.as_ref(), known.as_ref())?,
        (None, source) => {
            let name = source.as_deref().unwrap_or("sim");
            Seen::of(vec![taken(args, name, known.as_ref(), stop)?], args.bar.as_ref(), known.as_ref())?
        }
    };
    let camera =
        seen.survey.camera(0).ok_or_else(|| Failure::failed("internal", "a survey without a camera"))?;
    let wall = Wall::of(&seen.survey, &camera);
    let file = CameraFile::of(&seen.survey, Some((&camera, wall)), seen.scale, &named::today());
    files::write(&args.output, rigfile::camera::write(&file)?)?;
    let text = format!(
        "{}\n{}\n{}\n{}",
        seen.lens_text(),
        stands(&camera),
        seen.markers_text(),
        wall_text(&wall, &camera, &args.output)
    ) + &seen.warnings_text();
    let mut object = seen.json();
    object["pose"] = json!({
        "turn_rad": camera.camera.pose.turn_rad(),
        "translation_m": camera.camera.pose.translation_m(),
        "place_m": camera.camera.pose.place_m(),
    });
    object["wall_mm"] = json!({"between_pages": mm(wall.between_m), "image": mm(wall.image_m)});
    Ok(Answer::new(text, object.to_string()))
}

pub(super) fn lens(args: &LensArgs) -> Result<Answer, Failure> {
    if args.images.len() < FEWEST_IMAGES {
        let message = format!(
            "{} images tell no lens: take at least {FEWEST_IMAGES}, from several sides",
            args.images.len()
        );
        return Err(Failure::usage("usage", message));
    }
    let views: Result<Vec<View>, Failure> = args.images.iter().map(|path| found(path)).collect();
    let seen = Seen::of(views?, args.bar.as_ref(), None)?;
    let file = CameraFile::of(&seen.survey, None, seen.scale, &named::today());
    files::write(&args.output, rigfile::camera::write(&file)?)?;
    let belief = &seen.survey.belief;
    let share = belief.covariance[(0, 0)].sqrt() / belief.lens.focal_px[0];
    let sure = if share > KNOWN_FOCAL {
        format!(
            "\nwarning: the focal length is known to {:.1} % only; add images from further to the side, from above and below",
            100.0 * share
        )
    } else {
        String::new()
    };
    let doubts = seen.warnings_text();
    let text =
        format!("{}\n{}\nfile:     {}{sure}{doubts}", seen.lens_text(), seen.markers_text(), args.output);
    Ok(Answer::new(text, seen.json().to_string()))
}

/// What images show, and what that tells.
struct Seen {
    survey: Survey,
    markers: usize,
    /// How much larger than meant the pages are printed.
    scale: f64,
}

impl Seen {
    fn of(views: Vec<View>, bar: Option<&Length>, known: Option<&LensBelief>) -> Result<Self, Failure> {
        let scale = bar.map_or(1.0, |bar| bar.0 / BAR_M);
        if !(0.5..=2.0).contains(&scale) {
            let message =
                format!("--bar is {:.1} mm; as meant it is {:.0} mm", 1e3 * scale * BAR_M, 1e3 * BAR_M);
            return Err(Failure::usage("usage", message));
        }
        let mut size: Option<(usize, usize)> = known.map(|known| known.lens.size_px.into());
        for View { name, size: own, .. } in &views {
            let wanted = *size.get_or_insert(*own);
            if *own != wanted {
                let message = format!(
                    "{name} has {} × {} px, not {} × {} as the others",
                    own.0, own.1, wanted.0, wanted.1
                );
                return Err(Failure::usage("camera-image", message));
            }
        }
        let names = views.iter().map(|view| view.name.as_str()).collect::<Vec<_>>().join(", ");
        let views: Vec<Vec<SeenTag>> = views.into_iter().map(|view| view.tags).collect();
        let (width, height) = size.unwrap_or_default();
        let belief = known.copied().unwrap_or_else(|| LensBelief::unknown(width, height));
        let boards = Board::ALL.map(|board| board.scaled(scale));
        let markers = views.iter().map(Vec::len).sum();
        let survey = survey(&belief, &boards, &views)
            .map_err(|e| Failure::failed("camera-not-found", format!("{names}: {e}")))?;
        Ok(Self { survey, markers, scale })
    }

    fn lens_text(&self) -> String {
        let (lens, covariance) = (&self.survey.belief.lens, &self.survey.belief.covariance);
        let wide = 2.0 * atan(lens.size_px[0] as f64 / 2.0 / lens.focal_px[0]).to_degrees();
        let sure = |k: usize| 2.0 * covariance[(k, k)].sqrt();
        format!(
            "lens:     {} × {} px, focal length {:.1} ± {:.1} px ({wide:.0}° wide), centre ({:.1}, {:.1}) px, k1 {:.4} ± {:.4}, k2 {:.4} ± {:.4}",
            lens.size_px[0],
            lens.size_px[1],
            lens.focal_px[0],
            sure(0),
            lens.centre_px.x,
            lens.centre_px.y,
            lens.radial[0],
            sure(4),
            lens.radial[1],
            sure(5)
        )
    }

    fn markers_text(&self) -> String {
        let pages: Vec<String> =
            self.survey.pages.iter().map(|page| PageName::of(page).to_string()).collect();
        let s = if pages.len() == 1 { "" } else { "s" };
        format!(
            "markers:  {} on page{s} {}; {} places where black meets white, {:.3} px off, rms",
            self.markers,
            pages.join(", "),
            self.survey.places,
            self.survey.rms_px
        )
    }

    fn warnings_text(&self) -> String {
        let warnings = doubts(&self.survey);
        if warnings.is_empty() {
            return String::new();
        }
        let lines = warnings.iter().map(|warning| format!("\nwarning:  {warning}"));
        lines.collect::<String>() + "\n          the wall may be further off than told"
    }

    fn json(&self) -> Value {
        let lens = &self.survey.belief.lens;
        let page = |page: &PlacedPage| json!({"page": page.page + 1, "middle_m": [page.middle.x, page.middle.y], "turn_rad": page.turn_rad});
        json!({
            "lens": {
                "size_px": lens.size_px,
                "focal_px": lens.focal_px,
                "centre_px": [lens.centre_px.x, lens.centre_px.y],
                "radial": lens.radial,
                "tangential": lens.tangential,
            },
            "pages": self.survey.pages.iter().map(page).collect::<Vec<_>>(),
            "markers": self.markers,
            "places": self.survey.places,
            "rms_px": self.survey.rms_px,
            "warnings": doubts(&self.survey),
        })
    }
}

/// Markers of an image, and its size.
struct View {
    name: String,
    tags: Vec<SeenTag>,
    size: (usize, usize),
}

impl View {
    fn of(name: &str, grey: &Grey) -> Self {
        Self { name: name.to_owned(), tags: markers(grey), size: (grey.width(), grey.height()) }
    }
}

fn found(path: &str) -> Result<View, Failure> {
    let picture::Source::Pixels(pixels) = named::picture(path)? else {
        let message = format!("{path} is a drawing; give an image that a camera took");
        return Err(Failure::usage("not-a-picture", message));
    };
    Ok(View::of(path, &pixels.grey))
}

/// An image of a camera.
fn taken(args: &MarkersArgs, name: &str, known: Option<&LensBelief>, stop: &Stop) -> Result<View, Failure> {
    let source = Source::of(name)?;
    let size = args.camera_size.map(|size| size.0).or_else(|| known.map(|known| known.lens.size_px));
    let wall =
        SimulatedWall { eye: args.sim_camera, placing: Placing::default(), pages: true, seed: args.seed };
    let pixels = well_exposed(&mut *looking(source.open(size)?, &wall)?, stop)?;
    Ok(View::of(name, &grey(&pixels)?))
}

fn stands(camera: &SurveyedCamera) -> String {
    let [x, y, z] = camera.camera.pose.place_m();
    let sideways =
        |v: f64, more: &str, less: &str| format!("{:.3} m {}", v.abs(), if v < 0.0 { less } else { more });
    format!(
        "stands:   {z:.3} m before the wall, {} and {} the middle of the first page, as that is printed",
        sideways(x, "right of", "left of"),
        sideways(y, "above", "below")
    )
}

fn mm(m: Option<f64>) -> Option<f64> {
    m.map(|m| 1e3 * m)
}

/// How well the wall is known, and where that is written.
fn wall_text(wall: &Wall, camera: &SurveyedCamera, output: &str) -> String {
    let [width, height] = camera.camera.lens.size_px.map(|n| n as f64);
    let scale = camera.camera.target(Point::new(width / 2.0, height / 2.0));
    let scale = scale
        .and_then(|at| camera.camera.scale(at))
        .map_or_else(String::new, |scale| format!("; {:.2} px/mm in the middle of the image", 1e-3 * scale));
    let off = |m: Option<f64>| m.map_or_else(|| "unknown".to_owned(), |m| format!("{:.2} mm", 1e3 * m));
    let (between, image) = (off(wall.between_m), off(wall.image_m));
    format!(
        "wall:     a point of it is likely to be off by {between} rms between the pages, {image} all over the image{scale}\nfile:     {output}"
    )
}
