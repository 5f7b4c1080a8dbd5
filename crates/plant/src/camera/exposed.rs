//! Light on a sensor during one exposure.

use tracelight_stroke::Point;

/// Where the beam meets the wall at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotSample {
    /// When, s, by the clock of the rig.
    pub time_s: f64,
    /// Where, target frame, m.
    pub at: Point,
    /// Whether light leaves the head from then until the next sample.
    pub light: bool,
}

/// What fell on a sensor while an image was taken: all that tells it, before anybody looks.
#[derive(Clone, Debug, PartialEq)]
pub struct Exposed {
    /// Number of the image since the camera began.
    pub number: u64,
    /// When its first row began to be exposed, s, by the clock of the rig.
    pub start_s: f64,
    /// How long each row was.
    pub exposure_s: f64,
    /// Where the beam met the wall from then until the last row's end, in time order; what was before and after is dark.
    pub spots: Vec<SpotSample>,
}
