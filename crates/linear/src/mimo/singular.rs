use tracelight_maths::complex;

use crate::mimo::gain::ComplexMatrix;
use crate::{Complex, LinearError, StateSpace};

/// Sweeps over all pairs of columns; some six are enough.
const MOST_SWEEPS: usize = 60;

/// Singular values, the largest first: small ones keep their digits beside large ones where the columns differ in size.
///
/// Pairs of columns are turned until all are at right angles (one-sided Jacobi: Demmel & Veselić, *Jacobi's method is more accurate than
/// QR*, SIAM J. Matrix Anal. Appl. 13, 1992).
pub fn singular_values(matrix: &ComplexMatrix) -> Vec<f64> {
    let mut m = if matrix.nrows() >= matrix.ncols() { matrix.clone() } else { matrix.adjoint() };
    // squares of what is far from 1 are no numbers
    let size = m.iter().map(|z| z.re.abs().max(z.im.abs())).fold(0.0, f64::max);
    if size == 0.0 || !size.is_finite() {
        return vec![size; m.ncols()];
    }
    m.iter_mut().for_each(|z| *z /= size);
    for _ in 0..MOST_SWEEPS {
        let mut is_done = true;
        for p in 0..m.ncols() {
            for q in p + 1..m.ncols() {
                is_done &= !turn(&mut m, p, q);
            }
        }
        if is_done {
            break;
        }
    }
    let mut values: Vec<f64> = m.column_iter().map(|column| size * column.norm()).collect();
    values.sort_by(|a, b| b.total_cmp(a));
    values
}

impl StateSpace {
    /// Singular values of the transfer matrix at each of these frequencies, rad/s, the largest first.
    ///
    /// # Errors
    /// As [`at`](Self::at).
    pub fn singular_values(&self, rad_s: &[f64]) -> Result<Vec<Vec<f64>>, LinearError> {
        rad_s.iter().map(|&w| Ok(singular_values(&self.at(self.time().at_frequency(w))?))).collect()
    }
}

/// Turns two columns to right angles; whether they were not.
fn turn(m: &mut ComplexMatrix, p: usize, q: usize) -> bool {
    let (own, other) = (m.column(p).norm_squared(), m.column(q).norm_squared());
    let along: Complex = m.column(p).iter().zip(m.column(q).iter()).map(|(a, b)| a.conj() * b).sum();
    let size = complex::norm(along);
    if size <= 4.0 * f64::EPSILON * (own * other).sqrt() || size == 0.0 {
        return false;
    }
    let ratio = (other - own) / (2.0 * size);
    let tangent = 1.0_f64.copysign(ratio) / (ratio.abs() + (1.0 + ratio * ratio).sqrt());
    let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
    let (sine, phase) = (cosine * tangent, along.conj() / size);
    for i in 0..m.nrows() {
        let (a, b) = (m[(i, p)], m[(i, q)] * phase);
        m[(i, p)] = a * cosine - b * sine;
        m[(i, q)] = a * sine + b * cosine;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_ones_keep_their_digits() {
        // columns of sizes 1 and 1e-20 at an angle of 45°
        let m = ComplexMatrix::from_row_slice(
            2,
            2,
            &[Complex::new(0.0, 1.0), Complex::new(1e-20, 0.0), Complex::ZERO, Complex::new(0.0, 1e-20)],
        );
        let values = singular_values(&m);
        assert!((values[0] - 1.0).abs() < 1e-15 && (values[1] / 1e-20 - 1.0).abs() < 1e-14, "{values:?}");
        assert_eq!(singular_values(&ComplexMatrix::zeros(2, 3)), [0.0, 0.0]);
    }
}
