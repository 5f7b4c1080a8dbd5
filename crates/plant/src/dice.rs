/// Seeded draws.
#[derive(Clone, Debug)]
pub(crate) struct Dice(oorandom::Rand64);

impl Dice {
    pub(crate) fn new(seed: u64) -> Self {
        Self(oorandom::Rand64::new(u128::from(seed)))
    }

    /// Uniform in [−1, 1).
    pub(crate) fn signed(&mut self) -> f64 {
        2.0 * self.0.rand_float() - 1.0
    }

    /// As good as normal, with a deviation of one: the sum of twelve draws.
    pub(crate) fn normal(&mut self) -> f64 {
        0.5 * (0..12).map(|_| self.signed()).sum::<f64>()
    }
}
