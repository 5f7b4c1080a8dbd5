//! The files of a run's folder.

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::Path;
use std::time::Instant;

use tracelight_files::ResultFolder;
use tracelight_job::{Keep, PointDone};
use tracelight_picture::Raster;
use tracelight_report::{
    Finished, LogFigures, LogMeta, LogWriter, Summary, fault_csv, index, page, paint, planned, seen_csv,
    trace_csv,
};
use tracelight_sim::Tick;
use tracelight_task::Failure;
use tracelight_trajectory::Plan;

use crate::journal::{Asked, JOB, Journal, PROGRESS, hash_of};
use crate::points::{POINTS, put_points};

/// The run log, written while the run goes on.
const LOG: &str = "run.mcap";
/// The log with an index, until it takes the log's place.
const INDEXED: &str = "run.mcap.part";
pub(crate) const SUMMARY: &str = "summary.json";
pub(crate) const RIG: &str = "rig.toml";
pub(crate) const STROKES: &str = "strokes.svg";
pub(crate) const CAMERA: &str = "camera.jpg";

/// All results that a job may have; the summary is written last.
const NAMES: [&str; 15] = [
    JOB,
    PROGRESS,
    LOG,
    INDEXED,
    STROKES,
    CAMERA,
    RIG,
    POINTS,
    "trace.csv",
    "fault.csv",
    "seen.csv",
    "seen.jpg",
    "trace.png",
    "report.html",
    SUMMARY,
];

/// Takes a folder over for a job's results. A rig file that the job was given and that lies there under the name of one stays.
///
/// # Errors
/// As of [`ResultFolder::open`].
pub fn open(dir: &Path, rig: &str) -> Result<ResultFolder, Failure> {
    ResultFolder::open(dir, &NAMES, Some(Path::new(rig)))
}

/// All that is kept of a run while it goes on. What happened is known to the tick, whenever the program ends.
pub struct Records<'a> {
    journal: Journal,
    log: RunLog<'a>,
}

impl<'a> Records<'a> {
    /// Begins them, for a job of so many strokes.
    ///
    /// # Errors
    /// `cannot-write`.
    pub fn begin(
        folder: &'a ResultFolder,
        asked: &Asked,
        strokes: usize,
        meta: &LogMeta<'_>,
    ) -> Result<Self, Failure> {
        asked.put(folder)?;
        Ok(Self { journal: Journal::begin(folder, strokes)?, log: RunLog::open(folder, meta)? })
    }

    /// Closes the log: indexed, and whole for every reader. Where there is no room for the index, the log stays without, and that is what is
    /// returned: a remark.
    ///
    /// # Errors
    /// `cannot-write`.
    pub fn finish(self) -> Result<Option<String>, Failure> {
        self.log.finish()
    }
}

impl Keep for Records<'_> {
    fn tick(&mut self, plan: &Plan, tick: &Tick) -> Result<(), Failure> {
        self.journal.tick(plan, tick)?;
        self.log.tick(plan, tick)
    }

    fn aside(&mut self, plan: &Plan, tick: &Tick) -> Result<(), Failure> {
        self.log.tick(plan, tick)
    }

    /// Written anew each time, whole: a killed program loses none.
    fn points(&mut self, points: &[PointDone]) -> Result<(), Failure> {
        put_points(self.log.folder, points)
    }
}

/// The run log `run.mcap`, written while the run goes on. A killed program leaves all of it but its index.
struct RunLog<'a> {
    folder: &'a ResultFolder,
    writer: LogWriter<BufWriter<File>>,
}

impl<'a> RunLog<'a> {
    /// Begins a log.
    fn open(folder: &'a ResultFolder, meta: &LogMeta<'_>) -> Result<Self, Failure> {
        let file = folder.begin(LOG)?;
        let writer =
            LogWriter::begin(BufWriter::new(file), meta).map_err(|e| cannot_log(&folder.path(LOG), &e))?;
        Ok(Self { folder, writer })
    }

    fn finish(self) -> Result<Option<String>, Failure> {
        let Self { folder, writer } = self;
        let (path, indexed) = (folder.path(LOG), folder.path(INDEXED));
        writer.finish().map_err(|e| cannot_log(&path, &e))?;
        let all = || -> Result<(), Box<dyn std::error::Error>> {
            index(File::open(&path)?, BufWriter::new(folder.begin(INDEXED).map_err(|e| e.message)?))?;
            Ok(fs::rename(&indexed, &path)?)
        };
        let Err(error) = all() else { return Ok(None) };
        drop(fs::remove_file(&indexed)); // it may never have been begun
        Ok(Some(format!(
            "the run log {} is whole, but has no index, which some viewers ask for: {error}; check the free space",
            path.display()
        )))
    }
}

impl Keep for RunLog<'_> {
    fn tick(&mut self, plan: &Plan, tick: &Tick) -> Result<(), Failure> {
        let appended = planned(plan, tick.telemetry.plan_tick)
            .map_or(Ok(()), |planned| self.writer.append(tick, planned));
        appended.map_err(|e| cannot_log(&self.folder.path(LOG), &e))
    }
}

fn cannot_log(path: &Path, error: &impl std::fmt::Display) -> Failure {
    Failure::failed(
        "cannot-write",
        format!(
            "cannot write the run log {}: {error}; check the free space, or choose another folder with --out",
            path.display()
        ),
    )
}

fn cannot_encode(path: &Path, error: &impl std::fmt::Display) -> Failure {
    Failure::failed("cannot-write", format!("cannot encode {}: {error}", path.display()))
}

/// Writes what a camera saw, if it saw anything.
pub(crate) fn put_jpeg(folder: &ResultFolder, name: &str, image: Option<&Raster>) -> Result<(), Failure> {
    const QUALITY: u8 = 90;
    let Some(image) = image else { return Ok(()) };
    folder.put(name, image.jpeg(QUALITY).map_err(|e| cannot_encode(&folder.path(name), &e))?)
}

/// Writes `trace.csv`, after a fault `fault.csv`, what a camera saw of the spot, `trace.png`, `report.html` and, last of all, `summary.json`
/// with the hash of the run log.
///
/// Returns the figures as they stand in `summary.json`, the time this took included. The run log and
/// `strokes.svg` are not written here: the one exists before, the other is a drawing format's.
pub(crate) fn write_all(folder: &ResultFolder, job: &Finished<'_>) -> Result<Summary, Failure> {
    let began = Instant::now();
    let pictures = || {
        let wall = paint(job);
        folder.put("trace.png", wall.png().map_err(|e| cannot_encode(&folder.path("trace.png"), &e))?)?;
        let page = page(job, &Summary::new(job), &wall).map_err(|e| Failure::failed("cannot-write", e))?;
        folder.put("report.html", page)
    };
    both(|| write_tables(folder, job), pictures)?;
    let mut summary = Summary::new(job);
    summary.log = Some(log_figures(&folder.path(LOG)).map_err(|e| cannot_log(&folder.path(LOG), &e))?);
    summary.timing_ms.report += began.elapsed().as_secs_f64() * 1e3;
    folder.put(SUMMARY, summary.json() + "\n")?;
    Ok(summary)
}

/// By which anybody can tell whether a log is the one that a summary is of.
fn log_figures(path: &Path) -> std::io::Result<LogFigures> {
    Ok(LogFigures { file: LOG, bytes: fs::metadata(path)?.len(), sha256: hash_of(path)? })
}

fn write_tables(folder: &ResultFolder, job: &Finished<'_>) -> Result<(), Failure> {
    fault_csv(job).map_or(Ok(()), |table| folder.put("fault.csv", table))?;
    put_jpeg(folder, "seen.jpg", job.seen.and_then(|seen| seen.painting.as_ref()))?;
    job.seen.map_or(Ok(()), |seen| folder.put("seen.csv", seen_csv(&seen.marks)))?;
    folder.put_by("trace.csv", |file| {
        let mut out = BufWriter::with_capacity(1 << 17, file);
        trace_csv(&mut out, job)?;
        out.flush()
    })
}

/// Runs two writers side by side; the first error wins.
fn both(
    one: impl FnOnce() -> Result<(), Failure> + Send,
    other: impl FnOnce() -> Result<(), Failure>,
) -> Result<(), Failure> {
    std::thread::scope(|scope| {
        let first = scope.spawn(one);
        let second = other();
        match first.join() {
            Ok(result) => result.and(second),
            Err(panic) => std::panic::resume_unwind(panic),
        }
    })
}
