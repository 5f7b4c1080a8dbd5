use std::path::{Path, PathBuf};

use clap::Args;
use tracelight_formats::json::Traced;
use tracelight_formats::{Sheet, json};
use tracelight_vision::Mode;

use crate::cli::placing::PlacementArgs;
use crate::cli::request::ModeName;
use crate::cli::{Answer, Voice};
use crate::failure::Failure;
use crate::output::drawing;
use crate::picture;
use crate::progress::Progress;
use crate::sketch::{Sketch, place, sketch};
use crate::stop::Stop;

/// How close `points` keep to their path, px.
const POINTS_TOLERANCE_PX: f64 = 0.05;

/// Find the strokes of pictures, without a rig
#[derive(Args, Debug)]
#[command(after_help = "Examples: tracelight strokes drawing.jpg -o drawing.svg --width 60cm\n          \
                        tracelight strokes *.png -o out/")]
pub(crate) struct StrokesArgs {
    /// Pictures or drawings; - is standard input
    #[arg(required = true, value_name = "PICTURE")]
    pictures: Vec<String>,
    /// Write the strokes here: .svg, .dxf, .gcode (GRBL laser) or .hpgl in true size, .ild (ILDA, over its whole
    /// range), .csv (metres), .json (pixels); a folder, with / at its end, for several pictures
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// How pixels become strokes
    #[arg(long, value_enum, default_value_t)]
    mode: ModeName,
    #[command(flatten)]
    placement: PlacementArgs,
    #[command(flatten)]
    pub(crate) voice: Voice,
}

pub(crate) fn run(args: &StrokesArgs, stop: &Stop) -> Result<Answer, Failure> {
    if let [only] = args.pictures.as_slice() {
        let (sketch, json) = one(args, only)?;
        return Ok(Answer::new(line(only, &sketch), json));
    }
    if args.out.as_ref().is_some_and(|out| !is_folder(out)) {
        let message = "several pictures need a folder: end --out with / (such as -o strokes/)";
        return Err(Failure::usage("usage", message));
    }
    many(args, stop)
}

/// Every picture, past those that fail.
fn many(args: &StrokesArgs, stop: &Stop) -> Result<Answer, Failure> {
    check_names(args)?;
    let progress = Progress::new(args.voice.quiet);
    progress.stage("strokes", args.pictures.len() as u64);
    let (mut lines, mut results, mut failed) = (Vec::new(), Vec::new(), Vec::new());
    for (index, picture) in args.pictures.iter().enumerate() {
        stop.check()?;
        match one(args, picture) {
            Ok((sketch, json)) => {
                lines.push(line(picture, &sketch));
                results.push(format!("{{\"picture\":{},\"strokes\":{json}}}", serde_json::json!(picture)));
            }
            Err(failure) => {
                failed.push(picture.as_str());
                lines.push(format!("{picture}: failed: {}", failure.message));
                let error = serde_json::json!({ "code": failure.code, "message": failure.message });
                results.push(format!("{{\"picture\":{},\"error\":{error}}}", serde_json::json!(picture)));
            }
        }
        progress.at(index as u64 + 1);
    }
    let mut answer = Answer::new(lines.join("\n"), format!("{{\"pictures\":[{}]}}", results.join(",")));
    if !failed.is_empty() {
        let message =
            format!("{} of {} pictures failed: {}", failed.len(), args.pictures.len(), failed.join(", "));
        answer.failure = Some(Failure::failed("no-strokes-found", message));
    }
    Ok(answer)
}

/// Two pictures must not end in one file.
fn check_names(args: &StrokesArgs) -> Result<(), Failure> {
    let mut stems: Vec<_> = args.pictures.iter().map(|p| Path::new(p).file_stem()).collect();
    stems.sort_unstable();
    match stems.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) if args.out.is_some() => {
            let name = pair[0].unwrap_or_default().to_string_lossy();
            let message =
                format!("two pictures are named {name}: --out would write them to one file; rename one");
            Err(Failure::usage("usage", message))
        }
        _ => Ok(()),
    }
}

fn one(args: &StrokesArgs, picture: &str) -> Result<(Sketch, String), Failure> {
    let sketch = sketch(picture, picture::read(picture)?, Mode::from(args.mode), &args.placement.choice)?;
    for remark in &sketch.remarks {
        Progress::new(args.voice.quiet).say(&format!("note: {picture}: {remark}"));
    }
    let json = pixel_json(&sketch);
    if let Some(out) = &args.out {
        let path = if is_folder(out) { in_folder(out, picture)? } else { out.clone() };
        write(&path, &sketch, args, &json)?;
    }
    Ok((sketch, json))
}

fn pixel_json(sketch: &Sketch) -> String {
    let sheet = Sheet {
        width: sketch.size.0,
        height: sketch.size.1,
        metres_per_unit: None,
        drawing: sketch.drawing.clone(),
    };
    json::write(&Traced { sheet, mode: sketch.mode.to_owned() }, POINTS_TOLERANCE_PX)
}

fn is_folder(path: &Path) -> bool {
    path.is_dir() || path.to_string_lossy().ends_with('/')
}

fn in_folder(folder: &Path, picture: &str) -> Result<PathBuf, Failure> {
    std::fs::create_dir_all(folder).map_err(|e| cannot_write(folder, &e))?;
    let stem = Path::new(picture).file_stem().unwrap_or_else(|| "strokes".as_ref());
    Ok(folder.join(format!("{}.svg", stem.to_string_lossy())))
}

fn write(path: &Path, sketch: &Sketch, args: &StrokesArgs, json: &str) -> Result<(), Failure> {
    drawing::write(path, &place(sketch, &args.placement), json)
}

fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    Failure::failed("cannot-write", format!("cannot write {}: {error}", path.display()))
}

fn line(picture: &str, sketch: &Sketch) -> String {
    // what has no true size is measured in its pixels
    let (scale, unit) = match sketch.true_width_m {
        Some(width_m) => (1e3 * width_m / sketch.size.0, "mm"),
        None => (1.0, "px"),
    };
    let closed = sketch.drawing.strokes.iter().filter(|s| s.path.is_closed()).count();
    format!(
        "{picture}: {} strokes ({closed} closed), {:.0} {unit} of line on a sheet of {:.0} × {:.0} {unit}, {:.0} ms",
        sketch.drawing.strokes.len(),
        sketch.drawing.length(1e-3) * scale,
        sketch.size.0 * scale,
        sketch.size.1 * scale,
        sketch.vision_ms
    )
}
