//! When a camera's images are taken, by their stamps.

/// How a camera's stamps relate to the rig's ticks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// By how much later than stamped an image is taken, s.
    pub late_s: f64,
    /// How much later its last row is than its first, s.
    pub readout_s: f64,
    /// How far off all that may be, s.
    pub unsure_s: f64,
}

impl Timing {
    /// Of a usual webcam that nobody has looked at.
    pub const USUAL: Self = Self { late_s: 0.0, readout_s: 0.02, unsure_s: 0.03 };
    /// How far off it may be once it was found from dots, s.
    pub const FOUND_S: f64 = 0.003;

    /// From when to when a row is exposed, s, so far down an image, as a share, that has that stamp and exposure.
    #[must_use]
    pub fn row_s(&self, stamp_s: f64, exposure_s: f64, down: f64) -> (f64, f64) {
        let from_s = stamp_s + self.late_s + down * self.readout_s;
        (from_s, from_s + exposure_s)
    }
}
