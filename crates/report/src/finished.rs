//! A job that has ended, as its results show it.

use std::path::Path;

use serde::Serialize;
use tracelight_eye::figures::EyeFigures;
use tracelight_eye::seen::SeenLight;
use tracelight_picture::Raster;
use tracelight_pipeline::{AlignFigures, LeftOut, Standing};
use tracelight_rig::PanTilt;
use tracelight_sim::{Origin, Run, Tracking};
use tracelight_stroke::{Affine, Drawing, Point};
use tracelight_trajectory::Plan;
use tracelight_vision::Quality;

/// Points that a job marked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct PointFigures {
    /// How many there were to be marked.
    pub count: usize,
    /// How many were ticked off.
    pub done: usize,
}

/// A finished (or stopped) job, as the outputs see it.
pub struct Finished<'a> {
    /// The picture's file as the user named it.
    pub picture_path: &'a str,
    /// Its pixels; `None` where the strokes came from a vector file.
    pub picture: Option<Picture<'a>>,
    /// What those are worth.
    pub quality: Option<&'a Quality>,
    /// Where and how large the job is drawn.
    pub target: Target,
    /// How the head stands to it.
    pub standing: Standing,
    /// How it lies by its marks, where there are any.
    pub align: Option<&'a AlignFigures>,
    /// What of it is left out, where it is to keep out of something.
    pub left_out: Option<LeftOut>,
    /// The points that it marked, where it marked points.
    pub points: Option<PointFigures>,
    /// The strokes in target metres, in tracing order.
    pub drawing: &'a Drawing,
    /// The same in time.
    pub plan: &'a Plan,
    /// What happened; with several laps, in the last one.
    pub run: &'a Run,
    /// Whether it did all that it was to do.
    pub finished: bool,
    /// The laps before it; empty for an ordinary job.
    pub earlier_laps: &'a [Run],
    /// How well `run` followed the plan.
    pub tracking: Tracking,
    /// Speed along the strokes that was asked for, m/s.
    pub set_speed_m_s: f64,
    /// Largest command at the amplifiers' inputs, V.
    pub command_limit_v: PanTilt<f64>,
    /// Torque at the joints for that command, N m.
    pub torque_limit_nm: PanTilt<f64>,
    /// Distance from the stroke at which the laser darkens, mm.
    pub tolerance_mm: f64,
    /// What a camera saw, if one looked.
    pub eye: Option<EyeFigures>,
    /// What it saw of the spot while it drew, if it did.
    pub seen: Option<&'a SeenLight>,
    /// What the job was asked to do, in the order to show it.
    pub settings: &'a [Setting],
    /// Remarks and warnings of the stages before.
    pub notes: &'a [String],
    /// How long the stages took.
    pub timing: Timing,
    /// Seed of the run.
    pub seed: u64,
    /// The gate was held dark on purpose.
    pub dry_run: bool,
    /// Where what is told of the run comes from; every result says so.
    pub origin: Origin,
}

/// A decoded picture and where it lies.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    /// Its pixels.
    pub raster: &'a Raster,
    /// From pixels (x right, y down, corner at the origin) to target metres.
    pub target_from_pixel: Affine,
}

/// The plane drawn on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Width of the picture on it, m.
    pub width_m: f64,
    /// Height of the picture on it, m.
    pub height_m: f64,
    /// Where the picture's middle lies on it, m.
    pub middle: Point,
    /// From the head to the plane, m.
    pub distance_m: f64,
}

/// One line of the settings table.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// What it is, as in `--help`.
    pub name: String,
    /// Its value with its unit.
    pub value: String,
}

/// Wall-clock time of the stages, ms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timing {
    /// Picture to strokes.
    pub vision_ms: f64,
    /// Strokes to timed segments.
    pub plan_ms: f64,
    /// The run itself.
    pub run_ms: f64,
    /// Whatever of the report was made before it is written; who writes it adds that.
    pub report_ms: f64,
}

impl Finished<'_> {
    /// The rectangle all outputs show, target m: the picture with every stroke, `(lower left, upper right)`.
    pub(crate) fn bounds(&self) -> (Point, Point) {
        let half = Point::new(self.target.width_m / 2.0, self.target.height_m / 2.0);
        let middle = self.target.middle;
        let about = || vec![middle - half.to_vec2(), middle + half.to_vec2()];
        let corners = self.picture.map_or_else(about, |p| p.corners().to_vec());
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
    pub(crate) fn title(&self) -> String {
        let name = Path::new(self.picture_path).file_name();
        name.map_or_else(|| self.picture_path.to_owned(), |n| n.to_string_lossy().into_owned())
    }
}

impl Picture<'_> {
    /// Its four corners on the target, m.
    pub(crate) fn corners(&self) -> [Point; 4] {
        let (w, h) = (f64::from(self.raster.width()), f64::from(self.raster.height()));
        [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)].map(|(u, v)| self.target_from_pixel * Point::new(u, v))
    }
}

/// Chords of shown strokes stay this close to them, m: a tenth of a millimetre is under a pixel everywhere.
pub(crate) const DISPLAY_TOLERANCE_M: f64 = 1e-4;
