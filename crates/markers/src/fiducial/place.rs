//! A point on the boundary between a marker's black and white.

use tracelight_stroke::Point;

/// The middle of a boundary between a black cell and a white one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TagPlace {
    /// Where it is on the marker, in cells from the upper left as printed: x to the right, y down, 8 of them a side.
    pub cell: Point,
    /// Whether the boundary is upright, or level.
    pub upright: bool,
    /// Whether black is on its right, or below.
    pub black_behind: bool,
    /// Where it is seen, px. Along the boundary nothing is known of it.
    pub at: Point,
}
