//! Where the spot was seen while a laser drew.

use tracelight_picture::Raster;
use tracelight_stroke::Point;

/// Where the spot was seen, and where it was asked to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenMark {
    /// Since the rig's power-up, s.
    pub time_s: f64,
    /// Where it was seen on the target, m.
    pub seen: Point,
    /// Where it was asked to be, m.
    pub asked: Point,
}

/// What a camera saw while the laser drew.
#[derive(Clone, Debug, Default)]
pub struct SeenLight {
    /// In the order they were seen.
    pub marks: Vec<SeenMark>,
    /// The spot of each image on the wall.
    pub painting: Option<Raster>,
}

impl SeenMark {
    /// How far it is from where it should be, mm.
    #[must_use]
    pub fn off_mm(&self) -> f64 {
        1e3 * self.seen.distance(self.asked)
    }
}
