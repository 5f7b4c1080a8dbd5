//! What shows where a drawing will be before it is drawn.

use tracelight_stroke::{Drawing, Path, Point, Rect, Stroke, extent};

/// Curves of a hull are within this of it, m.
const HULL_TOLERANCE_M: f64 = 1e-3;

/// Length of the arms that show a corner, as a share of the shorter side.
const ARM: f64 = 0.1;
/// Shortest and longest of them, m.
const ARM_M: (f64, f64) = (0.01, 0.1);

/// What is drawn round a drawing to show where it will be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// The upright rectangle that just holds it.
    Box,
    /// The shortest line round it.
    Hull,
    /// The corners of that rectangle.
    Corners,
}

impl Frame {
    /// The frame of a drawing on the target; nothing round nothing.
    pub(crate) fn of(self, drawing: &Drawing) -> Drawing {
        let Some(bounds) = extent(drawing) else { return Drawing::default() };
        let paths = match self {
            Self::Box => vec![Path::polyline(&corners(bounds), true)],
            Self::Hull => vec![Path::polyline(&hull(drawing), true)],
            Self::Corners => angles(bounds),
        };
        Drawing { strokes: paths.into_iter().flatten().map(Stroke::new).collect() }
    }
}

/// From the upper left on, clockwise as the wall is seen.
fn corners(of: Rect) -> [Point; 4] {
    [(of.x0, of.y1), (of.x1, of.y1), (of.x1, of.y0), (of.x0, of.y0)].map(Point::from)
}

/// Two arms at each corner.
fn angles(of: Rect) -> Vec<Option<Path>> {
    let [width, height] = [of.width(), of.height()];
    let arm = (ARM * width.min(height)).clamp(ARM_M.0, ARM_M.1);
    let all = corners(of);
    let towards = |from: Point, to: Point| {
        let way = to - from;
        if way.hypot() > 0.0 { from + way * (arm.min(0.5 * way.hypot()) / way.hypot()) } else { from }
    };
    let angle = |k: usize| {
        let (before, at, after) = (all[(k + 3) % 4], all[k], all[(k + 1) % 4]);
        Path::polyline(&[towards(at, before), at, towards(at, after)], false)
    };
    (0..4).map(angle).collect()
}

/// The convex hull (monotone chain: Andrew, "Another efficient algorithm for convex hulls in two dimensions", 1979).
fn hull(drawing: &Drawing) -> Vec<Point> {
    let flat = drawing.strokes.iter().flat_map(|stroke| stroke.path.flatten(HULL_TOLERANCE_M));
    let mut points: Vec<Point> = flat.collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let half = |points: &mut dyn Iterator<Item = Point>| {
        let mut chain: Vec<Point> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..] {
                if (b - a).cross(p - a) < 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut upper = half(&mut points.iter().copied());
    upper.extend(half(&mut points.iter().rev().copied()));
    upper
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawing() -> Drawing {
        let at = [(0.0, 0.0), (0.4, 0.1), (0.2, 0.1), (0.2, 0.3), (0.1, 0.1)].map(Point::from);
        Drawing { strokes: vec![Stroke::new(Path::polyline(&at, false).unwrap())] }
    }

    #[test]
    fn a_frame_is_round_its_drawing() {
        let bounds = extent(&drawing()).unwrap();
        for frame in [Frame::Box, Frame::Hull, Frame::Corners] {
            assert_eq!(extent(&frame.of(&drawing())), Some(bounds), "{frame:?}");
        }
        let hull = Frame::Hull.of(&drawing());
        let path = &hull.strokes[0].path;
        let points: Vec<_> = path.pieces().map(|piece| (piece.from.x, piece.from.y)).collect();
        assert_eq!(points, [(0.0, 0.0), (0.2, 0.3), (0.4, 0.1)]);
        assert!(path.is_closed());
        assert_eq!(Frame::Corners.of(&drawing()).strokes.len(), 4);
    }

    #[test]
    fn a_line_has_a_frame_too() {
        let line = Path::polyline(&[(0.0, 0.0).into(), (0.5, 0.0).into()], false).unwrap();
        let line = Drawing { strokes: vec![Stroke::new(line)] };
        for frame in [Frame::Box, Frame::Hull, Frame::Corners] {
            let found = frame.of(&line);
            assert_eq!(extent(&found), extent(&line), "{frame:?}: {found:?}");
        }
        assert_eq!(Frame::Hull.of(&Drawing::default()), Drawing::default());
    }
}
