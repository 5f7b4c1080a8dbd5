//! Amplifiers with a gain that falls over time.

/// An amplifier that weakens, as one does that grows too hot: it gives less and less torque for a volt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weakening {
    /// What is left of its gain in the end, as a share of what it was.
    pub left: f64,
    /// How fast it gets there: shares of what it was a second.
    pub per_s: f64,
}

/// What is left of an amplifier's gain.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gain {
    share: f64,
    weakening: Weakening,
}

impl Gain {
    /// All of it, and so it stays.
    pub(crate) const FULL: Self = Self { share: 1.0, weakening: Weakening { left: 1.0, per_s: 0.0 } };

    /// Starts the weakening.
    pub(crate) const fn weaken(&mut self, weakening: Weakening) {
        self.weakening = weakening;
    }

    /// A moment later: the share of its gain that is left.
    pub(crate) fn after(&mut self, step_s: f64) -> f64 {
        let Weakening { left, per_s } = self.weakening;
        // what is lost does not come back
        self.share = (self.share - per_s * step_s).max(left).min(self.share);
        self.share
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gain_falls_at_its_rate_to_what_is_left_of_it_and_never_rises() {
        let mut gain = Gain::FULL;
        assert_eq!(gain.after(10.0), 1.0);
        gain.weaken(Weakening { left: 0.4, per_s: 0.5 });
        assert_eq!((gain.after(0.5), gain.after(0.5), gain.after(0.5)), (0.75, 0.5, 0.4));
        gain.weaken(Weakening { left: 0.8, per_s: 0.5 });
        assert_eq!(gain.after(1.0), 0.4);
    }
}
