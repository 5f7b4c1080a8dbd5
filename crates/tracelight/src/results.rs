//! A job's results in a folder.

use std::fs::{self, File};
use std::io::{BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

use tracelight_job::Keep;
use tracelight_picture::Raster;
use tracelight_report::{
    Finished, LogMeta, LogWriter, Summary, fault_csv, index, page, paint, planned, seen_csv, trace_csv,
};
use tracelight_sim::Tick;
use tracelight_task::Failure;
use tracelight_trajectory::Plan;

/// The run log `run.mcap`, written while the run goes on. A killed program leaves all of it but its index.
pub(crate) struct RunLog {
    path: PathBuf,
    writer: LogWriter<BufWriter<File>>,
}

impl RunLog {
    /// Begins a log; a file of that name is replaced.
    pub(crate) fn open(path: &Path, meta: &LogMeta<'_>) -> Result<Self, Failure> {
        let file = File::create(path).map_err(|e| cannot_write(path, &e))?;
        let writer = LogWriter::begin(BufWriter::new(file), meta).map_err(|e| cannot_log(path, &e))?;
        Ok(Self { path: path.to_owned(), writer })
    }

    /// Closes the log: indexed, and whole for every reader.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        let Self { path, writer } = self;
        let indexed = path.with_extension("mcap.part");
        let all = || {
            writer.finish()?;
            index(File::open(&path)?, BufWriter::new(File::create(&indexed)?))
        };
        all().map_err(|e| cannot_log(&path, &e))?;
        fs::rename(&indexed, &path).map_err(|e| cannot_write(&path, &e))
    }
}

impl Keep for RunLog {
    fn tick(&mut self, plan: &Plan, tick: &Tick) -> Result<(), Failure> {
        let appended = planned(plan, tick.telemetry.plan_tick)
            .map_or(Ok(()), |planned| self.writer.append(tick, planned));
        appended.map_err(|e| cannot_log(&self.path, &e))
    }
}

fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    Failure::failed(
        "cannot-write",
        format!(
            "cannot write {}: {error}; check the folder, its permissions and the free space, or choose another with --out",
            path.display()
        ),
    )
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

/// Makes the folder for results, if it is missing.
pub(crate) fn make_folder(dir: &Path) -> Result<(), Failure> {
    fs::create_dir_all(dir).map_err(|e| cannot_write(dir, &e))
}

/// Writes a result.
pub(crate) fn put(path: &Path, bytes: impl AsRef<[u8]>) -> Result<(), Failure> {
    fs::write(path, bytes).map_err(|e| cannot_write(path, &e))
}

/// Writes a result; one that an earlier job left under its name is removed where this one has none.
pub(crate) fn put_or_forget(path: &Path, bytes: Option<impl AsRef<[u8]>>) -> Result<(), Failure> {
    let Some(bytes) = bytes else {
        return match fs::remove_file(path) {
            Err(e) if e.kind() != ErrorKind::NotFound => Err(cannot_write(path, &e)),
            _ => Ok(()),
        };
    };
    put(path, bytes)
}

/// The same of what a camera saw.
pub(crate) fn put_jpeg(path: &Path, image: Option<&Raster>) -> Result<(), Failure> {
    const QUALITY: u8 = 90;
    let encoded = image.map(|image| image.jpeg(QUALITY)).transpose();
    put_or_forget(path, encoded.map_err(|e| cannot_encode(path, &e))?)
}

/// Writes `trace.csv`, after a fault `fault.csv`, what a camera saw of the spot, `trace.png`, `report.html` and `summary.json` into a
/// folder, which is made if missing.
///
/// Returns the figures as they stand in `summary.json`, the time this took included. The run log and
/// `strokes.svg` are not written here: the one exists before, the other is a drawing format's.
pub(crate) fn write_all(dir: &Path, job: &Finished<'_>) -> Result<Summary, Failure> {
    let began = Instant::now();
    make_folder(dir)?;
    let pictures = || {
        let wall = paint(job);
        let path = dir.join("trace.png");
        put(&path, wall.png().map_err(|e| cannot_encode(&path, &e))?)?;
        let page = page(job, &Summary::new(job), &wall).map_err(|e| Failure::failed("cannot-write", e))?;
        put(&dir.join("report.html"), page)
    };
    both(|| write_tables(dir, job), pictures)?;
    let mut summary = Summary::new(job);
    summary.timing_ms.report += began.elapsed().as_secs_f64() * 1e3;
    put(&dir.join("summary.json"), summary.json() + "\n")?;
    Ok(summary)
}

fn write_tables(dir: &Path, job: &Finished<'_>) -> Result<(), Failure> {
    put_or_forget(&dir.join("fault.csv"), fault_csv(job))?;
    put_jpeg(&dir.join("seen.jpg"), job.seen.and_then(|seen| seen.painting.as_ref()))?;
    put_or_forget(&dir.join("seen.csv"), job.seen.map(|seen| seen_csv(&seen.marks)))?;
    let path = dir.join("trace.csv");
    let file = File::create(&path).map_err(|e| cannot_write(&path, &e))?;
    let mut out = BufWriter::with_capacity(1 << 17, file);
    trace_csv(&mut out, job).and_then(|()| out.flush()).map_err(|e| cannot_write(&path, &e))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_that_is_not_there_is_named_in_the_error() {
        let path = Path::new("/nowhere/at/all/run.mcap");
        let meta = LogMeta { picture_path: "", settings: &[], seed: 0 };
        let Err(error) = RunLog::open(path, &meta) else { panic!("opened {path:?}") };
        assert!(error.message.contains("/nowhere/at/all/run.mcap"), "{}", error.message);
    }
}
