//! What a system answers to a step, an impulse or a ramp in closed form: a sum of its modes, from which its figures are computed.
//!
//! | part | what |
//! |---|---|
//! | `ending` | what comes in, what the output does in the long run |
//! | `closed_form` | the output as a sum of its modes |
//! | `clusters` | poles in groups: each alone, or several that are too close together to be told apart |
//! | `term` | what a group contributes to the output |
//! | `expansion` | contributions from the coefficients of a transfer function |
//! | `taylor` | the output about a moment, and bounds of it for a while |
//! | `sweep` | first and last crossings of a level, largest and smallest values, none missed |
//! | `figures` | rise time, settling time, overshoot and the like |
//! | `sampled` | the same of a sampled system |

mod closed_form;
mod clusters;
mod ending;
mod expansion;
mod figures;
mod sampled;
mod sweep;
mod taylor;
mod term;

use crate::{LinearError, Time, TransferFunction};

pub use closed_form::Transient;
pub use ending::{Ending, Input};
pub use figures::{Extreme, StepInfo};

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
