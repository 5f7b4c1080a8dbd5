//! Search window of the spot.

use tracelight_stroke::Point;

/// Search window of the spot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotWindow {
    /// Its middle, px.
    pub centre: Point,
    /// Half of its side, px.
    pub half_px: usize,
}
