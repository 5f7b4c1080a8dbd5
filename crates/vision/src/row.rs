//! Lines before they are fitted.

use tracelight_stroke::{Point, polyline_length};

/// A row of points to be fitted, and the pen that drew it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Row {
    pub(crate) points: Vec<Point>,
    pub(crate) closed: bool,
    /// Width of the pen, px.
    pub(crate) width: f64,
    /// Whether the line ends free at its first and last point: not at another line nor at a shape.
    pub(crate) free: [bool; 2],
    /// Whether this is a dot, whose direction says nothing.
    pub(crate) dot: bool,
}

impl Row {
    /// Of its ink, px².
    pub(crate) fn area_px2(&self) -> usize {
        (polyline_length(&self.points) * self.width) as usize
    }

    /// Its first (`end` 0) or last point.
    pub(crate) fn end(&self, end: usize) -> Point {
        self.points[end * (self.points.len() - 1)]
    }
}
