//! Options of tracing.

use crate::VisionError;

/// Which tracer follows the ink.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Centrelines of pen lines, outlines of filled shapes, patch by patch.
    #[default]
    Auto,
    /// The middle of every line.
    Centreline,
    /// The edge of every patch.
    Outline,
    /// The original report's walk round one closed figure.
    Sweep,
}

impl Mode {
    /// `auto`, `centreline`, `outline` or `sweep`.
    pub const fn name(self) -> &'static str {
        match self {
            Mode::Auto => "auto",
            Mode::Centreline => "centreline",
            Mode::Outline => "outline",
            Mode::Sweep => "sweep",
        }
    }
}

/// How an image is traced. The default works on any clean drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Which tracer.
    pub mode: Mode,
    /// Furthest a path may be from the points found, px.
    pub tolerance_px: f64,
    /// Change of direction from which on a break is a corner, rad.
    pub corner_rad: f64,
    /// Darkness from which on a pixel is ink, % of its paper's brightness; `None`: found. On dark paper both count
    /// from white.
    pub threshold_percent: Option<f64>,
    /// Area of the smallest patch of ink that is kept, px²; 0 keeps all. `None`: by the picture's size and the pen.
    pub despeckle_px2: Option<f64>,
    /// Strokes shorter than this are dropped, px.
    pub min_length_px: f64,
    /// Whether sheets of paper lie or hang in the image: their edges are none of the drawing's.
    pub sheets: bool,
    /// Whether an image is traced that looks like no drawing.
    pub force: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            mode: Mode::Auto,
            tolerance_px: 0.35,
            corner_rad: 25f64.to_radians(),
            threshold_percent: None,
            despeckle_px2: None,
            min_length_px: 0.0,
            sheets: false,
            force: false,
        }
    }
}

impl Options {
    /// Bounds of [`Self::tolerance_px`]: closer than the pixels' noise allows nothing is followed, and ten pixels off
    /// no drawing is left.
    pub const TOLERANCE_PX: (f64, f64) = (0.05, 10.0);
    /// Bounds of [`Self::corner_rad`]: below 5° the pixels' noise makes corners, and sides that meet at less than a
    /// right angle are a corner to any pen.
    pub const CORNER_RAD: (f64, f64) = (5.0 / 180.0 * std::f64::consts::PI, std::f64::consts::FRAC_PI_2);
    /// Bounds of [`Self::threshold_percent`]: one level of 255, and one below total darkness.
    pub const THRESHOLD_PERCENT: (f64, f64) = (0.4, 99.6);
    /// Bounds of [`Self::despeckle_px2`]: up to the largest image that is not averaged down.
    pub const DESPECKLE_PX2: (f64, f64) = (0.0, 12e6);
    /// Bounds of [`Self::min_length_px`]: a hundred times round the largest image.
    pub const MIN_LENGTH_PX: (f64, f64) = (0.0, 1e6);

    /// Whether an image is refused that looks like no drawing: who says what is ink, that paper lies in it, or that shapes are
    /// meant has seen it.
    pub(crate) fn judges(&self) -> bool {
        let told = self.force || self.sheets || self.threshold_percent.is_some();
        !told && matches!(self.mode, Mode::Auto | Mode::Centreline)
    }

    pub(crate) fn check(&self) -> Result<(), VisionError> {
        let set = [
            ("--tolerance", Some(self.tolerance_px), Self::TOLERANCE_PX, "px"),
            ("--corner-angle", Some(self.corner_rad), Self::CORNER_RAD, "rad"),
            ("--threshold", self.threshold_percent, Self::THRESHOLD_PERCENT, "% of the paper's brightness"),
            ("--despeckle", self.despeckle_px2, Self::DESPECKLE_PX2, "px²"),
            ("--min-length", Some(self.min_length_px), Self::MIN_LENGTH_PX, "px"),
        ];
        let wrong = set.into_iter().find_map(|(option, value, (least, most), unit)| {
            let value = value.filter(|v| !(least..=most).contains(v))?;
            Some(VisionError::Option { option, value, least, most, unit })
        });
        wrong.map_or(Ok(()), Err)
    }
}
