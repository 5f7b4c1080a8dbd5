use std::ops::{Add, Mul, Sub};

use tracelight_maths::complex;

use crate::Complex;

/// A polynomial with real coefficients, highest power first, without leading zeros; the zero polynomial has none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polynomial(Vec<f64>);

impl Polynomial {
    /// Of these coefficients, highest power first. Zeros in front are dropped.
    pub fn new(coefficients: impl Into<Vec<f64>>) -> Self {
        let mut coefficients = coefficients.into();
        let leading = coefficients.iter().position(|&c| c != 0.0).unwrap_or(coefficients.len());
        coefficients.drain(..leading);
        Self(coefficients)
    }

    /// The polynomial 1.
    pub fn one() -> Self {
        Self(vec![1.0])
    }

    /// gain · Π(s − rootᵢ). Roots that are not real come in conjugate pairs; of a pair's sum and product only the real
    /// part is taken.
    pub fn from_roots(gain: f64, roots: &[Complex]) -> Self {
        // real factors, a pair each, so that rounding leaves nothing imaginary
        let mut product = Self::new([gain]);
        for factor in real_factors(roots) {
            product = &product * &factor;
        }
        product
    }

    /// Coefficients, highest power first.
    pub fn coefficients(&self) -> &[f64] {
        &self.0
    }

    /// Highest power; 0 of constants, and of zero.
    pub fn degree(&self) -> usize {
        self.0.len().saturating_sub(1)
    }

    /// Whether it is zero everywhere.
    pub fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether every coefficient is a number.
    pub fn is_finite(&self) -> bool {
        self.0.iter().all(|c| c.is_finite())
    }

    /// Coefficient of the highest power; 0 of zero.
    pub fn leading(&self) -> f64 {
        self.0.first().copied().unwrap_or_default()
    }

    /// Coefficient of the lowest power, its value at 0.
    pub fn constant(&self) -> f64 {
        self.0.last().copied().unwrap_or_default()
    }

    /// Value at a real place.
    pub fn value(&self, at: f64) -> f64 {
        self.0.iter().fold(0.0, |sum, c| sum * at + c)
    }

    /// Value at a complex place.
    pub fn at(&self, at: Complex) -> Complex {
        if at.re == 0.0 {
            // on the imaginary axis half of each product is none
            let step = |sum: Complex, &c: &f64| Complex::new(c - sum.im * at.im, sum.re * at.im);
            return self.0.iter().fold(Complex::ZERO, step);
        }
        self.0.iter().fold(Complex::ZERO, |sum, &c| sum * at + c)
    }

    /// Its derivative.
    pub fn derivative(&self) -> Self {
        let degree = self.degree();
        Self::new(
            self.0[..degree.min(self.0.len())]
                .iter()
                .zip(0..)
                .map(|(c, i): (_, usize)| c * (degree - i) as f64)
                .collect::<Vec<_>>(),
        )
    }

    /// Every coefficient times that.
    pub fn scaled(&self, by: f64) -> Self {
        Self::new(self.0.iter().map(|c| c * by).collect::<Vec<_>>())
    }

    /// With leading coefficient 1; zero stays zero.
    pub fn monic(&self) -> Self {
        Self::new(self.0.iter().map(|c| c / self.leading()).collect::<Vec<_>>())
    }

    /// Times sⁿ.
    pub fn shifted(&self, by: usize) -> Self {
        let zeros = std::iter::repeat_n(0.0, if self.is_zero() { 0 } else { by });
        Self(self.0.iter().copied().chain(zeros).collect())
    }

    /// Coefficient of sⁿ.
    pub fn coefficient(&self, power: usize) -> f64 {
        self.0.len().checked_sub(power + 1).map_or(0.0, |place| self.0[place])
    }

    /// bᵈ · p(a / b) for polynomials a, b and a power d of at least its degree: what becomes of it when its variable is
    /// replaced by a quotient.
    pub fn substituted(&self, numerator: &Self, denominator: &Self, power: usize) -> Self {
        // Horner's rule; the denominators that are missing are multiplied in as they are needed
        let mut sum = Self::default();
        let mut below = Self::one();
        for (i, &c) in self.0.iter().enumerate() {
            sum = &(&sum * numerator) + &below.scaled(c);
            if i < self.degree() {
                below = &below * denominator;
            }
        }
        (self.degree()..power).fold(sum, |sum, _| &sum * denominator)
    }
}

/// Factors with real coefficients of Π(s − rootᵢ).
fn real_factors(roots: &[Complex]) -> Vec<Polynomial> {
    let real = roots.iter().filter(|r| r.im == 0.0).map(|r| Polynomial(vec![1.0, -r.re]));
    let pairs = roots.iter().filter(|r| r.im > 0.0).map(|r| Polynomial(vec![1.0, -2.0 * r.re, r.norm_sqr()]));
    real.chain(pairs).collect()
}

/// Whether there is a conjugate for each that is not real.
pub(crate) fn are_paired(roots: &[Complex]) -> bool {
    let mut below: Vec<Complex> = roots.iter().filter(|r| r.im < 0.0).map(Complex::conj).collect();
    let mut above = roots.iter().filter(|r| r.im > 0.0);
    let all = above.all(|r| {
        let place = below.iter().position(|b| complex::norm(b - r) <= 1e-9 * complex::norm(*r));
        place.map(|place| below.swap_remove(place)).is_some()
    });
    all && below.is_empty()
}

impl Add for &Polynomial {
    type Output = Polynomial;

    fn add(self, other: Self) -> Polynomial {
        let size = self.0.len().max(other.0.len());
        Polynomial::new(
            (0..size)
                .rev()
                .map(|power| self.coefficient(power) + other.coefficient(power))
                .collect::<Vec<_>>(),
        )
    }
}

impl Sub for &Polynomial {
    type Output = Polynomial;

    fn sub(self, other: Self) -> Polynomial {
        self + &other.scaled(-1.0)
    }
}

impl Mul for &Polynomial {
    type Output = Polynomial;

    fn mul(self, other: Self) -> Polynomial {
        if self.is_zero() || other.is_zero() {
            return Polynomial::default();
        }
        let mut product = vec![0.0; self.0.len() + other.0.len() - 1];
        for (i, a) in self.0.iter().enumerate() {
            for (j, b) in other.0.iter().enumerate() {
                product[i + j] += a * b;
            }
        }
        Polynomial::new(product)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leading_zeros_are_dropped_and_zero_is_empty() {
        assert_eq!(Polynomial::new([0.0, 0.0, 2.0, 0.0]).coefficients(), [2.0, 0.0]);
        assert!(Polynomial::new([0.0, -0.0]).is_zero());
        assert_eq!(Polynomial::default().degree(), 0);
        let p = Polynomial::new([1.0, 2.0]);
        assert!((&p - &p).is_zero() && (&p * &Polynomial::default()).is_zero());
    }

    #[test]
    fn sums_products_and_derivatives_are_what_they_are_on_paper() {
        let (a, b) = (Polynomial::new([1.0, 2.0, 3.0]), Polynomial::new([4.0, 5.0]));
        assert_eq!((&a + &b).coefficients(), [1.0, 6.0, 8.0]);
        assert_eq!((&a * &b).coefficients(), [4.0, 13.0, 22.0, 15.0]);
        assert_eq!(a.derivative().coefficients(), [2.0, 2.0]);
        assert_eq!(Polynomial::new([7.0]).derivative(), Polynomial::default());
        assert_eq!(a.value(2.0), 11.0);
        assert_eq!(a.at(Complex::new(0.0, 1.0)), Complex::new(2.0, 2.0));
        assert_eq!(b.shifted(2).coefficients(), [4.0, 5.0, 0.0, 0.0]);
    }

    #[test]
    fn a_variable_is_replaced_by_a_quotient() {
        // 3 ((z − 1)/(z + 1))² + 2, times (z + 1)³
        let p = Polynomial::new([3.0, 0.0, 2.0]);
        let (minus, plus) = (Polynomial::new([1.0, -1.0]), Polynomial::new([1.0, 1.0]));
        let substituted = p.substituted(&minus, &plus, 3);
        let expected = |z: f64| (3.0 * ((z - 1.0) / (z + 1.0)).powi(2) + 2.0) * (z + 1.0).powi(3);
        for z in [0.0, 0.5, 2.0, -3.0] {
            assert!((substituted.value(z) - expected(z)).abs() < 1e-12, "{z}");
        }
    }

    #[test]
    fn roots_and_their_conjugates_make_real_factors() {
        let roots = [Complex::new(-1.0, 2.0), Complex::new(-1.0, -2.0), Complex::new(3.0, 0.0)];
        assert!(are_paired(&roots) && !are_paired(&roots[1..]));
        assert_eq!(Polynomial::from_roots(2.0, &roots).coefficients(), [2.0, -2.0, -2.0, -30.0]);
    }
}
