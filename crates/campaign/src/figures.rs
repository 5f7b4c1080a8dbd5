//! What is told of one picture.

use serde::{Deserialize, Serialize};
use tracelight_pipeline::{Placing, QualityFigures, Sketch};

/// A traced picture in figures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Figures {
    /// Strokes found.
    #[serde(rename = "count")]
    pub strokes: usize,
    /// Closed ones among them.
    pub closed: usize,
    /// Length of line, in `unit`.
    pub length: f64,
    /// Width and height of the sheet, in `unit`.
    pub sheet: (f64, f64),
    /// What lengths are in.
    pub unit: Unit,
    /// Share of the ink that lies on no stroke; none where there was no ink.
    pub missed_ink: Option<f64>,
    /// What the user should know about it.
    pub doubt: Option<String>,
    /// What its pixels are worth; none of a drawing.
    #[serde(default)]
    pub quality: Option<QualityFigures>,
}

/// What a picture is measured in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Unit {
    /// Millimetres on the target, where its size is known.
    Mm,
    /// The picture's own pixels.
    Px,
}

impl Unit {
    /// As it is written.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Unit::Mm => "mm",
            Unit::Px => "px",
        }
    }
}

/// Decimals kept of lengths and shares: as many as survive being written and read.
const DECIMALS: f64 = 1e6;

fn rounded(value: f64) -> f64 {
    (value * DECIMALS).round() / DECIMALS
}

impl Figures {
    /// Of a sketch, in millimetres if it was asked to be of a size or says its own.
    #[must_use]
    pub fn of(sketch: &Sketch, placing: &Placing) -> Self {
        let (width, height) = sketch.size;
        let asked = placing.asked_m(sketch.size);
        let metres = asked.or(sketch.true_width_m.map(|w| w / width));
        let (scale, unit) = metres.map_or((1.0, Unit::Px), |m| (1e3 * m, Unit::Mm));
        Self {
            strokes: sketch.drawing.strokes.len(),
            closed: sketch.drawing.strokes.iter().filter(|s| s.path.is_closed()).count(),
            length: rounded(sketch.drawing.length(1e-3) * scale),
            sheet: (rounded(width * scale), rounded(height * scale)),
            unit,
            missed_ink: sketch.missed_ink.map(rounded),
            doubt: (!sketch.remarks.is_empty()).then(|| sketch.remarks.join("; ")),
            quality: sketch.quality.as_ref().map(QualityFigures::of),
        }
    }
}
