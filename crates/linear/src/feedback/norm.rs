//! Norms of systems and loops, and why there is none.

use crate::feedback::function::LoopFunction;
use crate::{LinearError, Peak, Stability, TransferFunction};

/// An H∞ norm: the largest gain over all frequencies of what is stable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Norm {
    /// So large, and at which frequency.
    Finite(Peak),
    /// Infinite: a pole is on the edge of stability, or nearer to it than rounding lets tell.
    Edge,
    /// None: a pole grows.
    Unstable,
    /// Infinite: more zeros than poles, so that the gain grows with the frequency.
    Improper,
}

impl Norm {
    /// The norm as a number, if it is one.
    pub const fn peak(self) -> Option<Peak> {
        match self {
            Self::Finite(peak) => Some(peak),
            Self::Edge | Self::Unstable | Self::Improper => None,
        }
    }
}

impl TransferFunction {
    /// The H∞ norm.
    pub fn h_infinity(&self) -> Norm {
        match (self.stability(), self.peak()) {
            (Stability::Growing, _) => Norm::Unstable,
            (Stability::Marginal, _) => Norm::Edge,
            (Stability::Stable, None) => Norm::Improper,
            (Stability::Stable, Some(peak)) => Norm::Finite(peak),
        }
    }

    /// The H2 norm: what white noise of 1 comes out as. None of what is not stable, or does not fall with the frequency in continuous time.
    ///
    /// # Errors
    /// As [`StateSpace::h2_norm`](crate::StateSpace::h2_norm).
    pub fn h2_norm(&self) -> Result<Option<f64>, LinearError> {
        if self.stability() != Stability::Stable || self.relative_degree() < 0 {
            return Ok(None);
        }
        let norm = self.zpk().cascade("H2 norm")?.h2_norm()?;
        // squares of what is very small are 0, which it is not
        Ok(norm.filter(|norm| *norm > 0.0 || self.numerator().is_zero()))
    }
}

impl LoopFunction {
    /// The H∞ norm: none unless the whole loop is stable, also where this function does not show the pole that grows.
    pub fn h_infinity(&self) -> Norm {
        match self.growing().stability() {
            None | Some(Stability::Growing) => Norm::Unstable,
            Some(Stability::Marginal) => Norm::Edge,
            Some(Stability::Stable) if self.relative_degree() < 0 => Norm::Improper,
            Some(Stability::Stable) => match self.rational() {
                Some(rational) => rational.peak().map_or(Norm::Improper, Norm::Finite),
                None => Norm::Finite(self.highest()),
            },
        }
    }
}
