//! Where a spot is awaited.

use tracelight_stroke::Point;

/// Where a spot is looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotWindow {
    /// Its middle, px.
    pub centre: Point,
    /// Half of its side, px.
    pub half_px: usize,
}
