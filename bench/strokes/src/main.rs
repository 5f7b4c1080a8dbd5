//! Makes pictures with exact truth, traces them and says how well.
#![allow(clippy::print_stdout, reason = "a program that reports on standard output")]

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;
use std::{fs, io};

use clap::{Args, Parser, Subcommand};
use thiserror::Error;
use tracelight_bench_strokes::case::Wanted;
use tracelight_bench_strokes::table::{self, Judged};
use tracelight_bench_strokes::verdict::judge;
use tracelight_bench_strokes::{Case, Degradation, Kind, Picture, Set, Size, nine, show};
use tracelight_formats::{FormatError, Sheet, json};
use tracelight_image::{Grey, ImageError};
use tracelight_stroke::{Drawing, Score, score};
use tracelight_vision::{Mode, Options, VisionError, trace};

/// Truth is written to this, px.
const TRUTH_PX: f64 = 0.004;

#[derive(Parser)]
#[command(about = "Drawings with exact truth, spoilt on purpose, and how well their strokes are found")]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Write pictures (PNG) and their truth (JSON) into a folder, for other tracers
    Make {
        /// Where to
        folder: PathBuf,
        #[command(flatten)]
        series: Series,
        /// The nine-stroke drawing instead: clean and webcam-like, 320x240, 1280x720, 3840x2160
        #[arg(long)]
        nine: bool,
    },
    /// Score drawn strokes (JSON) against the truth (JSON)
    Score {
        /// The truth
        truth: PathBuf,
        /// What was drawn
        drawn: Vec<PathBuf>,
    },
    /// Trace a series of pictures on all cores and print tables
    Run {
        #[command(flatten)]
        series: Series,
        /// Cores to use; all if not given
        #[arg(long)]
        threads: Option<usize>,
        /// Write a line for each picture to this file
        #[arg(long)]
        csv: Option<PathBuf>,
        /// Show so many of the worst pictures
        #[arg(long, default_value_t = 0)]
        worst: usize,
        /// Where to write those: truth green, strokes red; the picture itself and its truth in plain/
        #[arg(long, default_value = "target/strokes-worst")]
        dump: PathBuf,
    },
    /// Trace the nine-stroke drawing
    Nine {
        /// Also show the pictures in this folder
        #[arg(long)]
        dump: Option<PathBuf>,
    },
    /// Trace pictures and write the strokes (JSON) beside each other into a folder
    Trace {
        /// PNG or PNM pictures
        files: Vec<PathBuf>,
        /// Where to
        #[arg(long)]
        out: PathBuf,
    },
    /// Time tracing of pictures on one core: median milliseconds
    Time {
        /// PNG or PNM pictures
        files: Vec<PathBuf>,
        /// Times each is traced
        #[arg(long, default_value_t = 15)]
        repeat: usize,
        /// Follow the edges of all ink, and no lines
        #[arg(long)]
        outlines: bool,
    },
}

#[derive(Args)]
struct Series {
    /// What decides the pictures
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How many
    #[arg(long, default_value_t = 60)]
    count: usize,
    /// Of which kinds
    #[arg(long, default_value = "plain")]
    set: Set,
    /// Only this size, such as 640x480
    #[arg(long)]
    size: Option<Size>,
    /// Only this kind of drawing
    #[arg(long)]
    kind: Option<Kind>,
    /// Only this degradation
    #[arg(long)]
    degrade: Option<Degradation>,
}

impl Series {
    fn cases(&self) -> Vec<Case> {
        let wanted = Wanted { set: self.set, kind: self.kind, degradation: self.degrade, size: self.size };
        Case::series(self.seed, self.count, &wanted)
    }
}

/// Why the program stops.
#[derive(Debug, Error)]
enum Failure {
    #[error("{}: {}; check the name and the permissions", .0.display(), .1)]
    File(PathBuf, io::Error),
    #[error("{}: {}", .0.display(), .1)]
    Strokes(PathBuf, FormatError),
    #[error("{}: {}", .0.display(), .1)]
    Picture(PathBuf, image::ImageError),
    #[error("{}: {}", .0.display(), .1)]
    Trace(PathBuf, VisionError),
    #[error("{}: {}", .0.display(), .1)]
    Levels(PathBuf, ImageError),
}

fn main() -> ExitCode {
    match run(Cli::parse().command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            println!("{failure}");
            ExitCode::FAILURE
        }
    }
}

fn run(command: Command) -> Result<(), Failure> {
    match command {
        Command::Make { folder, series, nine } => make(&folder, &series, nine),
        Command::Score { truth, drawn } => score_files(&truth, &drawn),
        Command::Run { series, threads, csv, worst, dump } => {
            let judged = judge_all(&series.cases(), threads);
            csv.map_or(Ok(()), |file| write(&file, table::csv(&judged).as_bytes()))?;
            println!("{}", table::tables(&judged));
            show_worst(judged, worst, &dump)
        }
        Command::Nine { dump } => nine_drawing(dump.as_deref()),
        Command::Trace { files, out } => files.iter().try_for_each(|file| trace_file(file, &out)),
        Command::Time { files, repeat, outlines } => {
            let mode = if outlines { Mode::Outline } else { Mode::Auto };
            files.iter().try_for_each(|file| time(file, repeat, mode))
        }
    }
}

fn write(file: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let folder = file.parent().map_or(Ok(()), fs::create_dir_all);
    folder.and_then(|()| fs::write(file, bytes)).map_err(|e| Failure::File(file.to_owned(), e))
}

const SMALL: Size = Size { width: 320, height: 240 };
const HD: Size = Size { width: 1280, height: 720 };
const UHD: Size = Size { width: 3840, height: 2160 };

fn nine_cases(sizes: &[Size]) -> impl Iterator<Item = (String, Size, Picture)> {
    let sizes = sizes.to_vec();
    let both = sizes.into_iter().flat_map(|size| [(size, false), (size, true)]);
    both.map(|(size, webcam)| {
        let name = format!("nine-{}-{size}", if webcam { "webcam" } else { "clean" });
        (name, size, nine::picture(size, webcam, 0))
    })
}

fn make(folder: &Path, series: &Series, nine: bool) -> Result<(), Failure> {
    if nine {
        return nine_cases(&[SMALL, HD, UHD])
            .try_for_each(|(name, _, picture)| save(folder, &name, &picture));
    }
    series.cases().iter().try_for_each(|case| save(folder, &case.to_string(), &case.draw()))
}

fn save(folder: &Path, name: &str, picture: &Picture) -> Result<(), Failure> {
    let file = folder.join(format!("{name}.png"));
    let png = picture.png().map_err(|e| Failure::Picture(file.clone(), e))?;
    write(&file, &png)?;
    let size = Size { width: picture.width, height: picture.height };
    save_strokes(&folder.join(format!("{name}.json")), size, picture.truth.clone(), "truth")
}

fn save_strokes(file: &Path, size: Size, drawing: Drawing, mode: &str) -> Result<(), Failure> {
    let (width, height) = (size.width as f64, size.height as f64);
    let sheet = Sheet::in_pixels(width, height, drawing);
    write(file, json::write(&json::Traced { sheet, mode: mode.to_owned() }, TRUTH_PX).as_bytes())
}

fn read_grey(file: &Path) -> Result<Grey, Failure> {
    let bytes = fs::read(file).map_err(|e| Failure::File(file.to_owned(), e))?;
    let image =
        image::load_from_memory(&bytes).map_err(|e| Failure::Picture(file.to_owned(), e))?.into_luma8();
    let (width, height) = (image.width() as usize, image.height() as usize);
    Grey::new(width, height, image.into_raw()).map_err(|e| Failure::Levels(file.to_owned(), e))
}

/// A refused picture has no strokes; the file says so.
fn trace_file(file: &Path, folder: &Path) -> Result<(), Failure> {
    let grey = read_grey(file)?;
    let found = trace(&grey, &Options::default()).map(|t| t.strokes).unwrap_or_default();
    let out = folder.join(file.with_extension("json").file_name().unwrap_or_default());
    save_strokes(&out, Size { width: grey.width(), height: grey.height() }, found, "auto")
}

fn read_strokes(file: &Path) -> Result<(Drawing, Size), Failure> {
    let bytes = fs::read(file).map_err(|e| Failure::File(file.to_owned(), e))?;
    let sheet = match json::read(&bytes) {
        Ok(traced) => traced.sheet,
        // a tracer that found nothing is scored too
        Err(FormatError::Nothing { .. }) => return Ok((Drawing::default(), Size { width: 0, height: 0 })),
        Err(e) => return Err(Failure::Strokes(file.to_owned(), e)),
    };
    Ok((sheet.drawing, Size { width: sheet.width as usize, height: sheet.height as usize }))
}

fn score_files(truth: &Path, drawn: &[PathBuf]) -> Result<(), Failure> {
    let (truth, size) = read_strokes(truth)?;
    println!("{SCORE_HEAD}");
    for file in drawn {
        let (found, _) = read_strokes(file)?;
        println!("{} {}", file.display(), told(&found, &truth, score(&found, &truth, size.tolerance_px())));
    }
    Ok(())
}

const SCORE_HEAD: &str = "# file drawn truth matched rms_px max_px missed_% false_% doubled_% length_ratio";

fn told(found: &Drawing, truth: &Drawing, score: Option<Score>) -> String {
    let (drawn, of) = (found.strokes.len(), truth.strokes.len());
    score.map_or_else(
        || format!("{drawn} {of} 0 nan nan 100 0 0 0"),
        |s| {
            format!(
                "{drawn} {of} {} {:.3} {:.2} {:.2} {:.2} {:.2} {:.4}",
                s.matched,
                s.rms,
                s.max,
                100.0 * s.missed,
                100.0 * s.stray,
                100.0 * s.doubled,
                s.length_ratio
            )
        },
    )
}

/// Draws, traces and scores each case; in the order given, whoever was done first.
fn judge_all(cases: &[Case], threads: Option<usize>) -> Vec<Judged> {
    let cores = threads.or_else(|| std::thread::available_parallelism().ok().map(usize::from)).unwrap_or(1);
    let (next, done) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        while let Some((number, case)) =
            Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|i| Some((i, cases.get(i)?)))
        {
            let picture = case.draw();
            let verdict = judge(&picture, case.tolerance_px(&picture));
            done.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push((number, (*case, verdict)));
        }
    };
    std::thread::scope(|scope| (0..cores).for_each(|_| drop(scope.spawn(work))));
    let mut done = done.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    done.sort_by_key(|&(number, _)| number);
    done.into_iter().map(|(_, judged)| judged).collect()
}

fn show_worst(mut judged: Vec<Judged>, worst: usize, folder: &Path) -> Result<(), Failure> {
    judged.sort_by(|a, b| b.1.badness().total_cmp(&a.1.badness()));
    for (rank, (case, verdict)) in judged.iter().take(worst).enumerate() {
        let file = folder.join(format!("{rank:03}-{case}.png"));
        let picture = case.draw();
        let png = show::png(&picture, &verdict.found).map_err(|e| Failure::Picture(file.clone(), e))?;
        write(&file, &png)?;
        save(&folder.join("plain"), &case.to_string(), &picture)?;
        let refused = verdict.refused.as_deref().unwrap_or("");
        println!("{} {} {refused}", file.display(), told(&verdict.found, &picture.truth, verdict.score));
    }
    Ok(())
}

fn nine_drawing(dump: Option<&Path>) -> Result<(), Failure> {
    println!("| picture | strokes of 9 | matched | rms px | max px | missed % | false % | length |");
    println!("|---|---|---|---|---|---|---|---|");
    for (name, size, picture) in nine_cases(&[SMALL, HD]) {
        let verdict = judge(&picture, size.tolerance_px());
        match verdict.score {
            None => println!("| {name} | refused: {} |", verdict.refused.as_deref().unwrap_or("no strokes")),
            Some(s) => println!(
                "| {name} | {} | {} | {:.3} | {:.2} | {:.2} | {:.2} | {:.3} |",
                s.drawn,
                s.matched,
                s.rms,
                s.max,
                100.0 * s.missed,
                100.0 * s.stray,
                s.length_ratio
            ),
        }
        if let Some(folder) = dump {
            let file = folder.join(format!("{name}.png"));
            let png = show::png(&picture, &verdict.found).map_err(|e| Failure::Picture(file.clone(), e))?;
            write(&file, &png)?;
        }
    }
    Ok(())
}

fn time(file: &Path, repeat: usize, mode: Mode) -> Result<(), Failure> {
    let options = Options { mode, ..Options::default() };
    let grey = read_grey(file)?;
    let refused = |e| Failure::Trace(file.to_owned(), e);
    let mut strokes = 0;
    let mut once = || {
        let started = Instant::now();
        strokes = trace(&grey, &options).map_err(refused)?.strokes.strokes.len();
        Ok(1e3 * started.elapsed().as_secs_f64())
    };
    // the first call warms caches and is dropped
    once()?;
    let mut times = (0..repeat.max(1)).map(|_| once()).collect::<Result<Vec<f64>, _>>()?;
    times.sort_by(f64::total_cmp);
    println!("{} {:.3} ms, {strokes} strokes", file.display(), times[times.len() / 2]);
    Ok(())
}
