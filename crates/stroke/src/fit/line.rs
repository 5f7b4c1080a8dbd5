//! Finds the straight lines in a point sequence.

use kurbo::Point;

/// A straight line in a row of points, with the indices of the points it replaces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub(super) first: usize,
    pub(super) last: usize,
    pub(super) from: Point,
    pub(super) to: Point,
}
