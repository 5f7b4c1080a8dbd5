//! What an encoder counted.

/// Kinds of edges of a quadrature encoder.
pub(super) const PHASES: usize = 4;

/// An edge the encoder counted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    /// Since the record's first tick, s.
    pub(super) time_s: f64,
    /// The count above it.
    pub(super) number: i32,
    /// 1 or −1.
    pub(super) way: f64,
    /// Its time is known only to this much, s.
    pub(super) blur_s: f64,
}

impl Edge {
    /// Which kind of edge it is.
    pub(super) const fn phase(&self) -> usize {
        self.number.rem_euclid(PHASES as i32) as usize
    }

    /// Where it lies on a perfect disc, counts.
    pub(super) fn ideal_counts(&self) -> f64 {
        f64::from(self.number) - 0.5
    }
}
