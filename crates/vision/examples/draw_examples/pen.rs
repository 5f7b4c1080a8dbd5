use tracelight_maths::{atan2, cos};
use tracelight_stroke::{Path, Point, Vec2};

use super::{TOLERANCE_PX, canvas::Canvas};

/// A join turning further than this is round: at 150° a mitre is already 1/cos 75° = 3.9 half widths long.
const MITRE_TURN_RAD: f64 = 150.0 / 180.0 * std::f64::consts::PI;

/// Draws a path with a pen of so many pixels: round ends, mitred corners.
///
/// A pixel is covered by half width − distance + ½, which is the exact area for an edge along the grid and within
/// 5 % of it for any other.
pub(crate) fn draw(canvas: &mut Canvas, path: &Path, width: f64) {
    let half = width / 2.0;
    let points = path.flatten(TOLERANCE_PX);
    for side in points.windows(2) {
        draw_side(canvas, side[0], side[1], half);
    }
    let wrapped = path.is_closed().then(|| points[1]);
    let ring: Vec<_> = points.iter().copied().chain(wrapped).collect();
    for corner in ring.windows(3) {
        draw_mitre(canvas, [corner[0], corner[1], corner[2]], half);
    }
}

fn draw_side(canvas: &mut Canvas, a: Point, b: Point, half: f64) {
    let reach = Vec2::new(half + 1.0, half + 1.0);
    let low = Point::new(a.x.min(b.x), a.y.min(b.y)) - reach;
    let high = Point::new(a.x.max(b.x), a.y.max(b.y)) + reach;
    let along = b - a;
    canvas.cover(low, high, |p| {
        let share = ((p - a).dot(along) / along.hypot2()).clamp(0.0, 1.0);
        half - p.distance(a + along * share) + 0.5
    });
}

/// The wedge beyond both sides of a corner: there the further of the two side lines bounds the ink.
fn draw_mitre(canvas: &mut Canvas, [a, corner, b]: [Point; 3], half: f64) {
    let (arrive, leave) = ((corner - a).normalize(), (b - corner).normalize());
    let turn = atan2(arrive.cross(leave), arrive.dot(leave)).abs();
    if turn > MITRE_TURN_RAD {
        return;
    }
    let reach = half / cos(turn / 2.0) + 1.0;
    let reach = Vec2::new(reach, reach);
    canvas.cover(corner - reach, corner + reach, |p| {
        let from = p - corner;
        let beyond = from.dot(arrive) >= 0.0 && from.dot(leave) <= 0.0;
        let far = from.cross(arrive).abs().max(from.cross(leave).abs());
        if beyond { half - far + 0.5 } else { 0.0 }
    });
}
