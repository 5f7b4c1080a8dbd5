//! The output of a system as a sum of its modes.

use crate::Complex;
use crate::transient::ending::Ending;
use crate::transient::term::Sum;

/// The output of a system in continuous time in closed form.
#[derive(Clone, Debug)]
pub struct Transient {
    pub(super) ending: Ending,
    /// Area of the impulse at time 0 that an impulse passes through a system with as many zeros as poles; 0 of all others.
    pub(super) impulse: f64,
    /// Poles that the output does not show, because a zero is at the same place.
    pub(super) hidden: Vec<Complex>,
    pub(super) sum: Sum,
}

impl Transient {
    /// What the output does in the long run.
    pub const fn ending(&self) -> Ending {
        self.ending
    }

    /// Area of the impulse in the output at time 0, which [`at`](Self::at) leaves out.
    pub const fn impulse(&self) -> f64 {
        self.impulse
    }

    /// Poles that the output does not show, because a zero is at the same place.
    pub fn hidden(&self) -> &[Complex] {
        &self.hidden
    }

    /// Output at a time, s, right of any jump.
    pub fn at(&self, time_s: f64) -> f64 {
        self.sum.at(time_s)
    }
}
