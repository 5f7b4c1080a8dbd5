//! Straight sides: through the points of a border, and where the grey levels fall.

use tracelight_image::Plane;
use tracelight_maths::{atan2, hypot, planar};
use tracelight_stroke::{Point, Vec2};

/// A straight side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    on: Point,
    along: Vec2,
}

impl Side {
    /// The line of least squared distances, the way the points go, and the root of their mean.
    pub(super) fn fit(points: &[Point]) -> Option<(Self, f64)> {
        let n = points.len() as f64;
        let mean = points.iter().map(|p| p.to_vec2()).sum::<Vec2>() / n;
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for p in points {
            let off = p.to_vec2() - mean;
            (xx, xy, yy) = (xx + off.x * off.x, xy + off.x * off.y, yy + off.y * off.y);
        }
        let angle = 0.5 * atan2(2.0 * xy, xx - yy);
        let along = planar::direction(angle);
        let across = (yy + xx - hypot(xx - yy, 2.0 * xy)).max(0.0) / 2.0;
        let along = if along.dot(*points.last()? - *points.first()?) < 0.0 { -along } else { along };
        Some((Self { on: mean.to_point(), along }, (across / n).sqrt()))
    }

    /// Where two cross.
    pub(super) fn meet(&self, other: &Self) -> Option<Point> {
        let sine = self.along.cross(other.along);
        // seen flatter than 10° no corner is known
        (sine.abs() > 0.17).then(|| self.on + self.along * ((other.on - self.on).cross(other.along) / sine))
    }
}

/// Corners of a dark square where four lines meet.
pub(super) fn corners(sides: &[Side; 4]) -> Option<[Point; 4]> {
    try_four(|k| sides[(k + 3) % 4].meet(&sides[k]))
}

/// Four of something, or none.
pub(super) fn try_four<T: std::fmt::Debug>(mut of: impl FnMut(usize) -> Option<T>) -> Option<[T; 4]> {
    (0..4).map(&mut of).collect::<Option<Vec<T>>>()?.try_into().ok()
}

/// Places along a side where its levels are looked at.
const PLACES: usize = 16;
/// Levels across it at each.
const LEVELS: usize = 13;

/// The corners of a dark square, about where these are, on the grey levels: each side through where they fall most.
pub(super) fn refined(plane: &Plane<u8>, rough: &[Point; 4]) -> Option<[Point; 4]> {
    let sides: [Side; 4] = try_four(|k| {
        let (from, to) = (rough[k], rough[(k + 1) % 4]);
        let length = from.distance(to);
        let along = (to - from) / length;
        // clockwise as seen, with y down, bright is on the left
        let outward = Vec2::new(along.y, -along.x);
        // no further than to the middles of the cells on either side, or by as much as a rough side may be off
        let reach = (0.5 * length / 8.0).clamp(1.0, 3.0);
        let step = outward * (2.0 * reach / (LEVELS - 1) as f64);
        let mut places = Vec::with_capacity(PLACES);
        for i in 0..PLACES {
            let at = from.lerp(to, 0.06 + 0.88 * (i as f64 + 0.5) / PLACES as f64);
            let mut levels = [0.0; LEVELS];
            plane.along(at - outward * reach, step, &mut levels);
            let (mut sum, mut weights) = (0.0, 0.0);
            for (k, two) in levels.windows(2).enumerate() {
                let rise = f64::from((two[1] - two[0]).max(0.0));
                (sum, weights) = (sum + rise * rise * (k as f64 + 0.5), weights + rise * rise);
            }
            if weights > 1.0 {
                places.push(at + step * (sum / weights) - outward * reach);
            }
        }
        if places.len() < PLACES / 2 {
            return None;
        }
        Some(Side::fit(&places)?.0)
    })?;
    let corners = corners(&sides)?;
    let near = (0..4).all(|k| corners[k].distance(rough[k]) < 3.0);
    near.then_some(corners)
}
