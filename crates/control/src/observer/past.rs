use super::config::LONGEST_INTERVAL_TICKS;

/// A power of two over the longest interval, so that "one interval ago" is never the present's own place.
const KEPT: usize = 2 * LONGEST_INTERVAL_TICKS;

/// A quantity of the last ticks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Past<T> {
    kept: [T; KEPT],
    now: usize,
}

impl<T: Copy> Past<T> {
    /// Fills the whole history with `value`.
    pub(super) const fn constant(value: T) -> Self {
        Self { kept: [value; KEPT], now: 0 }
    }

    /// One tick passes.
    pub(super) const fn push(&mut self, value: T) {
        self.now = (self.now + 1) % KEPT;
        self.kept[self.now % KEPT] = value;
    }

    /// The value that many ticks ago.
    pub(super) const fn ago(&self, ticks: usize) -> T {
        self.kept[self.now.wrapping_sub(ticks) % KEPT]
    }
}
