//! What a traced job leaves behind: figures, tables, pictures and the run log.
//!
//! Everything here is computed from one read-only [`Job`]; nothing here decides anything. One file an output:
//!
//! | file | written by |
//! |---|---|
//! | `summary.json`, `--json` | [`Summary`] |
//! | `trace.csv`, `fault.csv` | [`csv`] |
//! | `run.mcap` | [`LogWriter`], tick by tick while the run goes on |
//! | `trace.png` | [`painting`] |
//! | `camera.jpg` | [`write_jpeg`], where a camera looked |
//! | `seen.csv`, `seen.jpg` | [`seen`], where it followed the spot |
//! | `report.html` | [`report`] |

mod csv;
pub(crate) mod drawing;
mod events;
impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        Self::failed("cannot-write", error)
    }
}

#[cfg(test)]
mod fixture;
mod log;
mod painting;
mod preview;
mod report;
mod sample;
mod seen;
pub(crate) mod stages;
mod summary;

use std::path::{Path, PathBuf};
use std::time::Instant;

use tracelight_eye::figures::EyeFigures;
use tracelight_eye::seen::SeenLight;
use tracelight_picture::Raster;
use tracelight_rig::PanTilt;
use tracelight_sim::{Run, Tracking};
use tracelight_stroke::{Affine, Drawing, Point};
use tracelight_task::Failure;
use tracelight_trajectory::Plan;
use tracelight_vision::Quality;

pub(crate) use events::{Event, events};
pub(crate) use log::{LogMeta, LogWriter};
pub(crate) use preview::{ColourBy, preview};
pub(crate) use report::html;
pub(crate) use sample::planned;
pub(crate) use summary::{PlanFigures, StrokeFigures, Summary};

/// A finished (or stopped) job, as the outputs see it.
pub(crate) struct Job<'a> {
    /// The picture's file as the user named it.
    pub(crate) picture_path: &'a str,
    /// Its pixels; `None` where the strokes came from a vector file.
    pub(crate) picture: Option<Picture<'a>>,
    /// What those are worth.
    pub(crate) quality: Option<&'a Quality>,
    /// Where and how large the job is drawn.
    pub(crate) target: Target,
    /// The strokes in target metres, in tracing order.
    pub(crate) drawing: &'a Drawing,
    /// The same in time.
    pub(crate) plan: &'a Plan,
    /// What happened; with several laps, in the last one.
    pub(crate) run: &'a Run,
    /// The laps before it; empty for an ordinary job.
    pub(crate) earlier_laps: &'a [Run],
    /// How well `run` followed the plan.
    pub(crate) tracking: Tracking,
    /// Speed along the strokes that was asked for, m/s.
    pub(crate) set_speed_m_s: f64,
    /// Largest command at the amplifiers' inputs, V.
    pub(crate) command_limit_v: PanTilt<f64>,
    /// Torque at the joints for that command, N m.
    pub(crate) torque_limit_nm: PanTilt<f64>,
    /// Distance from the stroke at which the laser darkens, mm.
    pub(crate) tolerance_mm: f64,
    /// What a camera saw, if one looked.
    pub(crate) eye: Option<EyeFigures>,
    /// What it saw of the spot while it drew, if it did.
    pub(crate) seen: Option<&'a SeenLight>,
    /// What the job was asked to do, in the order to show it.
    pub(crate) settings: &'a [Setting],
    /// Remarks and warnings of the stages before.
    pub(crate) notes: &'a [String],
    /// How long the stages took.
    pub(crate) timing: Timing,
    /// Seed of the run.
    pub(crate) seed: u64,
    /// The gate was held dark on purpose.
    pub(crate) dry_run: bool,
}

/// A decoded picture and where it lies.
#[derive(Clone, Copy)]
pub(crate) struct Picture<'a> {
    /// Its pixels.
    pub(crate) raster: &'a Raster,
    /// From pixels (x right, y down, corner at the origin) to target metres.
    pub(crate) target_from_pixel: Affine,
}

/// Writes what a camera saw.
pub(crate) fn write_jpeg(path: &Path, image: &Raster) -> Result<(), OutputError> {
    const QUALITY: u8 = 90;
    let reason = |e: image::ImageError| OutputError::Encode { path: path.to_owned(), reason: e.to_string() };
    std::fs::write(path, image.jpeg(QUALITY).map_err(reason)?).map_err(OutputError::at(path))
}

/// The plane drawn on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Target {
    /// Width of the picture on it, m.
    pub(crate) width_m: f64,
    /// Height of the picture on it, m.
    pub(crate) height_m: f64,
    /// From the head to the plane, m.
    pub(crate) distance_m: f64,
}

/// One line of the settings table.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Setting {
    /// What it is, as in `--help`.
    pub(crate) name: String,
    /// Its value with its unit.
    pub(crate) value: String,
}

/// Wall-clock time of the stages, ms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Timing {
    /// Picture to strokes.
    pub(crate) vision_ms: f64,
    /// Strokes to timed segments.
    pub(crate) plan_ms: f64,
    /// The run itself.
    pub(crate) run_ms: f64,
    /// Whatever of the report was made before [`write_all`]; it adds its own.
    pub(crate) report_ms: f64,
}

/// Why an output is missing.
#[derive(Debug, thiserror::Error)]
pub(crate) enum OutputError {
    /// The file system said no.
    #[error("cannot write {}: {source}; check the folder, its permissions and the free space, or choose another with --out", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The run log could not be written.
    #[error("cannot write the run log {}: {source}; check the free space, or choose another folder with --out", path.display())]
    Log {
        /// The file.
        path: PathBuf,
        /// What the log's writer says.
        source: mcap::McapError,
    },
    /// A picture could not be encoded.
    #[error("cannot encode {}: {reason}", path.display())]
    Encode {
        /// The file it was for.
        path: PathBuf,
        /// What the encoder says.
        reason: String,
    },
}

impl OutputError {
    /// An error of the file system at `path`.
    fn at(path: &Path) -> impl FnOnce(std::io::Error) -> Self + use<> {
        let path = path.to_owned();
        move |source| Self::Write { path, source }
    }
}

impl Job<'_> {
    /// The rectangle all outputs show, target m: the picture with every stroke, `(lower left, upper right)`.
    fn bounds(&self) -> (Point, Point) {
        let half = Point::new(self.target.width_m / 2.0, self.target.height_m / 2.0);
        let corners = self.picture.map_or(vec![Point::new(-half.x, -half.y), half], |p| p.corners().to_vec());
        let strokes = self.drawing.strokes.iter().flat_map(|s| s.path.flatten(DISPLAY_TOLERANCE_M));
        let all = corners.into_iter().chain(strokes).filter(|p| p.is_finite());
        let none =
            (Point::new(f64::INFINITY, f64::INFINITY), Point::new(f64::NEG_INFINITY, f64::NEG_INFINITY));
        let (low, high) = all.fold(none, |(low, high), p| {
            (Point::new(low.x.min(p.x), low.y.min(p.y)), Point::new(high.x.max(p.x), high.y.max(p.y)))
        });
        if low.x < high.x && low.y < high.y {
            (low, high)
        } else {
            (Point::new(-0.5, -0.5), Point::new(0.5, 0.5))
        }
    }

    /// The picture's file name without its folder.
    fn title(&self) -> String {
        let name = Path::new(self.picture_path).file_name();
        name.map_or_else(|| self.picture_path.to_owned(), |n| n.to_string_lossy().into_owned())
    }
}

impl Picture<'_> {
    /// Its four corners on the target, m.
    fn corners(&self) -> [Point; 4] {
        let (w, h) = (f64::from(self.raster.width()), f64::from(self.raster.height()));
        [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)].map(|(u, v)| self.target_from_pixel * Point::new(u, v))
    }
}

/// Chords of shown strokes stay this close to them, m: a tenth of a millimetre is under a pixel everywhere.
const DISPLAY_TOLERANCE_M: f64 = 1e-4;

/// Writes `trace.csv`, after a fault `fault.csv`, `trace.png`, `report.html` and `summary.json` into `dir`, which is made if missing.
///
/// Returns the figures as they stand in `summary.json`, the time this took included. The run log and
/// `strokes.svg` are not written here: the one exists before, the other is a drawing format's.
pub(crate) fn write_all(dir: &Path, job: &Job<'_>) -> Result<Summary, OutputError> {
    let began = Instant::now();
    std::fs::create_dir_all(dir).map_err(OutputError::at(dir))?;
    let table = || {
        csv::write_fault(&dir.join("fault.csv"), job)?;
        seen::write(dir, job)?;
        csv::write(&dir.join("trace.csv"), job)
    };
    let pictures = || {
        let wall = painting::paint(job);
        painting::write(&dir.join("trace.png"), &wall)?;
        let figures = Summary::new(job);
        report::write(&dir.join("report.html"), job, &figures, &wall)
    };
    both(table, pictures)?;
    let mut summary = Summary::new(job);
    summary.timing_ms.report += began.elapsed().as_secs_f64() * 1e3;
    summary.write(&dir.join("summary.json"))?;
    Ok(summary)
}

/// Runs two writers side by side; the first error wins.
fn both(
    one: impl FnOnce() -> Result<(), OutputError> + Send,
    other: impl FnOnce() -> Result<(), OutputError>,
) -> Result<(), OutputError> {
    std::thread::scope(|scope| {
        let first = scope.spawn(one);
        let second = other();
        match first.join() {
            Ok(result) => result.and(second),
            Err(panic) => std::panic::resume_unwind(panic),
        }
    })
}

/// Removes a result that an earlier job may have left and this one has none of.
pub(crate) fn forget(path: &Path) -> std::io::Result<()> {
    match std::fs::remove_file(path) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(e),
        _ => Ok(()),
    }
}
