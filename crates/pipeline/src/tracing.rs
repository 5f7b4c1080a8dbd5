//! How pixels become strokes, as values.

use tracelight_stroke::Point;
use tracelight_vision::{Mode, Options};

use crate::paper::Paper;

/// How pixels become strokes. By default, as the picture itself says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tracing {
    /// Lines, edges, or each part by its width.
    pub mode: Mode,
    /// Furthest a stroke may be from the ink's middle or edge, px.
    pub tolerance_px: f64,
    /// Change of direction from which on a break is a corner, rad.
    pub corner_rad: f64,
    /// What is ink: at least so much darker than its paper, % of its brightness; `None` where the picture says it.
    pub threshold_percent: Option<f64>,
    /// Smallest patch of ink that is kept, px²; `None` where the picture says it.
    pub despeckle_px2: Option<f64>,
    /// Shorter strokes are dropped.
    pub min_length: LeastLength,
    /// Sheets of paper lie in the picture: their edges are no lines.
    pub sheets: bool,
    /// All of the picture is drawing, even beside a sheet that is seen in it.
    pub whole: bool,
    /// How a sheet that was photographed at a slant is laid square.
    pub straighten: Straighten,
    /// The sheet's size.
    pub paper: Option<Paper>,
    /// Trace what looks like no drawing, too.
    pub force: bool,
}

impl Default for Tracing {
    fn default() -> Self {
        let Options { mode, tolerance_px, corner_rad, .. } = Options::default();
        Self {
            mode,
            tolerance_px,
            corner_rad,
            threshold_percent: None,
            despeckle_px2: None,
            min_length: LeastLength::Pixels(0.0),
            sheets: false,
            whole: false,
            straighten: Straighten::Auto,
            paper: None,
            force: false,
        }
    }
}

impl Tracing {
    /// For a picture of which a pixel is so long on the target, m.
    #[must_use]
    pub fn options(&self, metres_per_px: f64) -> Options {
        Options {
            mode: self.mode,
            tolerance_px: self.tolerance_px,
            corner_rad: self.corner_rad,
            threshold_percent: self.threshold_percent,
            despeckle_px2: self.despeckle_px2,
            min_length_px: self.min_length.in_units(metres_per_px),
            sheets: self.sheets,
            force: self.force,
        }
    }
}

/// How a sheet that was photographed at a slant is laid square.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Straighten {
    /// By its corners, where all four are found.
    #[default]
    Auto,
    /// Not at all.
    Off,
    /// By these, clockwise from the upper left, px.
    By([Point; 4]),
}

/// Where a length is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LeastLength {
    /// In the picture, px.
    Pixels(f64),
    /// On the target, m.
    Metres(f64),
}

impl LeastLength {
    /// In the sheet's unit, of which one is so long on the target.
    #[must_use]
    pub fn in_units(self, metres_per_unit: f64) -> f64 {
        match self {
            LeastLength::Pixels(px) => px,
            LeastLength::Metres(m) => m / metres_per_unit,
        }
    }
}
