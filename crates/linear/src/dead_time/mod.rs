//! Systems with a dead time: G(s) e^(−sT), exactly.
//!
//! | part | what |
//! |---|---|
//! | `margins` | gain, phase and modulus margins, the delay that is left |
//! | `search` | places between two others |
//! | `stability` | how many poles of the closed loop grow |
//! | `curve` | Nyquist's curve, the closed loop's frequency response |
//! | `pade` | rational systems that are nearly the same, and by how much not |
//! | `steps` | what the closed loop answers, from dead time to dead time |
//! | `chain` | what a signal goes through once round a loop |
//! | `answer` | what the system or its closed loop answers, and its figures |

mod answer;
mod chain;
mod curve;
mod margins;
mod pade;
mod search;
mod stability;
mod steps;

use std::fmt;

use tracelight_maths::complex;

use crate::notation::four_digits;
use crate::turns::Turns;
use crate::{Complex, FrequencyResponse, LinearError, Time, TransferFunction};

pub use answer::Answer;
pub(crate) use chain::{Parts, Place};
pub(crate) use search::highest;
pub use stability::GrowingPoles;

/// A rational system in series with a dead time, s.
#[derive(Clone, Debug, PartialEq)]
pub struct Delayed {
    rational: TransferFunction,
    delay_s: f64,
}

impl Delayed {
    /// The dead time is 0 or more; of samples it is 0: there it is a power of z.
    ///
    /// # Errors
    /// [`LinearError::Range`] of a negative dead time, [`LinearError::Shape`] of one that stands beside samples.
    pub fn new(rational: TransferFunction, delay_s: f64) -> Result<Self, LinearError> {
        if !(delay_s >= 0.0 && delay_s.is_finite()) {
            return Err(LinearError::Range {
                name: "the dead time, s,",
                value: delay_s,
                below: String::new(),
            });
        }
        if delay_s > 0.0 && rational.time() != Time::Continuous {
            return Err(LinearError::Shape(
                "the dead time of a sampled system is a power of z: z^-3 is three samples",
            ));
        }
        Ok(Self { rational, delay_s })
    }

    /// What is not dead time.
    pub const fn rational(&self) -> &TransferFunction {
        &self.rational
    }

    /// The dead time, s.
    pub const fn delay_s(&self) -> f64 {
        self.delay_s
    }

    /// Value at a place.
    pub fn at(&self, at: Complex) -> Complex {
        match self.delay_s {
            0.0 => self.rational.at(at),
            delay_s => self.rational.at(at) * complex::exp(-at * delay_s),
        }
    }

    /// Value at a frequency, rad/s.
    pub fn at_frequency(&self, rad_s: f64) -> Complex {
        self.at(self.rational.time().at_frequency(rad_s))
    }

    /// At each of these frequencies, rad/s.
    pub fn frequency_response(&self, rad_s: Vec<f64>) -> FrequencyResponse {
        let mut response = self.rational.frequency_response(rad_s);
        if self.delay_s > 0.0 {
            for ((value, phase), w) in
                response.values.iter_mut().zip(&mut response.phases_rad).zip(&response.rad_s)
            {
                *value *= complex::from_polar(1.0, -w * self.delay_s);
                *phase -= w * self.delay_s;
            }
        }
        response
    }

    /// Phase at a frequency, rad, without jumps but those of poles and zeros on the imaginary axis.
    pub fn phase(&self, rad_s: f64) -> f64 {
        self.rational.phase(rad_s) - rad_s * self.delay_s
    }

    /// First this, then that.
    ///
    /// # Errors
    /// As [`TransferFunction::series`].
    pub fn series(&self, next: &Self) -> Result<Self, LinearError> {
        Self::new(self.rational.series(&next.rational)?, self.delay_s + next.delay_s)
    }

    /// Times a number.
    pub fn scaled(&self, by: f64) -> Self {
        Self { rational: self.rational.scaled(by), delay_s: self.delay_s }
    }

    /// Slope of ln L over the frequency: its real part is that of ln |L|, its imaginary part that of the phase, s.
    pub(crate) fn logarithmic_slope(&self, rad_s: f64) -> Complex {
        self.rational.logarithmic_slope(rad_s) - Complex::new(0.0, self.delay_s)
    }
}

impl fmt::Display for Delayed {
    /// `exp(−0.2 s) 2 / (s + 1)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.delay_s > 0.0 {
            let delay = if self.delay_s == 1.0 { String::new() } else { four_digits(self.delay_s) + " " };
            write!(f, "exp(−{delay}s) ")?;
        }
        self.rational.fmt(f)
    }
}

impl From<TransferFunction> for Delayed {
    fn from(rational: TransferFunction) -> Self {
        Self { rational, delay_s: 0.0 }
    }
}

/// Phases of one system at many frequencies.
struct Phases<'a> {
    of: &'a Delayed,
    turns: Turns,
}

impl<'a> Phases<'a> {
    fn of(of: &'a Delayed) -> Self {
        Self { of, turns: Turns::of(&of.rational) }
    }

    fn at(&self, rad_s: f64) -> f64 {
        let value = self.of.rational.at(Complex::new(0.0, rad_s));
        self.turns.phase(rad_s, value) - rad_s * self.of.delay_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> TransferFunction {
        TransferFunction::parse(text, Time::Continuous).unwrap()
    }

    #[test]
    fn a_dead_time_turns_and_leaves_the_gain() {
        let loops = Delayed::new(parse("3/(s+1)"), 0.5).unwrap();
        let response = loops.frequency_response(vec![0.1, 2.0, 40.0]);
        for (i, w) in [0.1_f64, 2.0, 40.0].into_iter().enumerate() {
            let phase = -w.atan() - 0.5 * w;
            assert!((response.phases_rad[i] - phase).abs() < 1e-12, "{w}");
            let value = complex::from_polar(3.0 / w.hypot(1.0), phase);
            assert!(
                complex::norm(response.values[i] - value) < 1e-14
                    && loops.at_frequency(w) == response.values[i]
                    || complex::norm(loops.at_frequency(w) - value) < 1e-14
            );
        }
        assert!(Delayed::new(parse("1"), -0.1).is_err());
        let sampled = TransferFunction::gain(1.0, Time::Sampled(0.1));
        assert!(Delayed::new(sampled.clone(), 0.1).is_err() && Delayed::new(sampled, 0.0).is_ok());
    }
}
