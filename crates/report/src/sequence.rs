//! Which stroke is drawn when, for somebody who follows the spot or looks for a line of the drawing.

use serde::Serialize;
use tracelight_rig::TICK_F64_S;
use tracelight_stroke::{Drawing, Point};
use tracelight_trajectory::Plan;

use crate::summary::round;

/// A stroke as it is drawn.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DrawnStroke {
    /// Place in the order, from 1, as the preview has it.
    pub number: usize,
    /// Layer it lay on, where the drawing has layers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub layer: Option<String>,
    /// Colour it had, where the drawing has colours.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub colour: Option<String>,
    /// What of the drawing file it comes from, such as `LINE 2F`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub entity: Option<String>,
    /// How long it is, m.
    pub length_m: f64,
    /// Where it begins on the target, m.
    pub from_m: [f64; 2],
    /// Where it ends, m.
    pub to_m: [f64; 2],
    /// When its light comes on, s; none where the plan has no light for it.
    pub lit_from_s: Option<f64>,
    /// When its light goes off, s.
    pub lit_to_s: Option<f64>,
}

/// Strokes in the order in which a plan draws them.
#[must_use]
pub fn sequence(drawing: &Drawing, plan: &Plan) -> Vec<DrawnStroke> {
    const LENGTH_TOLERANCE_M: f64 = 1e-6;
    let lit = plan.lit_ticks().into_iter().chain(std::iter::repeat(None));
    let seconds = |tick: u32| (f64::from(tick) * TICK_F64_S * 1e3).round() / 1e3;
    let place = |p: Point| [round(p.x), round(p.y)];
    let strokes = drawing.strokes.iter().zip(lit).enumerate();
    strokes
        .map(|(i, (stroke, lit))| DrawnStroke {
            number: i + 1,
            layer: stroke.layer.as_deref().map(str::to_owned),
            colour: stroke.colour.map(|colour| colour.to_string()),
            entity: stroke.entity.as_ref().map(ToString::to_string),
            length_m: round(stroke.path.length(LENGTH_TOLERANCE_M)),
            from_m: place(stroke.path.start()),
            to_m: place(stroke.path.end()),
            lit_from_s: lit.map(|[first, _]| seconds(first)),
            lit_to_s: lit.map(|[_, last]| seconds(last)),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn strokes_are_lit_one_after_the_other_as_they_are_numbered() {
        let fixture = fixture::star();
        let job = fixture.job();
        let drawn = sequence(job.drawing, job.plan);
        assert_eq!(drawn.len(), job.drawing.strokes.len());
        let numbers: Vec<usize> = drawn.iter().map(|stroke| stroke.number).collect();
        assert_eq!(numbers, (1..=drawn.len()).collect::<Vec<_>>());
        for pair in drawn.windows(2) {
            assert!(pair[0].lit_to_s.unwrap() < pair[1].lit_from_s.unwrap());
        }
        let lit_s: f64 = drawn.iter().map(|s| s.lit_to_s.unwrap() - s.lit_from_s.unwrap()).sum();
        assert!((lit_s - job.plan.lit_s()).abs() < 0.01, "{lit_s}");
    }
}
