//! Seeded draws.

/// Draws whose bits are the same everywhere.
pub(crate) struct Dice(oorandom::Rand64);

impl Dice {
    pub(crate) fn of_seed(seed: u128) -> Self {
        Self(oorandom::Rand64::new(seed))
    }

    /// A whole number from 0 up to one less than `most`.
    pub(crate) fn below(&mut self, most: usize) -> usize {
        self.0.rand_range(0..most as u64) as usize
    }

    pub(crate) fn one_in(&mut self, count: u64) -> bool {
        self.0.rand_range(0..count) == 0
    }

    pub(crate) fn of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())]
    }

    /// Whether something happens that happens so often, as a share of 1.
    pub(crate) fn happens(&mut self, share: f64) -> bool {
        self.0.rand_float() < share
    }

    /// A number from −1 to 1.
    pub(crate) fn either_way(&mut self) -> f64 {
        2.0 * self.0.rand_float() - 1.0
    }
}
