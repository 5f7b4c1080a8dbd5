//! Least squares, and how well it knows what it says.

use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// A value and how well it is known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Uncertain {
    /// The most likely one.
    pub value: f64,
    /// Half the width of the interval that has the true one in 95 of 100 cases.
    pub within: f64,
}

/// What Student's t is below in 97.5 of 100 cases.
pub(crate) fn student(degrees: f64) -> f64 {
    StudentsT::new(0.0, 1.0, degrees.max(1.0)).map_or(f64::INFINITY, |t| t.inverse_cdf(0.975))
}

/// What least squares found.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Regression {
    /// A factor for each column.
    pub(crate) factors: Vec<Uncertain>,
    /// Share of the variance about the mean that is explained.
    pub(crate) r2: f64,
    /// What is left, root mean square.
    pub(crate) left: f64,
}

/// Factors of `columns` that make `wanted` with the least squares of what is left (Draper & Smith, *Applied Regression Analysis*, 3rd
/// ed., §5.1); `None` if they cannot be told apart, or there are not more rows than columns.
pub(crate) fn regression(columns: &[Vec<f64>], wanted: &[f64]) -> Option<Regression> {
    // columns nearer to each other than this, as a share of their size, are one
    const APART: f64 = 1e-9;
    let (rows, asked) = (wanted.len(), columns.len());
    if rows <= asked || asked == 0 {
        return None;
    }
    // columns of unit length, so that what is small and what is large are told apart alike
    let sizes: Vec<f64> = columns.iter().map(|c| c.iter().map(|v| v * v).sum::<f64>().sqrt()).collect();
    if sizes.iter().any(|size| !(size.is_normal())) {
        return None;
    }
    let matrix = DMatrix::from_fn(rows, asked, |row, column| columns[column][row] / sizes[column]);
    let right = DVector::from_column_slice(wanted);
    let qr = matrix.clone().qr();
    let r = qr.r();
    if (0..asked).any(|k| r[(k, k)].abs() < APART) {
        return None;
    }
    let inverse = r.clone().try_inverse()?;
    let scaled = &inverse * (qr.q().transpose() * &right);
    let rest = &right - &matrix * &scaled;
    let left = rest.norm_squared();
    let degrees = (rows - asked) as f64;
    let (variance, t) = (left / degrees, student(degrees));
    let factor = |k: usize| {
        let spread = inverse.row(k).norm_squared();
        Uncertain { value: scaled[k] / sizes[k], within: t * (variance * spread).sqrt() / sizes[k] }
    };
    let mean = right.mean();
    let total: f64 = wanted.iter().map(|v| (v - mean) * (v - mean)).sum();
    Some(Regression {
        factors: (0..asked).map(factor).collect(),
        r2: if total > 0.0 { 1.0 - left / total } else { 1.0 },
        left: (left / rows as f64).sqrt(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The five points of the friction lines, worked by hand: slope 0.6, intercept 2.2, s² 0.8.
    #[test]
    fn a_line_is_found_with_the_textbooks_intervals() {
        let x = vec![1.0, 2.0, 3.0, 4.0, 5.0];
        let found = regression(&[vec![1.0; 5], x.clone()], &[2.0, 4.0, 5.0, 4.0, 5.0]).unwrap();
        let [intercept, slope] = [found.factors[0], found.factors[1]];
        assert!((slope.value - 0.6).abs() < 1e-12 && (intercept.value - 2.2).abs() < 1e-12);
        assert!((slope.within - 3.182_446 * 0.08_f64.sqrt()).abs() < 1e-5, "{found:?}");
        assert!((intercept.within - 3.182_446 * 0.88_f64.sqrt()).abs() < 1e-5, "{found:?}");
        assert!((found.r2 - 0.6).abs() < 1e-12 && (found.left - (2.4_f64 / 5.0).sqrt()).abs() < 1e-12);
        assert_eq!(regression(&[x.clone(), x.iter().map(|v| 2.0 * v).collect()], &[1.0; 5]), None);
        assert_eq!(regression(&[vec![0.0; 5]], &[1.0; 5]), None);
        assert_eq!(regression(&[vec![1.0]], &[1.0]), None);
    }
}
