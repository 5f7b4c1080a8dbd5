//! What a camera saw before a run, and what the run adds.

use tracelight_eye::figures::{EyeFigures, FigureMatch, FollowFigures};
use tracelight_eye::follow::Followed;
use tracelight_eye::room::Furnished;
use tracelight_eye::trouble::TroubleAt;
use tracelight_picture::Raster;
use tracelight_rigfile::camera::KnownCamera;
use tracelight_sim::Run;
use tracelight_stroke::{Comparison, Drawing, Point, compare};

/// What was seen before a run.
pub(crate) struct Seen {
    /// The room, if it is simulated.
    pub(crate) room: Option<Furnished>,
    pub(crate) figures: EyeFigures,
    /// The image in which the figure was found.
    pub(crate) image: Raster,
    /// What the camera is known by, should it have to be found again.
    pub(crate) wall: KnownCamera,
    /// What is known when the camera begins to follow the spot.
    pub(crate) followed: Followed,
    /// The true figure on the wall, which a simulated room knows.
    pub(crate) truth: Option<Drawing>,
    /// What goes wrong in the room.
    pub(crate) troubles: Vec<TroubleAt>,
    /// What is off is seen, but not trimmed.
    pub(crate) open: bool,
    /// The day.
    pub(crate) today: String,
}

/// How far from the true figure a lit trace counts as beside it, m: what users of it see.
const BESIDE_M: f64 = 1.5e-3;

impl Seen {
    /// What a run adds: how far the lit trace truly is from the figure.
    pub(crate) fn after(&self, run: &Run, follow: Option<FollowFigures>) -> EyeFigures {
        let found = self.truth.as_ref().and_then(|truth| compare(&lit(run), truth, BESIDE_M));
        let figure_mm = found.map(|Comparison { rms, p99, max, coverage, .. }| FigureMatch {
            rms: 1e3 * rms,
            p99: 1e3 * p99,
            max: 1e3 * max,
            covered_share: coverage,
        });
        EyeFigures { figure_mm, follow, ..self.figures.clone() }
    }
}

/// Where there was light, tick by tick.
fn lit(run: &Run) -> Vec<Vec<Point>> {
    let mut lines: Vec<Vec<Point>> = vec![Vec::new()];
    for tick in &run.ticks {
        match (tick.light, tick.spot) {
            (true, Some(spot)) => lines.iter_mut().last().into_iter().for_each(|line| line.push(spot)),
            _ if lines.last().is_some_and(|line| !line.is_empty()) => lines.push(Vec::new()),
            _ => {}
        }
    }
    lines
}
