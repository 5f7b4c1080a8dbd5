use std::fmt;

use tracelight_maths::complex;

use crate::Complex;
use crate::error::LinearError;
use crate::polynomial::Polynomial;
use crate::roots::Root;
use crate::time::Time;

/// A transfer function with one input and one output: a quotient of polynomials, its denominator monic.
///
/// Nothing is cancelled unless [`minimal`](Self::minimal) is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct TransferFunction {
    numerator: Polynomial,
    denominator: Polynomial,
    time: Time,
}

impl TransferFunction {
    /// A quotient of polynomials. The denominator must not be zero, and every coefficient a number.
    pub fn new(numerator: Polynomial, denominator: Polynomial, time: Time) -> Result<Self, LinearError> {
        if denominator.is_zero() {
            return Err(LinearError::NoDenominator);
        }
        let numerator = numerator.scaled(1.0 / denominator.leading());
        let denominator = denominator.monic();
        if !(numerator.is_finite() && denominator.is_finite()) {
            return Err(LinearError::NotFinite);
        }
        Ok(Self { numerator, denominator, time })
    }

    /// The same factor whatever comes.
    pub fn gain(gain: f64, time: Time) -> Self {
        Self { numerator: Polynomial::new([gain]), denominator: Polynomial::one(), time }
    }

    /// What is above.
    pub const fn numerator(&self) -> &Polynomial {
        &self.numerator
    }

    /// What is below; monic.
    pub const fn denominator(&self) -> &Polynomial {
        &self.denominator
    }

    /// Its time.
    pub const fn time(&self) -> Time {
        self.time
    }

    /// How many more poles than zeros; negative the other way round.
    pub fn relative_degree(&self) -> i64 {
        self.denominator.degree() as i64 - self.numerator.degree() as i64
    }

    /// Roots of the denominator, the slowest first.
    pub fn poles(&self) -> Vec<Complex> {
        self.denominator.root_values()
    }

    /// Roots of the numerator, the smallest first.
    pub fn zeros(&self) -> Vec<Complex> {
        self.numerator.root_values()
    }

    /// Value at a place; infinite at a pole.
    pub fn at(&self, at: Complex) -> Complex {
        let (above, below) = (self.numerator.at(at), self.denominator.at(at));
        if below == Complex::ZERO {
            return Complex::new(f64::INFINITY, 0.0);
        }
        // squares of what is far from 1 are no numbers
        let size = below.re.abs().max(below.im.abs());
        if (1e-140..1e140).contains(&size) { above / below } else { above / size / (below / size) }
    }

    /// What a constant comes out as, times it: the value at 0, or at z = 1; infinite of an integrator. Of samples, what is no more
    /// than rounding of the coefficients is nothing.
    pub fn dc_gain(&self) -> f64 {
        let value = |p: &Polynomial| match self.time {
            Time::Continuous => p.constant(),
            Time::Sampled(_) if p.may_vanish_at(Complex::ONE) => 0.0,
            Time::Sampled(_) => p.value(1.0),
        };
        let (above, below) = (value(&self.numerator), value(&self.denominator));
        if below == 0.0 && above == 0.0 { f64::NAN } else { above / below }
    }

    /// First this, then that.
    pub fn series(&self, next: &Self) -> Result<Self, LinearError> {
        let time = self.time.with(next.time)?;
        Self::new(&self.numerator * &next.numerator, &self.denominator * &next.denominator, time)
    }

    /// The sum of both.
    pub fn parallel(&self, other: &Self) -> Result<Self, LinearError> {
        let time = self.time.with(other.time)?;
        if self.denominator == other.denominator {
            return Self::new(&self.numerator + &other.numerator, self.denominator.clone(), time);
        }
        let above = &(&self.numerator * &other.denominator) + &(&other.numerator * &self.denominator);
        Self::new(above, &self.denominator * &other.denominator, time)
    }

    /// Closed by negative feedback through `back`: G / (1 + G H).
    pub fn feedback(&self, back: &Self) -> Result<Self, LinearError> {
        let time = self.time.with(back.time)?;
        let open = &self.numerator * &back.numerator;
        let below = &(&self.denominator * &back.denominator) + &open;
        // G H is −1 where s or z is infinite, or everywhere: what comes out at once would have no bounds
        if below.degree() < open.degree().max(self.denominator.degree() + back.denominator.degree())
            || below.is_zero()
        {
            return Err(LinearError::AlgebraicLoop);
        }
        Self::new(&self.numerator * &back.denominator, below, time)
    }

    /// Closed by negative feedback of its output itself: G / (1 + G).
    pub fn closed(&self) -> Result<Self, LinearError> {
        self.feedback(&Self::gain(1.0, self.time))
    }

    /// Times a number.
    pub fn scaled(&self, by: f64) -> Self {
        Self { numerator: self.numerator.scaled(by), ..self.clone() }
    }

    /// One over it.
    pub fn inverse(&self) -> Result<Self, LinearError> {
        Self::new(self.denominator.clone(), self.numerator.clone(), self.time)
    }

    /// Without the poles that a zero takes back, and those, each as the pole was: pairs no further apart than that share of their
    /// size, or than rounding of the coefficients can move them.
    pub fn minimal(&self, tolerance: f64) -> (Self, Vec<Complex>) {
        let (mut zeros, mut poles) = (self.numerator.roots(), self.denominator.roots());
        let mut cancelled = Vec::new();
        let close = |zero: &Root, pole: &Root| {
            let apart = complex::norm(zero.value - pole.value);
            apart
                <= zero.radius
                    + pole.radius
                    + tolerance * complex::norm(zero.value).max(complex::norm(pole.value))
        };
        let mut i = 0;
        while i < poles.len() {
            let pole = poles[i];
            let apart = |zero: &Root| complex::norm(zero.value - pole.value);
            let taken = (0..zeros.len())
                // what is real is taken back by what is real: pairs stay pairs
                .filter(|&j| close(&zeros[j], &pole) && (zeros[j].value.im == 0.0) == (pole.value.im == 0.0))
                .min_by(|&a, &b| apart(&zeros[a]).total_cmp(&apart(&zeros[b])));
            match taken {
                Some(j) => {
                    zeros.remove(j);
                    cancelled.push(poles.remove(i).value);
                }
                None => i += 1,
            }
        }
        if cancelled.is_empty() {
            return (self.clone(), cancelled);
        }
        let values = |roots: &[Root]| roots.iter().map(|root| root.value).collect::<Vec<_>>();
        let numerator = Polynomial::from_roots(self.numerator.leading(), &values(&zeros));
        (
            Self { numerator, denominator: Polynomial::from_roots(1.0, &values(&poles)), time: self.time },
            cancelled,
        )
    }
}

impl fmt::Display for TransferFunction {
    /// `(13.16 s² + 1.754 s + 10.29) / (s⁴ + …)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = |polynomial: &Polynomial| {
            let text = crate::notation::polynomial(polynomial, self.time.variable());
            if text.contains(' ') { format!("({text})") } else { text }
        };
        match self.denominator.degree() {
            0 => f.write_str(&crate::notation::polynomial(&self.numerator, self.time.variable())),
            _ => write!(f, "{} / {}", text(&self.numerator), text(&self.denominator)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tf(numerator: &[f64], denominator: &[f64]) -> TransferFunction {
        TransferFunction::new(Polynomial::new(numerator), Polynomial::new(denominator), Time::Continuous)
            .unwrap()
    }

    #[test]
    fn connections_are_those_of_the_textbook() {
        let (g, h) = (tf(&[2.0], &[1.0, 3.0]), tf(&[1.0, 1.0], &[1.0, 0.0]));
        assert_eq!(g.series(&h).unwrap(), tf(&[2.0, 2.0], &[1.0, 3.0, 0.0]));
        assert_eq!(g.parallel(&h).unwrap(), tf(&[1.0, 6.0, 3.0], &[1.0, 3.0, 0.0]));
        assert_eq!(g.parallel(&g).unwrap(), tf(&[4.0], &[1.0, 3.0]));
        assert_eq!(g.feedback(&h).unwrap(), tf(&[2.0, 0.0], &[1.0, 5.0, 2.0]));
        assert_eq!(g.closed().unwrap(), tf(&[2.0], &[1.0, 5.0]));
        assert_eq!(g.inverse().unwrap(), tf(&[0.5, 1.5], &[1.0]));
        assert_eq!(tf(&[4.0, 2.0], &[2.0]).relative_degree(), -1);
        let minus_one = TransferFunction::gain(-1.0, Time::Continuous);
        assert_eq!(minus_one.closed(), Err(LinearError::AlgebraicLoop));
        let sampled = TransferFunction::gain(1.0, Time::Sampled(0.1));
        assert!(matches!(g.series(&sampled), Err(LinearError::Sampling(..))));
    }

    #[test]
    fn what_is_taken_back_is_cancelled_and_said() {
        // (s + 1)(s² + 2 s + 5) / ((s + 1.000001)(s² + 2 s + 5)(s + 7))
        let pair = Polynomial::new([1.0, 2.0, 5.0]);
        let g = TransferFunction::new(
            &Polynomial::new([3.0, 3.0]) * &pair,
            &(&Polynomial::new([1.0, 1.000_001]) * &pair) * &Polynomial::new([1.0, 7.0]),
            Time::Continuous,
        );
        let g = g.unwrap();
        let (exact, cancelled) = g.minimal(0.0);
        assert_eq!((exact.denominator().degree(), cancelled.len()), (2, 2));
        let (less, cancelled) = g.minimal(1e-4);
        assert_eq!((less.denominator().degree(), cancelled.len()), (1, 3));
        assert!((less.dc_gain() - 3.0 / 7.0).abs() < 1e-14, "{less}");
    }

    #[test]
    fn a_loop_without_an_answer_is_refused() {
        let g = TransferFunction::parse("(s+2)/(s+1)*(0-1)", Time::Continuous).unwrap();
        assert_eq!(g.closed(), Err(LinearError::AlgebraicLoop));
        let g = TransferFunction::parse("s^2 (0-1)/(s+1)", Time::Continuous).unwrap();
        assert_eq!(g.closed().unwrap().relative_degree(), 0);
    }

    #[test]
    fn values_beyond_the_squares_of_numbers() {
        let g = tf(&[2e90], &[1.0, 1e9]).series(&tf(&[1e100], &[1.0, 1e150])).unwrap();
        let g = g.series(&tf(&[1.0], &[1.0, 1e30])).unwrap();
        assert!(
            complex::norm(g.at(Complex::new(0.0, 1e9)) - Complex::new(1e1, -1e1)) < 1e-10,
            "{}",
            g.at(Complex::new(0.0, 1e9))
        );
    }

    #[test]
    fn figures_at_the_edge() {
        assert_eq!(tf(&[1.0], &[1.0, 0.0]).dc_gain(), f64::INFINITY);
        assert!(tf(&[1.0, 0.0], &[1.0, 0.0]).dc_gain().is_nan());
        assert_eq!(tf(&[1.0], &[1.0, 2.0]).at(Complex::new(-2.0, 0.0)).re, f64::INFINITY);
        assert_eq!(
            TransferFunction::new(Polynomial::one(), Polynomial::default(), Time::Continuous),
            Err(LinearError::NoDenominator)
        );
        assert_eq!(tf(&[2.0, 1.0], &[1.0, 0.0, 4.0]).to_string(), "(2 s + 1) / (s² + 4)");
        assert_eq!(tf(&[13.33], &[1.0, 0.0]).to_string(), "13.33 / s");
    }
}
