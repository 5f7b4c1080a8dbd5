use tracelight_stroke::{Point, Stroke, StrokeKind, Vec2};

use crate::Grey;

/// How far beyond a line's edge its paper is looked at, px: beyond what blur leaves of the ink.
const BEYOND_PX: f64 = 2.5;
/// Spacing of the places that are looked at, px.
const SPACING_PX: f64 = 2.0;
/// Share of a stroke that may stand out less than is told: where it meets or crosses others, nothing tells it from them.
const LESS: f64 = 0.25;

/// By how much the ink along a stroke stands out from what is beside it, on *both* sides of a pen's line, in levels: but for a quarter of
/// its length at least so much. The edge of a sheet of paper or of a shadow stands out from one side only, and a patch that is cut out of
/// a gentle slope of light for part of its outline only: of such there is next to nothing left.
pub(crate) fn stands_out(grey: &Grey, stroke: &Stroke, light_on_dark: bool) -> f64 {
    let sign = if light_on_dark { -1.0 } else { 1.0 };
    let half = 0.5 * stroke.pen.unwrap_or(0.0);
    let mut found = Vec::new();
    for piece in stroke.path.pieces() {
        let length = piece.length(0.1);
        let count = (length / SPACING_PX).ceil().max(1.0) as usize;
        let place = |k: usize| piece.at((k as f64 + 0.5) / count as f64);
        for k in 0..count {
            let at = place(k);
            let ahead = piece.at(((k as f64 + 0.6) / count as f64).min(1.0))
                - piece.at((k as f64 + 0.4) / count as f64);
            let length = ahead.hypot();
            if length == 0.0 {
                continue;
            }
            let across = Vec2::new(-ahead.y, ahead.x) / length;
            let level = |off: f64| between(grey, at + across * off);
            found.push(match stroke.kind {
                StrokeKind::Centreline => {
                    let beside = [half + BEYOND_PX, -half - BEYOND_PX].map(|off| sign * level(off));
                    beside[0].min(beside[1]) - sign * level(0.0)
                }
                StrokeKind::Outline => level(BEYOND_PX) - level(-BEYOND_PX),
            });
        }
    }
    if found.is_empty() {
        return 0.0;
    }
    let place = |share: f64| ((share * found.len() as f64) as usize).min(found.len() - 1);
    let (middle, low) = (place(0.5), place(LESS));
    // on which side of an outline its ink is, most of it tells
    if stroke.kind == StrokeKind::Outline && *found.select_nth_unstable_by(middle, f64::total_cmp).1 < 0.0 {
        found.iter_mut().for_each(|v| *v = -*v);
    }
    found.select_nth_unstable_by(low, f64::total_cmp).1.max(0.0)
}

/// The level at a place, between pixels evenly.
fn between(grey: &Grey, at: Point) -> f64 {
    let (width, height) = (grey.width(), grey.height());
    let along = |v: f64, n: usize| {
        let v = (v - 0.5).clamp(0.0, (n - 1) as f64);
        let low = (v as usize).min(n - 2);
        (low, v - low as f64)
    };
    let ((x, fx), (y, fy)) = (along(at.x, width), along(at.y, height));
    let level = |x: usize, y: usize| f64::from(grey.levels()[y * width + x]);
    let upper = level(x, y) + fx * (level(x + 1, y) - level(x, y));
    let lower = level(x, y + 1) + fx * (level(x + 1, y + 1) - level(x, y + 1));
    upper + fy * (lower - upper)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_stroke::Path;

    /// 100 × 60 px: paper of 200 left of column 60, wall of 150 right of it; a pen's line of 40 along row 30, 4 px wide.
    fn wall() -> Grey {
        let level = |i: usize| match (i % 100, i / 100) {
            (10..50, 28..32) => 40,
            (0..60, _) => 200,
            _ => 150,
        };
        Grey::new(100, 60, (0..6000).map(level).collect()).unwrap()
    }

    fn line(points: &[(f64, f64)], closed: bool) -> Stroke {
        let points: Vec<Point> = points.iter().map(|&p| p.into()).collect();
        Stroke { pen: Some(4.0), ..Stroke::new(Path::polyline(&points, closed).unwrap()) }
    }

    #[test]
    fn ink_stands_out_and_the_edge_of_a_sheet_does_not() {
        assert!(stands_out(&wall(), &line(&[(12.0, 30.0), (48.0, 30.0)], false), false) > 155.0);
        assert!(stands_out(&wall(), &line(&[(60.0, 2.0), (60.0, 58.0)], false), false) < 1.0);
        // light ink on dark is the other way round
        assert!(stands_out(&wall(), &line(&[(12.0, 30.0), (48.0, 30.0)], false), true) < 1.0);
    }

    #[test]
    fn an_outline_stands_out_all_round_or_not() {
        let mut ink = line(&[(10.0, 28.0), (50.0, 28.0), (50.0, 32.0), (10.0, 32.0)], true);
        ink.kind = StrokeKind::Outline;
        assert!(stands_out(&wall(), &ink, false) > 100.0);
        // one side of it along the sheet's edge, the others nowhere
        let mut patch = line(&[(60.0, 40.0), (60.0, 58.0), (75.0, 50.0)], true);
        patch.kind = StrokeKind::Outline;
        assert!(stands_out(&wall(), &patch, false) < 1.0);
    }
}
