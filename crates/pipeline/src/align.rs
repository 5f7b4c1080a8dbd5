//! Where a drawing goes by marks that were measured on the wall.

use serde::Serialize;
use tracelight_aim::{MARK_DEVIATION_M, Mark, MarkError, Marked, MarkedBy, MarkedSheet, marked};
use tracelight_stroke::Point;
use tracelight_task::Failure;

use crate::rounded::rounded;
use crate::sketch::Sketch;

/// A mark of a drawing, and where it belongs on the target.
#[derive(Clone, Debug, PartialEq)]
pub struct AskedMark {
    /// As it was typed, for messages.
    pub text: String,
    /// Where it is in the drawing.
    pub at: MarkedAt,
    /// Where it belongs, m.
    pub wall: Point,
}

/// Where a mark is in a drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MarkedAt {
    /// In a picture, or on a page, from its top left corner, px.
    Pixels(Point),
    /// In the coordinates of the file, or on a page from its top left corner, m.
    Metres(Point),
}

/// How a drawing lies by its marks, for scripts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AlignFigures {
    /// What the marks told: `place`, `turn`, `similarity`, `affine`, `projective`.
    pub by: &'static str,
    /// How far each mark lies from where it belongs, mm, in their order.
    pub residual_mm: Vec<f64>,
    /// Root mean square of these.
    pub rms_mm: f64,
    /// The mark that lies furthest off, from 1.
    pub worst: usize,
    /// How unsure the furthest corner of the drawing is, mm, where marks were measured to 1 mm, or worse if their residuals say so.
    pub corner_mm: f64,
    /// By how much it is turned anticlockwise, degrees.
    pub turn_deg: f64,
    /// By how much it is larger than its file says, %.
    pub larger_percent: Option<f64>,
    /// By how much two marks lie further apart on the wall than in the file, mm.
    pub further_apart_mm: Option<f64>,
}

/// How a sketch lies by its marks, with the sheet's unit in m where it is to keep it.
///
/// # Errors
/// `align`: a mark in a unit that the drawing does not have; marks that leave open where it lies, that mirror it, or that contradict what else is asked.
pub(crate) fn aligned(
    sketch: &Sketch,
    marks: &[AskedMark],
    sheet: &MarkedSheet,
) -> Result<(Marked, AlignFigures), Failure> {
    let places: Vec<Mark> = marks
        .iter()
        .map(|mark| Ok(Mark { sheet: on_sheet(sketch, mark)?, wall: mark.wall }))
        .collect::<Result<_, Failure>>()?;
    let found = marked(&places, sheet).map_err(|error| refused(marks, error))?;
    let true_m = sketch.true_width_m.map(|width_m| width_m / sketch.size.0);
    let larger_percent = true_m.map(|m| rounded(100.0 * (found.unit_m / m - 1.0)));
    let apart = |unit_m: f64| match places[..] {
        [a, b] => Some(rounded(1e3 * (a.wall.distance(b.wall) - unit_m * a.sheet.distance(b.sheet)))),
        _ => None,
    };
    let figures = AlignFigures {
        by: found.by.name(),
        residual_mm: found.residual_m.iter().map(|m| rounded(1e3 * m)).collect(),
        rms_mm: rounded(1e3 * found.rms_m()),
        worst: found.worst() + 1,
        corner_mm: rounded(1e3 * found.corner_m.iter().copied().fold(0.0, f64::max)),
        turn_deg: rounded(found.rotation_rad.to_degrees()),
        larger_percent,
        further_apart_mm: sheet.unit_m.or(true_m).and_then(apart),
    };
    Ok((found, figures))
}

fn refused(marks: &[AskedMark], error: MarkError) -> Failure {
    let all: Vec<String> = marks.iter().map(|mark| format!("\"{}\"", mark.text)).collect();
    Failure::usage("align", format!("--align {}: {error}", all.join(" ")))
}

/// Where on its sheet a mark is.
fn on_sheet(sketch: &Sketch, mark: &AskedMark) -> Result<Point, Failure> {
    let wrong = |why: &str| Err(Failure::usage("align", format!("--align \"{}\": {why}", mark.text)));
    let found = match mark.at {
        MarkedAt::Pixels(_) if !sketch.coordinates.has_pixels() => {
            return wrong(
                "this drawing has coordinates of its own, and no pixels: give the mark in them, such as \"0mm,0mm=1.2m,0.4m\"",
            );
        }
        MarkedAt::Pixels(at) => sketch.straightened(at),
        MarkedAt::Metres(at) => sketch.coordinates.on_sheet(at),
    };
    match found {
        Some(point) if point.is_finite() => Ok(point),
        _ => wrong(
            "nothing says how long this picture is: give the mark in pixels from its top left corner, such as \"120px,340px=1.2m,0.4m\"",
        ),
    }
}

impl AlignFigures {
    /// In words: one sentence each.
    #[must_use]
    pub fn words(&self, by: MarkedBy) -> Vec<String> {
        let marks = self.residual_mm.len();
        let told = if marks == 1 { "the mark tells" } else { "the marks tell" };
        let mut lies = format!("{told} {}: the drawing is turned by {:+.2}°", by.words(), self.turn_deg);
        if let (Some(percent), false) = (self.larger_percent, matches!(by, MarkedBy::Place | MarkedBy::Turn))
        {
            let way = if percent < 0.0 { "smaller" } else { "larger" };
            lies += &format!(", and {:.2} % {way} than its file says", percent.abs());
        }
        if let Some(mm) = self.further_apart_mm {
            let way = if mm < 0.0 { "nearer together" } else { "further apart" };
            lies += &format!("; on the wall the marks are {:.1} mm {way} than in the drawing", mm.abs());
        }
        let residual = if 2 * marks > by.parameters() {
            format!(
                "the marks are {:.1} mm off, rms; the worst is mark {}, {:.1} mm",
                self.rms_mm,
                self.worst,
                self.residual_mm.get(self.worst - 1).copied().unwrap_or_default()
            )
        } else {
            "nothing is left over to check the marks by: one more mark would show a wrong one".to_owned()
        };
        let sure = format!(
            "a corner of the drawing is known to {:.1} mm, if each mark was measured to {:.0} mm",
            self.corner_mm,
            1e3 * MARK_DEVIATION_M
        );
        vec![lies, residual, sure]
    }
}
