//! Points that were to be marked.

use tracelight_stroke::Place;

/// A point that was to be marked.
#[derive(Clone, Debug, PartialEq)]
pub struct PointDone {
    /// Its number in the drawing, from 0.
    pub number: u32,
    /// The point, on the target.
    pub place: Place,
    /// When it was ticked off, s from the beginning of the run; `None` where it was not.
    pub done_s: Option<f64>,
}
