//! Bounds of one joint's move.

/// Limits of one joint's move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least and highest velocity, below and above zero, unit/s.
    pub velocity: [f64; 2],
    /// Least and highest acceleration, below and above zero, unit/s².
    pub acceleration: [f64; 2],
    /// Highest jerk, unit/s³.
    pub jerk: f64,
}

impl Bounds {
    /// Makes bounds that are equal in both directions.
    pub const fn symmetric(velocity: f64, acceleration: f64, jerk: f64) -> Self {
        Self { velocity: [-velocity, velocity], acceleration: [-acceleration, acceleration], jerk }
    }

    pub(super) fn mirrored(&self) -> Self {
        let swap = |[least, most]: [f64; 2]| [-most, -least];
        Self { velocity: swap(self.velocity), acceleration: swap(self.acceleration), jerk: self.jerk }
    }
}
