//! Pens whose line changes along the way: pressure, brushes, broad nibs, markers that run dry.

use tracelight_stroke::{Affine, Path, Point, Vec2};

/// Touches follow each other so closely that the edge between them is off by no more than this, px.
const SCALLOP_PX: f64 = 0.012;
/// Steps of a profile when its steepest place is looked for.
const PROFILE_STEPS: usize = 256;
/// A line's width changes by at most this share of the way: what changes faster is a shape.
const STEEPEST: f64 = 0.25;

/// Where a pen's tip lies on the paper for a moment: a disc, or a nib with two round ends.
#[derive(Clone, Copy, Debug)]
pub struct Touch {
    /// The middle of the tip.
    pub at: Point,
    /// From the middle to the middle of a round end; none for a disc.
    pub reach: Vec2,
    /// Radius of the ends, px.
    pub radius: f64,
    /// Share of the ink's darkness.
    pub dark: f64,
}

impl Touch {
    /// Moved by a similarity that keeps lengths.
    pub(crate) fn moved(&self, by: Affine) -> Self {
        let at = by * self.at;
        Self { at, reach: by * (self.at + self.reach) - at, ..*self }
    }
}

/// A place along a path.
#[derive(Clone, Copy)]
pub(crate) struct Along {
    pub(crate) at: Point,
    /// Share of the path's length up to here.
    pub(crate) share: f64,
}

/// Touches along a path, each as `tip` makes it of a place.
pub(crate) fn touches(path: &Path, tip: impl Fn(Along) -> Touch) -> Vec<Touch> {
    let points = path.flatten(0.01);
    let length: f64 = points.windows(2).map(|w| w[0].distance(w[1])).sum();
    let (mut touches, mut walked, mut next) = (Vec::new(), 0.0, 0.0);
    for pair in points.windows(2) {
        let piece = pair[0].distance(pair[1]);
        while next <= walked + piece && piece > 0.0 {
            let at = pair[0].lerp(pair[1], (next - walked) / piece);
            let touch = tip(Along { at, share: next / length });
            next += (8.0 * SCALLOP_PX * touch.radius).sqrt();
            touches.push(touch);
        }
        walked += piece;
    }
    touches.extend(points.last().map(|&at| tip(Along { at, share: 1.0 })));
    touches
}

/// `shape(share)` in [0, 1] made a width between `least` and `most`, where a line of this length is not too short for it;
/// else less of it.
pub(crate) fn profile(
    shape: impl Fn(f64) -> f64,
    (least, most): (f64, f64),
    length: f64,
) -> impl Fn(f64) -> f64 {
    let width = move |share: f64, least: f64| most * (least / most).powf(1.0 - shape(share).clamp(0.0, 1.0));
    let steepest = |least: f64| {
        let at = |i: usize| width(i as f64 / PROFILE_STEPS as f64, least);
        let step = length / PROFILE_STEPS as f64;
        (1..=PROFILE_STEPS).map(|i| (at(i) - at(i - 1)).abs() / step).fold(0.0, f64::max)
    };
    let mut bound = least;
    while bound < 0.97 * most && steepest(bound) > STEEPEST {
        bound *= 1.1;
    }
    let bound = bound.min(most);
    move |share| width(share, bound)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::line;

    #[test]
    fn a_short_line_swells_less() {
        let width = |length| profile(|share| 1.0 - share, (1.0, 9.0), length);
        assert!((width(400.0)(1.0) - 1.0).abs() < 1e-9 && (width(400.0)(0.0) - 9.0).abs() < 1e-9);
        assert!(width(24.0)(1.0) > 3.0, "{}", width(24.0)(1.0));
    }

    #[test]
    fn touches_reach_from_end_to_end() {
        let path = line(Point::new(1.0, 2.0), Point::new(31.0, 2.0));
        let tip = |along: Along| Touch { at: along.at, reach: Vec2::ZERO, radius: 2.0, dark: along.share };
        let found = touches(&path, tip);
        assert_eq!((found[0].at, found[found.len() - 1].at), (path.start(), path.end()));
        assert!(found.windows(2).all(|w| w[0].at.distance(w[1].at) < 0.45 && w[0].dark <= w[1].dark));
    }
}
