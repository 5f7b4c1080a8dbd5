//! Matrices in twice the digits: each entry is a sum of two numbers, the second less than the rounding of the first.
//!
//! Sums and products by Dekker (*A floating-point technique for extending the available precision*, Numer. Math. 18, 1971) and Knuth: of
//! additions and multiplications alone, so that the bits are the same on every processor.

use crate::Matrix;

/// A matrix as a sum of two.
#[derive(Clone)]
pub(crate) struct Twofold {
    high: Matrix,
    low: Matrix,
}

/// What a sum and its rounding are; of what is infinite only what it is.
fn sum(a: f64, b: f64) -> (f64, f64) {
    let whole = a + b;
    if !whole.is_finite() {
        return (whole, 0.0);
    }
    let part = whole - a;
    (whole, (a - (whole - part)) + (b - part))
}

/// The upper and the lower half of a number's digits.
fn halves(a: f64) -> (f64, f64) {
    /// 2²⁷ + 1.
    const SPLITTER: f64 = 134_217_729.0;
    let scaled = SPLITTER * a;
    let upper = scaled - (scaled - a);
    (upper, a - upper)
}

/// What a product and its rounding are; beyond 10²⁹⁹ only what it is.
fn product(a: f64, b: f64) -> (f64, f64) {
    const MOST: f64 = 1e299;
    let whole = a * b;
    if a.abs() > MOST || b.abs() > MOST || !whole.is_finite() {
        return (whole, 0.0);
    }
    let ((a1, a2), (b1, b2)) = (halves(a), halves(b));
    (whole, ((a1 * b1 - whole) + a1 * b2 + a2 * b1) + a2 * b2)
}

impl Twofold {
    /// A matrix as it is.
    pub(crate) fn of(high: Matrix) -> Self {
        let low = Matrix::zeros(high.nrows(), high.ncols());
        Self { high, low }
    }

    /// To the digits of one number.
    pub(crate) fn rounded(self) -> Matrix {
        self.high + self.low
    }

    pub(crate) fn plus(&self, other: &Self) -> Self {
        self.by_entry(|i, j| {
            let (whole, left) = sum(self.high[(i, j)], other.high[(i, j)]);
            sum(whole, left + (self.low[(i, j)] + other.low[(i, j)]))
        })
    }

    /// Of square matrices of one size.
    pub(crate) fn times(&self, other: &Self) -> Self {
        self.by_entry(|i, j| {
            (0..self.high.ncols()).fold((0.0, 0.0), |(whole, left), k| {
                let (a, b) = (self.high[(i, k)], other.high[(k, j)]);
                let (term, rest) = product(a, b);
                let rest = rest + (a * other.low[(k, j)] + self.low[(i, k)] * b);
                let (whole, lost) = sum(whole, term);
                sum(whole, left + (lost + rest))
            })
        })
    }

    /// Over a number.
    pub(crate) fn over(&self, divisor: f64) -> Self {
        self.by_entry(|i, j| {
            let (high, low) = (self.high[(i, j)], self.low[(i, j)]);
            let quotient = high / divisor;
            let (back, lost) = product(quotient, divisor);
            sum(quotient, ((high - back) - lost + low) / divisor)
        })
    }

    fn by_entry(&self, entry: impl Fn(usize, usize) -> (f64, f64)) -> Self {
        let (rows, columns) = self.high.shape();
        let mut all = Self::of(Matrix::zeros(rows, columns));
        for j in 0..columns {
            for i in 0..rows {
                (all.high[(i, j)], all.low[(i, j)]) = entry(i, j);
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(value: f64) -> Twofold {
        Twofold::of(Matrix::from_element(1, 1, value))
    }

    #[test]
    fn what_rounding_takes_from_a_sum_comes_back() {
        let all = one(1.0).plus(&one(1e-20)).plus(&one(-1.0));
        assert_eq!(all.rounded()[(0, 0)], 1e-20);
    }

    #[test]
    fn what_rounding_takes_from_a_product_comes_back() {
        // (1 + 2⁻⁵²)(1 − 2⁻⁵²) − 1 = −2⁻¹⁰⁴
        let off = f64::EPSILON;
        let all = one(1.0 + off).times(&one(1.0 - off)).plus(&one(-1.0));
        assert_eq!(all.rounded()[(0, 0)], -off * off);
        let third = one(1.0).over(3.0);
        assert_eq!(
            third.plus(&third).plus(&third).plus(&one(-1.0)).rounded()[(0, 0)].abs().max(1e-32),
            1e-32
        );
    }

    #[test]
    fn what_is_too_large_is_infinite_and_no_other_nonsense() {
        assert_eq!(one(1e200).times(&one(1e200)).rounded()[(0, 0)], f64::INFINITY);
        assert_eq!(one(1e300).times(&one(10.0)).rounded()[(0, 0)], 1e301);
    }
}
