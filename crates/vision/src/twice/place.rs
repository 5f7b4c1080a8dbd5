//! Places on rows, and neighbouring places of other rows.

use tracelight_maths::sin;
use tracelight_stroke::{Point, Vec2};

use crate::row::Row;

/// Ways that are alike differ by no more than this angle, rad.
const ALIKE: f64 = 0.45;

/// A place on a row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) row: usize,
    /// Its number on that row.
    pub(super) number: usize,
    pub(super) way: Vec2,
}

/// The ways from place to place of a row.
pub(super) fn places(row: usize, r: &Row) -> impl Iterator<Item = Place> + '_ {
    let points = &r.points;
    (0..points.len()).map(move |number| Place { row, number, way: way_at(points, number) })
}

/// The direction at one of some points.
pub(super) fn way_at(points: &[Point], number: usize) -> Vec2 {
    let (before, behind) = (number.saturating_sub(3), (number + 3).min(points.len() - 1));
    let way = points[behind] - points[before];
    way / way.hypot().max(1e-9)
}

/// Whether two places lie beside each other on ways that are nearly parallel.
pub(super) fn is_beside(a: (Point, Vec2), b: (Point, Vec2)) -> bool {
    let across = b.0 - a.0;
    a.1.cross(b.1).abs() < sin(ALIKE) && across.dot(a.1).abs() < 0.7 * across.hypot() + 0.5
}

/// How long the way is from the first of some points to each of them, px.
pub(super) fn ways(points: &[Point]) -> Vec<f64> {
    let mut way = 0.0;
    let step = |k: usize| if k > 0 { points[k].distance(points[k - 1]) } else { 0.0 };
    (0..points.len())
        .map(|k| {
            way += step(k);
            way
        })
        .collect()
}
