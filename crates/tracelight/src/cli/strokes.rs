use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use clap::builder::PossibleValuesParser;
use tracelight_campaign as campaign;
use tracelight_campaign::{Batch, Figures, Finding, Out};
use tracelight_files as files;
use tracelight_files::{Picture, stands_for_several};
use tracelight_formats::ReadOptions;
use tracelight_operator::Bar;
use tracelight_picture::Source;
use tracelight_pipeline::{Tracing, page, place, sketch};
use tracelight_report as report;
use tracelight_report::drawing::{self, FORMATS};
use tracelight_task::{Failure, Progress as _, Stop, Task, counted, meaning};
use tracelight_vision::Stages;

use crate::cli::answer::{Answer, Voice, print_piece};
use crate::cli::gcode::GcodeArgs;
use crate::named;
use tracelight_flags::LetteringArgs;
use tracelight_flags::PlacementArgs;
use tracelight_flags::ReadingArgs;
use tracelight_flags::TracingArgs;
use tracelight_flags::WallArgs;

/// Find the strokes of pictures, without a rig
#[derive(Args, Debug)]
#[command(
    after_help = "Examples: tracelight strokes examples/sheet.jpg -o sheet.svg --width 60cm\n          \
                        tracelight strokes examples/*.png -o out/\n          \
                        tracelight strokes examples/ --recursive -o out/ --format json"
)]
pub(crate) struct StrokesArgs {
    /// Pictures or drawings, or folders of pictures; - is standard input
    #[arg(required_unless_present = "text", conflicts_with = "text", value_name = "PICTURE")]
    pictures: Vec<String>,
    /// Write the strokes here: .svg, .dxf, .gcode (GRBL laser) or .hpgl in true size, .ild (ILDA, scaled to the full coordinate range),
    /// .csv (metres), .json (pixels); a folder, with / at its end, for several pictures. Pictures already done in that folder are skipped
    #[arg(help_heading = "Output", short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Format of the files in a folder
    #[arg(help_heading = "Output", long, value_name = "FORMAT", value_parser = PossibleValuesParser::new(FORMATS))]
    format: Option<String>,
    /// Write the processing stages as an SVG: grey, illumination evened out, histogram and threshold, ink; one picture only
    #[arg(help_heading = "Output", long, value_name = "FILE.svg", value_parser = svg_file)]
    stages: Option<PathBuf>,
    #[command(flatten, next_help_heading = "Output")]
    gcode: GcodeArgs,
    #[command(flatten, next_help_heading = "Picture")]
    tracing: TracingArgs,
    #[command(flatten, next_help_heading = "Picture")]
    reading: ReadingArgs,
    #[command(flatten, next_help_heading = "Picture")]
    lettering: LetteringArgs,
    /// Include subfolders
    #[arg(help_heading = "Output", short, long)]
    recursive: bool,
    /// Pictures that are traced at the same time [default: as many as there are processors]
    #[arg(help_heading = "Output", short, long, value_name = "N", allow_hyphen_values = true, value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Trace also pictures whose strokes are in the folder already
    #[arg(help_heading = "Output", long)]
    again: bool,
    #[command(flatten, next_help_heading = "Size and place")]
    placement: PlacementArgs,
    #[command(flatten, next_help_heading = "Size and place")]
    wall: WallArgs,
    #[command(flatten, next_help_heading = "Output")]
    pub(crate) voice: Voice,
}

fn svg_file(text: &str) -> Result<PathBuf, String> {
    let is_svg = text.to_ascii_lowercase().ends_with(".svg");
    if is_svg { Ok(text.into()) } else { Err(format!("{text} does not end in .svg")) }
}

pub(crate) fn run(args: &StrokesArgs, stop: &Stop) -> Result<Answer, Failure> {
    let options = args.reading.options()?;
    if let Some(name) = args.lettering.name() {
        return single(args, &options, name);
    }
    match args.pictures.as_slice() {
        [only] if !stands_for_several(only) => single(args, &options, only),
        _ if args.stages.is_some() => {
            Err(Failure::usage("usage", "--stages is of one picture: give only that"))
        }
        _ => many(args, &options, stop),
    }
}

/// One picture: a sentence, or its strokes as JSON.
fn single(args: &StrokesArgs, options: &ReadOptions, picture: &str) -> Result<Answer, Failure> {
    check_format(args)?;
    let named = Picture { name: picture.to_owned(), within: None };
    let traced = match args.out.as_deref() {
        Some(out) if is_folder(out) => {
            let files = campaign::files(&[named], out, extension(args))?;
            files::written_whole(&out.join(&files[0]), |path| one(args, options, picture, Some(path)))?
        }
        out => one(args, options, picture, out)?,
    };
    if let Some(doubt) = &traced.figures.doubt {
        Bar::new(args.voice.quiet).say(&format!("note: {picture}: {doubt}"));
    }
    let words = traced.words.as_ref().map_or_else(String::new, |words| format!("\n{words}"));
    Ok(Answer::new(line(picture, &traced) + &words, traced.json.unwrap_or_default()))
}

/// Every picture, past those that fail.
fn many(args: &StrokesArgs, options: &ReadOptions, stop: &Stop) -> Result<Answer, Failure> {
    if args.out.as_deref().is_some_and(|out| !may_become_folder(out)) {
        let message = "several pictures need a folder: end --out with / (such as -o strokes/)";
        return Err(Failure::usage("usage", message));
    }
    let found = files::find(&args.pictures, args.recursive)?;
    let bar = Bar::new(args.voice.quiet);
    let task = Task { progress: &bar, stop };
    found.remarks.iter().for_each(|remark| task.say(&format!("note: {remark}")));
    let out = args.out.as_deref().map(|folder| Out {
        folder,
        extension: extension(args),
        made_with: made_with(args, options),
        again: args.again,
    });
    let jobs = args.jobs.map_or_else(processors, usize::from);
    let batch = Batch { pictures: found.pictures, out, jobs, help: |code| meaning(code).unwrap_or_default() };
    let mut printed = Ok(());
    let mut print = |piece: &str| {
        if printed.is_ok() {
            printed = print_piece(piece);
        }
    };
    let pieces: Option<&mut dyn FnMut(&str)> = if args.voice.json { Some(&mut print) } else { None };
    let ended = campaign::run(&batch, &|picture, path| one(args, options, picture, path), task, pieces)?;
    printed?;
    Ok(Answer { failure: ended.failure, ..Answer::new(ended.text, ended.json) })
}

fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

fn extension(args: &StrokesArgs) -> &str {
    args.format.as_deref().unwrap_or(FORMATS[0])
}

/// A file's own name says its format.
fn check_format(args: &StrokesArgs) -> Result<(), Failure> {
    let (Some(format), Some(out)) = (&args.format, args.out.as_deref().filter(|out| !is_folder(out))) else {
        return Ok(());
    };
    match out.extension().is_some_and(|e| e.eq_ignore_ascii_case(format)) {
        true => Ok(()),
        false => {
            let message = format!("--format {format} does not fit --out {}; leave one out", out.display());
            Err(Failure::usage("usage", message))
        }
    }
}

/// Version and options: whatever makes a difference to a written file. A flag that is added must be put on one side.
fn made_with(args: &StrokesArgs, options: &ReadOptions) -> String {
    let StrokesArgs {
        tracing,
        placement,
        wall,
        lettering,
        reading: _, // as options, with what is in its fonts
        gcode,
        format: _,
        pictures: _,
        stages: _,
        out: _,
        recursive: _,
        jobs: _,
        again: _,
        voice: _,
    } = args;
    let version = env!("CARGO_PKG_VERSION");
    let format = extension(args);
    format!("{version} {format} {tracing:?} {placement:?} {wall:?} {options:?} {gcode:?} {lettering:?}")
}

fn one(
    args: &StrokesArgs,
    options: &ReadOptions,
    picture: &str,
    path: Option<&Path>,
) -> Result<Finding, Failure> {
    let source = named::source(picture, options, &args.lettering)?;
    if let Some(path) = &args.stages {
        if path.as_path() == Path::new(picture) || args.out.as_deref() == Some(path) {
            let message =
                format!("--stages {} is the picture or --out: give it a name of its own", path.display());
            return Err(Failure::usage("usage", message));
        }
        files::write(&path.display().to_string(), stages(picture, &source, &args.tracing.tracing())?)?;
    }
    let tracing = args.tracing.tracing();
    let placing = args.wall.placing(args.placement.placing(), None, None)?;
    let began = Instant::now();
    let mut sketch = sketch(picture, source, &tracing, &placing)?;
    let vision_ms = began.elapsed().as_secs_f64() * 1e3;
    sketch.picture = None; // its colours are not needed, and large
    let is_json = |path: &Path| path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json"));
    let json = (args.voice.json || path.is_some_and(is_json)).then(|| drawing::json(&sketch));
    let mut note = None;
    let placed = place(&sketch, &placing)?;
    sketch.remarks.extend(placed.notes.iter().cloned());
    if let Some(path) = path {
        let json = json.as_deref().unwrap_or_default();
        let file = drawing::file(path, &placed, json, args.gcode.options().as_ref())?;
        files::write(&path.display().to_string(), file.bytes)?;
        sketch.remarks.extend(file.doubts);
        note = file.note;
    }
    let figures = Figures::of(&sketch, &placing);
    Ok(Finding {
        figures,
        words: sketch
            .quality
            .map(|quality| quality.words())
            .into_iter()
            .chain(note)
            .reduce(|a, b| format!("{a}\n{b}")),
        json: json.filter(|_| args.voice.json),
        vision_ms,
    })
}

/// How a picture becomes ink.
fn stages(picture: &str, source: &Source, tracing: &Tracing) -> Result<String, Failure> {
    let Source::Pixels(pixels) = source else {
        let message = format!("--stages: {picture} has strokes already, and no ink to be found");
        return Err(Failure::usage("usage", message));
    };
    let page = page(picture, &pixels.grey, tracing)?;
    // what is ink does not depend on how long a pixel is
    let stages = Stages::of(&page, &tracing.options(1.0))
        .map_err(|e| Failure::failed("no-strokes-found", format!("{picture}: {e}")))?;
    let name =
        Path::new(picture).file_name().map_or_else(|| picture.to_owned(), |n| n.to_string_lossy().into());
    report::stages::figure(&name, &page.picture, &stages)
}

fn is_folder(path: &Path) -> bool {
    path.is_dir() || path.to_string_lossy().ends_with(std::path::is_separator)
}

/// With several pictures a name without an extension can only mean a folder.
fn may_become_folder(path: &Path) -> bool {
    is_folder(path) || path.extension().is_none() && !path.exists()
}

fn line(picture: &str, traced: &Finding) -> String {
    let Figures { strokes, closed, length, sheet: (width, height), unit, .. } = &traced.figures;
    let (strokes, unit) = (counted(*strokes, "stroke"), unit.name());
    format!(
        "{picture}: {strokes} ({closed} closed), {length:.0} {unit} of line on a sheet of {width:.0} × \
         {height:.0} {unit}, {:.0} ms",
        traced.vision_ms
    )
}
