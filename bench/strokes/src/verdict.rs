//! What the tracer made of one picture.

use std::time::{Duration, Instant};

use tracelight_image::Grey;
use tracelight_stroke::{Drawing, Point, Score, Stroke, StrokeKind, compare, score};
use tracelight_vision::{Options, trace};

use crate::Picture;
use crate::page::crossings;

/// One picture's result.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// True strokes.
    pub truth: usize,
    /// What was found; none if the picture was refused.
    pub found: Drawing,
    /// Its score; none if nothing was found.
    pub score: Option<Score>,
    /// Light where none should be.
    pub astray: Astray,
    /// Why it was refused.
    pub refused: Option<String>,
    /// What tracing took.
    pub took: Duration,
}

/// Light that no true stroke asks for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Astray {
    /// Drawn length further than 8 px from all true ink, px.
    pub flying_px: f64,
    /// Share of the drawn length that follows the edge of what is truly a line.
    pub outlined: f64,
}

/// Light further than this from all ink flies, px.
const FLYING_PX: f64 = 8.0;

impl Astray {
    /// Of what was found, for a tolerance in px.
    pub fn of(found: &Drawing, truth: &Drawing, tolerance_px: f64) -> Self {
        let length = found.length(1e-2);
        let half_pen = 0.5 * truth.strokes.iter().filter_map(|s| s.pen).fold(0.0, f64::max);
        let of_kind =
            |kind| Drawing { strokes: truth.strokes.iter().filter(|s| s.kind == kind).cloned().collect() };
        let (lines, edges) = (of_kind(StrokeKind::Centreline), of_kind(StrokeKind::Outline));
        let outlined = |stroke: &Stroke| {
            let by_lines = near(std::slice::from_ref(stroke), &lines, tolerance_px + half_pen);
            let by_edges = near(std::slice::from_ref(stroke), &edges, tolerance_px);
            if by_lines > by_edges { by_lines * stroke.path.length(1e-2) } else { 0.0 }
        };
        let outlines = found.strokes.iter().filter(|s| s.kind == StrokeKind::Outline);
        Self {
            flying_px: flying(&beside_areas(found, &edges), truth, FLYING_PX + half_pen),
            outlined: outlines.map(outlined).fold(0.0, |sum, l| sum + l) / length.max(1.0),
        }
    }
}

/// What was found, without what lies inside filled areas: that is ink.
fn beside_areas(found: &Drawing, edges: &Drawing) -> Vec<Vec<Point>> {
    let lines = found.strokes.iter().map(|s| s.path.flatten(1e-2));
    let areas: Vec<_> = edges.strokes.iter().map(|s| s.path.flatten(1e-2)).collect();
    if areas.is_empty() {
        return lines.collect();
    }
    let inside = |at: Point| {
        let crossed = areas.iter().flat_map(|a| crossings(a, at.y)).filter(|&x| x < at.x).count();
        !crossed.is_multiple_of(2)
    };
    let steps = |pair: &[Point]| {
        let count = pair[0].distance(pair[1]).ceil().max(1.0);
        let at = move |i: usize, pair: &[Point]| pair[0].lerp(pair[1], i as f64 / count);
        (0..count as usize).map(|i| vec![at(i, pair), at(i + 1, pair)]).collect::<Vec<_>>()
    };
    let pieces = lines.flat_map(|line| line.windows(2).flat_map(steps).collect::<Vec<_>>());
    pieces.filter(|piece| !inside(piece[0].midpoint(piece[1]))).collect()
}

/// Length of lines that is further from the truth, px.
fn flying(lines: &[Vec<Point>], truth: &Drawing, within_px: f64) -> f64 {
    let length: f64 = lines.iter().flat_map(|l| l.windows(2)).map(|w| w[0].distance(w[1])).sum();
    compare(lines, truth, within_px).map_or(0.0, |found| length * (1.0 - found.precision))
}

/// Share of the strokes' length that lies this near to the truth.
fn near(strokes: &[Stroke], truth: &Drawing, within_px: f64) -> f64 {
    let lines: Vec<_> = strokes.iter().map(|s| s.path.flatten(1e-2)).collect();
    compare(&lines, truth, within_px).map_or(0.0, |found| found.precision)
}

/// Traces a picture and scores the strokes at a tolerance in px.
pub fn judge(picture: &Picture, tolerance_px: f64) -> Verdict {
    let started = Instant::now();
    let traced = Grey::new(picture.width, picture.height, picture.levels.clone())
        .map_err(|e| e.to_string())
        .and_then(|grey| trace(&grey, &Options::default()).map_err(|e| e.to_string()));
    let took = started.elapsed();
    let refused = traced.as_ref().err().cloned();
    let found = traced.map(|t| t.strokes).unwrap_or_default();
    let score = score(&found, &picture.truth, tolerance_px);
    let astray = Astray::of(&found, &picture.truth, tolerance_px);
    Verdict { truth: picture.truth.strokes.len(), found, score, astray, refused, took }
}

impl Verdict {
    /// Strokes too many (positive) or too few.
    pub fn surplus(&self) -> isize {
        self.found.strokes.len() as isize - self.truth as isize
    }

    /// How wrong, for the worst-first order: unmatched and surplus strokes, then ink; a refusal is as bad as missing all.
    pub fn badness(&self) -> f64 {
        let truth = self.truth as f64;
        self.score.map_or(2.0 * truth + 2.0, |s| {
            (truth - s.matched as f64) + self.surplus().unsigned_abs() as f64 + s.missed + s.stray
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_stroke::Path;

    fn drawing(lines: &[(&[(f64, f64)], StrokeKind)]) -> Drawing {
        let stroke = |&(points, kind): &(&[(f64, f64)], StrokeKind)| {
            let points: Vec<Point> = points.iter().map(|&p| p.into()).collect();
            Some(Stroke { kind, pen: Some(4.0), ..Stroke::new(Path::polyline(&points, false)?) })
        };
        Drawing { strokes: lines.iter().filter_map(stroke).collect() }
    }

    #[test]
    fn light_beyond_8_px_of_the_ink_flies() {
        let truth = drawing(&[(&[(0., 0.), (100., 0.)], StrokeKind::Centreline)]);
        let found = drawing(&[(&[(0., 1.), (100., 1.), (100., 60.)], StrokeKind::Centreline)]);
        let astray = Astray::of(&found, &truth, 2.0);
        // of 60 px upward, the pen's half and 8 px are near
        assert!((astray.flying_px - 50.0).abs() < 1.5, "{astray:?}");
        assert!(Astray::of(&truth, &truth, 2.0).flying_px < 1e-9);
    }

    #[test]
    fn a_line_drawn_as_its_edges_is_told() {
        let truth = drawing(&[
            (&[(0., 0.), (100., 0.)], StrokeKind::Centreline),
            (&[(0., 50.), (100., 50.)], StrokeKind::Outline),
        ]);
        let edges: [(&[(f64, f64)], StrokeKind); 2] = [
            (&[(0., -2.), (100., -2.), (100., 2.), (0., 2.)], StrokeKind::Outline),
            (&[(0., 50.), (100., 50.)], StrokeKind::Outline),
        ];
        let outlined = Astray::of(&drawing(&edges), &truth, 2.0).outlined;
        assert!((outlined - 204.0 / 304.0).abs() < 0.01, "{outlined}");
        assert!(Astray::of(&truth, &truth, 2.0).outlined < 1e-9);
    }
    #[test]
    fn light_inside_a_filled_area_does_not_fly() {
        let square = [(0., 0.), (100., 0.), (100., 100.), (0., 100.), (0., 0.)];
        let truth = drawing(&[(&square, StrokeKind::Outline)]);
        let found = drawing(&[(&[(50., 50.), (50., 300.)], StrokeKind::Centreline)]);
        let astray = Astray::of(&found, &truth, 2.0);
        // 50 of 250 px lie inside, 8 px and half a pen beyond the edge are near
        assert!((astray.flying_px - 190.0).abs() < 1.5, "{astray:?}");
    }
}
