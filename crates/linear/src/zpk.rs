use std::fmt;

use tracelight_maths::complex;

use crate::Complex;
use crate::error::LinearError;
use crate::notation::{four_digits, power, quadratic};
use crate::polynomial::{Polynomial, are_paired};
use crate::time::Time;
use crate::transfer::TransferFunction;

/// A transfer function by its gain, zeros and poles: gain · Π(s − zᵢ) / Π(s − pᵢ).
#[derive(Clone, Debug, PartialEq)]
pub struct Zpk {
    gain: f64,
    zeros: Vec<Complex>,
    poles: Vec<Complex>,
    time: Time,
}

impl Zpk {
    /// Complex zeros and poles come in conjugate pairs.
    pub fn new(gain: f64, zeros: Vec<Complex>, poles: Vec<Complex>, time: Time) -> Result<Self, LinearError> {
        if !(gain.is_finite() && zeros.iter().chain(&poles).all(|root| root.is_finite())) {
            return Err(LinearError::NotFinite);
        }
        if let Some(roots) = [&zeros, &poles].into_iter().find(|roots| !are_paired(roots)) {
            let lonely = roots.iter().find(|root| root.im != 0.0).copied().unwrap_or_default();
            return Err(LinearError::Unpaired(lonely.to_string()));
        }
        Ok(Self { gain, zeros, poles, time })
    }

    /// Of what is known to be paired.
    pub(crate) const fn of(gain: f64, zeros: Vec<Complex>, poles: Vec<Complex>, time: Time) -> Self {
        Self { gain, zeros, poles, time }
    }

    /// From time constants: gain · Π(1 − s/zᵢ) / Π(1 − s/pᵢ), where a zero or pole at 0 is a factor s. It is the form some design
    /// tools show; its gain is that of what is left when nothing changes.
    pub fn from_time_constants(
        gain: f64,
        zeros: Vec<Complex>,
        poles: Vec<Complex>,
    ) -> Result<Self, LinearError> {
        let gain = gain * constants(&poles) / constants(&zeros);
        Self::new(gain, zeros, poles, Time::Continuous)
    }

    /// Factor before the zeros and poles.
    pub const fn gain(&self) -> f64 {
        self.gain
    }

    /// Its gain in the form of time constants.
    pub fn time_constant_gain(&self) -> f64 {
        self.gain * constants(&self.zeros) / constants(&self.poles)
    }

    /// Where it is zero.
    pub fn zeros(&self) -> &[Complex] {
        &self.zeros
    }

    /// Where it is infinite.
    pub fn poles(&self) -> &[Complex] {
        &self.poles
    }

    /// Its time.
    pub const fn time(&self) -> Time {
        self.time
    }

    /// In the form of time constants: `0.6 (1 + s/32.9) / (s (1 + s/250))`.
    pub fn time_constants(&self) -> String {
        let factor = |root: &Complex| match (root.re, root.im) {
            (0.0, 0.0) => self.time.variable().to_owned(),
            (re, 0.0) => format!("(1 {} s/{})", if re > 0.0 { '−' } else { '+' }, four_digits(re.abs())),
            (re, _) => {
                let natural = complex::norm(*root);
                format!("(1 + 2·{}·s/{n} + (s/{n})²)", four_digits(-re / natural), n = four_digits(natural))
            }
        };
        quotient(self.time_constant_gain(), &self.zeros, &self.poles, &factor)
    }
}

/// Π(−rᵢ) of those that are not zero; a pair's product is real.
fn constants(roots: &[Complex]) -> f64 {
    let nonzero = roots.iter().filter(|root| **root != Complex::ZERO);
    nonzero.map(|root| -root).product::<Complex>().re
}

/// Factors that are the same, side by side, as one with a power.
fn powers(factors: impl Iterator<Item = (String, usize)>) -> Vec<String> {
    let mut runs: Vec<(String, usize)> = Vec::new();
    for (factor, times) in factors {
        match runs.last_mut() {
            Some((last, count)) if *last == factor => *count += times,
            _ => runs.push((factor, times)),
        }
    }
    runs.into_iter().map(|(factor, count)| power(&factor, count)).collect()
}

/// The gain and a factor for each root or pair.
fn quotient(gain: f64, zeros: &[Complex], poles: &[Complex], factor: &dyn Fn(&Complex) -> String) -> String {
    let factors = |roots: &[Complex]| powers(roots.iter().filter(|r| r.im >= 0.0).map(|r| (factor(r), 1)));
    fraction(gain, &factors(zeros), &factors(poles))
}

/// The gain and factors above and below a line.
fn fraction(gain: f64, above: &[String], below: &[String]) -> String {
    let top = match (gain, above.is_empty()) {
        (1.0, false) => above.concat(),
        (_, true) => four_digits(gain).replace('-', "−"),
        _ => format!("{} {}", four_digits(gain).replace('-', "−"), above.concat()),
    };
    match below {
        [] => top,
        [one] => format!("{top} / {one}"),
        several => format!("{top} / ({})", several.concat()),
    }
}

/// `(s + 32.9)`, of a pair `(s² + 2 s + 5)`.
fn factor(root: Complex, variable: &str) -> String {
    match (root.re, root.im) {
        (0.0, 0.0) => variable.to_owned(),
        (re, 0.0) => {
            format!("({variable} {} {})", if re > 0.0 { '−' } else { '+' }, four_digits(re.abs()))
        }
        (re, _) => quadratic(variable, -2.0 * re, root.norm_sqr()),
    }
}

impl fmt::Display for Zpk {
    /// `281 (s + 32.9)(s + 97.8) / ((s + 250)(s + 177))`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let variable = self.time.variable();
        f.write_str(&quotient(self.gain, &self.zeros, &self.poles, &|root| factor(*root, variable)))
    }
}

impl TransferFunction {
    /// In factors: `281 (s + 32.9)(s + 97.8) / (s²(s + 250)³)`. Roots that cannot be told apart are one with a power.
    pub fn factored(&self) -> String {
        let variable = self.time().variable();
        let factors = |polynomial: &Polynomial| {
            let roots = polynomial.distinct_roots().into_iter().filter(|root| root.value.im >= 0.0);
            powers(roots.map(|root| (factor(root.value, variable), root.count)))
        };
        fraction(self.numerator().leading(), &factors(self.numerator()), &factors(self.denominator()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn real(values: &[f64]) -> Vec<Complex> {
        values.iter().map(|&v| Complex::new(v, 0.0)).collect()
    }

    #[test]
    fn both_readings_of_the_reports_compensator_are_told_apart() {
        let (zeros, poles) = (real(&[-32.9, -97.8]), real(&[-250.0, -177.0]));
        let typeset = Zpk::new(281.0, zeros.clone(), poles.clone(), Time::Continuous).unwrap();
        let displayed = Zpk::from_time_constants(281.0, zeros, poles).unwrap();
        assert_eq!(typeset.to_string(), "281 (s + 32.9)(s + 97.8) / ((s + 250)(s + 177))");
        assert_eq!(displayed.time_constants(), "281 (1 + s/32.9)(1 + s/97.8) / ((1 + s/250)(1 + s/177))");
        assert!((displayed.transfer().dc_gain() - 281.0).abs() < 1e-10);
        assert!((typeset.time_constant_gain() - typeset.transfer().dc_gain()).abs() < 1e-12);
    }

    #[test]
    fn pairs_and_integrators_are_written_as_on_paper() {
        let pair = [Complex::new(-1.0, 2.0), Complex::new(-1.0, -2.0)];
        let poles = [&[Complex::ZERO][..], &pair].concat();
        let zpk = Zpk::new(10.0, vec![], poles, Time::Continuous).unwrap();
        assert_eq!(zpk.to_string(), "10 / (s(s² + 2 s + 5))");
        assert_eq!(zpk.transfer().denominator().coefficients(), [1.0, 2.0, 5.0, 0.0]);
        let double =
            Zpk::new(3.0, real(&[-1.0, -1.0, -1.0]), real(&[0.0, 0.0, -9.0, -9.0]), Time::Continuous);
        assert_eq!(double.unwrap().to_string(), "3 (s + 1)³ / (s²(s + 9)²)");
        let repeated =
            TransferFunction::parse("3 (s+1)^3/(s^2 (s+9)^2 (s^2+4)^2)", Time::Continuous).unwrap();
        assert_eq!(repeated.factored(), "3 (s + 1)³ / (s²(s² + 4)²(s + 9)²)");
        let lonely = Zpk::new(1.0, vec![], pair[..1].to_vec(), Time::Continuous);
        assert!(matches!(lonely, Err(LinearError::Unpaired(_))));
    }
}
