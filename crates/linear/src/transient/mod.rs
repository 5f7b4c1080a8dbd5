//! What a system answers to a step, an impulse or a ramp in closed form: a sum of its modes, from which its figures are computed.
//!
//! | part | what |
//! |---|---|
//! | `clusters` | poles in groups: each alone, or several that are too close together to be told apart |
//! | `term` | what a group contributes to the output |
//! | `expansion` | contributions from the coefficients of a transfer function |
//! | `taylor` | the output about a moment, and bounds of it for a while |
//! | `sweep` | first and last crossings of a level, largest and smallest values, none missed |
//! | `figures` | rise time, settling time, overshoot and the like |
//! | `sampled` | the same of a sampled system |

mod clusters;
mod expansion;
mod figures;
mod sampled;
mod sweep;
mod taylor;
mod term;

use crate::transient::term::Sum;
use crate::{Complex, LinearError, Time, TransferFunction};

pub use figures::{Extreme, StepInfo};

/// What comes in, from rest at time 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// 1 from then on.
    Step,
    /// Its integral over time is 1; of samples one sample of 1.
    Impulse,
    /// Rising by 1 a second.
    Ramp,
}

/// What an output does in the long run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending {
    /// It converges to this value.
    Converges(f64),
    /// It grows without bounds.
    Diverges,
    /// It oscillates for ever `about` a value, by no more than `by`.
    Oscillates {
        /// Mean value.
        about: f64,
        /// Sum of the amplitudes of all modes that do not die out.
        by: f64,
    },
    /// A pole is nearer to the edge of stability than the rounding of the coefficients: nobody can tell.
    Undecided,
}

impl Ending {
    /// The final value, if there is one.
    pub const fn value(self) -> Option<f64> {
        match self {
            Self::Converges(value) => Some(value),
            Self::Diverges | Self::Oscillates { .. } | Self::Undecided => None,
        }
    }
}

/// The output of a system in continuous time in closed form.
#[derive(Clone, Debug)]
pub struct Transient {
    ending: Ending,
    /// Area of the impulse at time 0 that an impulse passes through a system with as many zeros as poles; 0 of all others.
    impulse: f64,
    /// Poles that the output does not show, because a zero is at the same place.
    hidden: Vec<Complex>,
    sum: Sum,
}

impl TransferFunction {
    /// What this system in continuous time answers from rest.
    ///
    /// # Errors
    /// [`LinearError::Improper`] with more zeros than poles; [`LinearError::Shape`] of a sampled system.
    pub fn transient(&self, input: Input) -> Result<Transient, LinearError> {
        match self.time() {
            Time::Continuous => expansion::continuous(self, input),
            Time::Sampled(_) => Err(LinearError::Shape("a sampled system answers in samples, not in modes")),
        }
    }

    /// What a step of 1 ends in, and by what it is judged on the way there; settled is within that share of the final value.
    ///
    /// Of a continuous system the figures are those of its modes and depend on no grid; of a sampled one they are those of its samples,
    /// joined by straight lines.
    ///
    /// # Errors
    /// [`LinearError::Improper`] with more zeros than poles; [`LinearError::NotConverged`] if it takes too long to settle to be looked at
    /// everywhere.
    pub fn step_info(&self, band: f64) -> Result<StepInfo, LinearError> {
        match self.time() {
            Time::Continuous => self.transient(Input::Step)?.step_info(band),
            Time::Sampled(_) => sampled::step_info(self, band),
        }
    }

    /// How long a plot of what it answers has to be, s: until all that dies out has done so to a thousandth, or what grows has grown a
    /// thousandfold; what hardly decays is not waited for. 1 s of a constant.
    pub fn lasts_s(&self) -> f64 {
        let lasts_s = match self.time() {
            Time::Continuous => self.transient(Input::Impulse).map_or(0.0, |transient| transient.lasts_s()),
            Time::Sampled(period_s) => sampled::lasts_s(self, period_s),
        };
        if lasts_s > 0.0 { lasts_s } else { 1.0 }
    }
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
