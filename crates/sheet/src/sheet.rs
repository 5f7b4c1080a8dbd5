//! A sheet of paper, as told.

use tracelight_stroke::Point;

/// A sheet of paper in a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Where its paper ends, clockwise from the upper left, px; where it runs out of the picture, the picture's border.
    /// A bent side has more points than its ends.
    pub outline: Vec<Point>,
    /// Its corners, clockwise from the upper left, px, where all four of its sides are in the picture.
    pub corners: Option<[Point; 4]>,
    /// Share of the picture that lies beside it.
    pub beside: f64,
}
