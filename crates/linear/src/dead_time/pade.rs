//! Rational systems that are nearly a dead time.

use std::f64::consts::TAU;

use tracelight_maths::complex;

use super::Delayed;
use crate::{Complex, LinearError, Polynomial, Time, TransferFunction};

/// Highest order of an approximation: those beyond have coefficients that say little in sixteen digits.
const MOST_ORDER: usize = 15;

/// Padé's approximation of e^(−sT) by as many zeros as poles: its gain is 1 at every frequency, its phase nearly −ωT.
fn pade(delay_s: f64, order: usize) -> Result<TransferFunction, LinearError> {
    let mut factor = 1.0;
    let mut low_first = vec![factor];
    for k in 0..order {
        factor *= delay_s * (order - k) as f64 / ((2 * order - k) * (k + 1)) as f64;
        low_first.push(factor);
    }
    let signed = |sign: fn(usize) -> f64| {
        let coefficients = low_first.iter().enumerate().rev().map(|(power, c)| sign(power) * c);
        Polynomial::new(coefficients.collect::<Vec<_>>())
    };
    let above = signed(|power| if power % 2 == 1 { -1.0 } else { 1.0 });
    TransferFunction::new(above, signed(|_| 1.0), Time::Continuous)
}

impl TransferFunction {
    /// Padé's approximation of a dead time of so many seconds, of an order from 1 to 15.
    ///
    /// # Errors
    /// [`LinearError::Range`] of a dead time that is no time or an order that is none of these.
    pub fn pade(delay_s: f64, order: usize) -> Result<Self, LinearError> {
        if !(delay_s >= 0.0 && delay_s.is_finite()) {
            return Err(LinearError::Range {
                name: "the dead time, s,",
                value: delay_s,
                below: String::new(),
            });
        }
        if !(1..=MOST_ORDER).contains(&order) {
            let below = format!(" and at most {MOST_ORDER}");
            return Err(LinearError::Range {
                name: "the order of Padé's approximation",
                value: order as f64,
                below,
            });
        }
        if delay_s == 0.0 { Ok(Self::gain(1.0, Time::Continuous)) } else { pade(delay_s, order) }
    }
}

impl Delayed {
    /// A rational system with the same gain, and nearly the same phase: with Padé's approximation of the dead time of an order from 1 to
    /// 15; the rational part alone without a dead time.
    ///
    /// # Errors
    /// As [`TransferFunction::pade`]; [`LinearError::NotFinite`] where coefficients become too large.
    pub fn approximated(&self, order: usize) -> Result<TransferFunction, LinearError> {
        match self.delay_s {
            0.0 => Ok(self.rational.clone()),
            delay_s => self.rational.series(&TransferFunction::pade(delay_s, order)?),
        }
    }

    /// By how much the phase of that approximation is off at a frequency, rad: more at higher frequencies.
    pub fn approximation_error_rad(&self, order: usize, rad_s: f64) -> f64 {
        let Ok(approximation) = TransferFunction::pade(self.delay_s, order.clamp(1, MOST_ORDER)) else {
            return f64::NAN;
        };
        // each pole turns by half of what it turns with its zero, none more than half a turn
        let turned: f64 = approximation
            .poles()
            .into_iter()
            .map(|pole| {
                let from = complex::arg(-pole);
                let to = complex::arg(Complex::new(0.0, rad_s) - pole);
                let by = to - from;
                if by < -TAU / 2.0 { by + TAU } else { by }
            })
            .sum();
        (2.0 * turned - rad_s * self.delay_s).abs()
    }

    /// The least order whose phase is off by no more than that, rad, up to that frequency, rad/s; 15 if none is.
    pub fn approximation_order(&self, rad_s: f64, within_rad: f64) -> usize {
        let enough = |order: &usize| self.approximation_error_rad(*order, rad_s) <= within_rad;
        (1..=MOST_ORDER).find(enough).unwrap_or(MOST_ORDER)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn approximations_are_those_of_the_textbook() {
        let first = TransferFunction::pade(0.2, 1).unwrap();
        assert_eq!(first.to_string(), "(−s + 10) / (s + 10)");
        let second = TransferFunction::pade(1.0, 2).unwrap();
        assert_eq!(second.to_string(), "(s² − 6 s + 12) / (s² + 6 s + 12)");
        assert!(TransferFunction::pade(1.0, 0).is_err() && TransferFunction::pade(-1.0, 2).is_err());
    }

    #[test]
    fn its_error_is_that_of_its_phase() {
        let delayed = Delayed::new(TransferFunction::gain(1.0, Time::Continuous), 0.7).unwrap();
        for order in [1, 2, 5, 9] {
            for w in [0.1, 1.0, 6.0, 12.0] {
                let approximation = delayed.approximated(order).unwrap();
                let off = (approximation.phase(w) + 0.7 * w).abs();
                let told = delayed.approximation_error_rad(order, w);
                assert!((off - told).abs() < 1e-9, "{order} {w}: {off} {told}");
            }
        }
        let order = delayed.approximation_order(12.0, 0.01);
        assert!(delayed.approximation_error_rad(order, 12.0) <= 0.01);
        assert!(delayed.approximation_error_rad(order - 1, 12.0) > 0.01);
    }
}
