//! Result of a spot search.

use tracelight_stroke::{Point, Vec2};

/// A spot that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Its middle, pixel frame.
    pub at: Point,
    /// Standard deviation of either coordinate by what the fit leaves over, px.
    pub deviation_px: f64,
    /// Standard deviation of its light across, px: of a streak, beside it.
    pub radius_px: f64,
    /// From one end of its streak to the other, px; next to nothing of a spot at rest. Which end came first one image does not tell.
    pub streak: Vec2,
    /// Light in its middle above its surroundings, as a share of the brightest there can be; more than 1 of one that is clipped.
    pub brightness: f64,
    /// Pixels of it that were full.
    pub clipped: usize,
}

impl Spot {
    /// Of one whose pixels were smoothed (`Change::smoothed`), which adds half a pixel to its variances and spreads its light.
    pub(super) fn as_unsmoothed(self) -> Self {
        let smooth = self.radius_px * self.radius_px;
        let own = (smooth - 0.5).max(0.1);
        Self { radius_px: own.sqrt(), brightness: self.brightness * smooth / own, ..self }
    }
}
