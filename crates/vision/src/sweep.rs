//! The original report's tracer, kept for comparison: one closed figure, walked in steps of 5 px.

use tracelight_image::Mask;
use tracelight_maths::planar;
use tracelight_stroke::{Path, Point, Stroke, Vec2};

use crate::VisionError;

/// Length of a step, px: the report's.
const RADIUS_PX: f64 = 5.0;

/// Directions tried in one sweep. 5 px of radius sweep over 31.4 px: at 1/4 px each no pixel is left out.
const DIRECTIONS: usize = 128;

/// The figure as a polygon of 5 px steps.
///
/// From the first ink pixel, left to right and top to bottom: the pixel at radius 5 in the direction of the last
/// step (to the right at first) is tested, then those clockwise from there, until one is ink; there it goes on,
/// until the start is within a step. `ink_px` bounds the walk: a line of n pixels is not longer than n px.
///
/// # Errors
/// When no direction leads to ink, or the walk does not come back.
pub(crate) fn stroke(mask: &Mask, ink_px: usize) -> Result<Stroke, VisionError> {
    let start = mask.cells().next().map_or(Point::new(0.5, 0.5), |first| mask.centre(first));
    let most = ink_px / RADIUS_PX as usize + DIRECTIONS;
    let mut points = vec![start];
    let mut heading = 0;
    loop {
        let at = points[points.len() - 1];
        let step = points.len() - 1;
        if step >= most {
            return Err(VisionError::SweepEndless { x: start.x, y: start.y, steps: step });
        }
        let lost = VisionError::SweepLost { step, x: at.x, y: at.y, radius: RADIUS_PX };
        heading = next_heading(mask, at, heading).ok_or(lost)?;
        let next = at + direction(heading) * RADIUS_PX;
        // two steps out the start is no longer the place just left; from then on the walk may pass beside it
        if step >= 2 && passes(at, next, start) {
            return polygon(&points).ok_or(lost);
        }
        points.push(next);
    }
}

/// Whether the step from `a` to `b` comes as near to `start` as a step is long.
fn passes(a: Point, b: Point, start: Point) -> bool {
    let way = b - a;
    let share = ((start - a).dot(way) / way.hypot2()).clamp(0.0, 1.0);
    start.distance(a + way * share) < RADIUS_PX
}

/// The first direction that leads to ink: clockwise from `heading`, passing over the way back.
///
/// That way, from 160° to 280°, is where the last step came from; the report does not say so, but with it every walk
/// that drifts to the inner edge of its line would turn round there.
fn next_heading(mask: &Mask, at: Point, heading: usize) -> Option<usize> {
    const BACK: std::ops::Range<usize> = DIRECTIONS * 160 / 360..DIRECTIONS * 280 / 360;
    let ink = |p: Point| mask.get(p.x.floor() as isize, p.y.floor() as isize);
    let ahead = (0..DIRECTIONS).filter(|turn| !BACK.contains(turn));
    ahead.map(|turn| (heading + turn) % DIRECTIONS).find(|&h| ink(at + direction(h) * RADIUS_PX))
}

/// Clockwise as seen, y being down.
fn direction(heading: usize) -> Vec2 {
    planar::direction(std::f64::consts::TAU * heading as f64 / DIRECTIONS as f64)
}

fn polygon(points: &[Point]) -> Option<Stroke> {
    let path = Path::polyline(points, true)?;
    Some(Stroke::new(path))
}
