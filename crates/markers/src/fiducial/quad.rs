//! Finds regions with four straight sides.

use tracelight_image::border::{Edge, area, border};
use tracelight_image::{Mask, Region};
use tracelight_stroke::Point;

use super::side::{self, Side, try_four};

/// Shortest side of a marker that can be read, px: little more than a pixel a cell.
pub(super) const LEAST_SIDE_PX: f64 = 9.0;
/// Largest deviation of a side from a straight line, root mean square: error of the pixel edges, px.
const MOST_OFF_PX: f64 = 0.75;
/// Further deviation for lens distortion, as a share of the side's length.
const MOST_BENT: f64 = 0.01;
/// Share of a side at each of its ends where blur has rounded the corner off.
const ROUNDED: f64 = 0.12;
/// Narrowest patch, as a share of its longest side: seen at 75° from the normal.
const NARROWEST: f64 = 0.25;

/// The border of a patch that a marker may be, or be part of.
pub(super) fn outline(mask: &Mask, patch: &Region, walked: &mut Mask) -> Option<Vec<Edge>> {
    let (width, height) = patch.extent();
    if (width.min(height) as f64) < LEAST_SIDE_PX {
        return None;
    }
    let first = patch.runs.first()?;
    Some(border(mask, first.from as isize, first.y as isize, walked))
}

/// Corners of a patch with four straight sides, clockwise as seen, to about half a pixel.
pub(super) fn of(mask: &Mask, patch: &Region, edges: &[Edge]) -> Option<[Point; 4]> {
    let (width, height) = patch.extent();
    // a ring as thin as the border of a marker has 7/16 of its square; turned by 45°, its box has twice the area
    if patch.at_border_px(mask) > 0 || (patch.area() as f64) < 0.1 * (width * height) as f64 {
        return None;
    }
    let points: Vec<Point> = edges.iter().map(Edge::middle).collect();
    let corners = furthest(&points)?;
    let sides: [Side; 4] = try_four(|k| through(&points, corners[k], corners[(k + 1) % 4]))?;
    let found = side::corners(&sides)?;
    // with as much area as the border encloses
    let share = area(&points) / area(&found);
    (is_square(&found) && (0.85..1.1).contains(&share)).then_some(found)
}

/// Points of a border that are looked at for corners; the exact ones are between them.
const LOOKED_AT: usize = 96;

/// Numbers of the four points that span the largest area, in order.
fn furthest(points: &[Point]) -> Option<[usize; 4]> {
    let stride = points.len().div_ceil(LOOKED_AT);
    let few: Vec<Point> = points.iter().copied().step_by(stride).collect();
    let most = |of: &dyn Fn(Point) -> f64| {
        let best = few.iter().map(|p| of(*p)).enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        best.map(|(i, _)| i)
    };
    let from = *few.first()?;
    let a = most(&|p| p.distance_squared(from))?;
    let c = most(&|p| p.distance_squared(few[a]))?;
    let along = few[c] - few[a];
    let (b, d) = (most(&|p| along.cross(p - few[a]))?, most(&|p| -along.cross(p - few[a]))?);
    let mut corners = [a, b, c, d];
    corners.sort_unstable();
    // clockwise with y down: a corner lies left of the way from the next back to the one before
    let area = |before: Point, after: Point, p: Point| (after - before).cross(before - p);
    for _ in 0..2 {
        for k in 0..4 {
            let (before, after) = (few[corners[(k + 3) % 4]], few[corners[(k + 1) % 4]]);
            corners[k] = most(&|p| area(before, after, p))?;
        }
    }
    let n = points.len();
    let rough = corners.map(|k| k * stride);
    let exact: [usize; 4] = std::array::from_fn(|k| {
        let (before, after) = (points[rough[(k + 3) % 4]], points[rough[(k + 1) % 4]]);
        let near = (0..=2 * stride).map(|d| (rough[k] + n + d - stride) % n);
        near.max_by(|&i, &j| area(before, after, points[i]).total_cmp(&area(before, after, points[j])))
            .unwrap_or(rough[k])
    });
    let apart = (0..4).all(|k| exact[k] != exact[(k + 1) % 4]);
    apart.then_some(exact)
}

/// Through the points of a closed row from one number to another, but for the ends; `None` if they are on no straight line.
fn through(points: &[Point], from: usize, to: usize) -> Option<Side> {
    let n = points.len();
    let count = (to + n - from) % n;
    let skip = (ROUNDED * count as f64).ceil() as usize;
    let length = points[from].distance(points[to]);
    if count < 2 * skip + 4 || length < LEAST_SIDE_PX {
        return None;
    }
    let between: Vec<Point> = (skip..count - skip).map(|k| points[(from + k) % n]).collect();
    let (side, off) = Side::fit(&between)?;
    (off <= MOST_OFF_PX + MOST_BENT * length).then_some(side)
}

/// Whether four corners can be those of a marker's border: convex, not too narrow.
pub(super) fn is_square(corners: &[Point; 4]) -> bool {
    let side = |k: usize| corners[(k + 1) % 4] - corners[k];
    let lengths: [f64; 4] = std::array::from_fn(|k| side(k).hypot());
    let (least, most) = lengths.iter().fold((f64::MAX, 0.0_f64), |(l, m), &v| (l.min(v), m.max(v)));
    let convex = (0..4).all(|k| side(k).cross(side((k + 1) % 4)) > 0.0);
    convex && least >= LEAST_SIDE_PX && least >= NARROWEST * most
}
