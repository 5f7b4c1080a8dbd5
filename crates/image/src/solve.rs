//! Small linear systems, and line fitting.

/// Solves n linear equations by Gaussian elimination with row pivoting; each row holds its coefficients and, behind
/// them, the right-hand side. `None` where they are dependent.
pub fn linear<const N: usize, const M: usize>(mut rows: [[f64; M]; N]) -> Option<[f64; N]> {
    for k in 0..N {
        let pivot = (k..N).max_by(|&a, &b| rows[a][k].abs().total_cmp(&rows[b][k].abs()))?;
        rows.swap(k, pivot);
        let chosen = rows[k];
        if !chosen[k].is_finite() || chosen[k].abs() < 1e-12 {
            return None;
        }
        for row in rows.iter_mut().skip(k + 1) {
            let share = row[k] / chosen[k];
            row.iter_mut().zip(chosen).for_each(|(cell, c)| *cell -= share * c);
        }
    }
    let mut solution = [0.0; N];
    for k in (0..N).rev() {
        let known: f64 = (k + 1..N).map(|j| rows[k][j] * solution[j]).sum();
        solution[k] = (rows[k][N] - known) / rows[k][k];
    }
    Some(solution)
}

/// Solves n linear equations whose coefficients are a symmetric, positive definite matrix, as those of least squares are, by Cholesky's
/// method without roots: no pivots. `None` where they are dependent.
pub fn symmetric<const N: usize>(mut rows: [[f64; N]; N], mut right: [f64; N]) -> Option<[f64; N]> {
    for k in 0..N {
        let pivot = rows[k][k];
        if pivot.is_nan() || pivot <= 1e-12 {
            return None;
        }
        let chosen = rows[k];
        for i in k + 1..N {
            let share = rows[i][k] / pivot;
            (k + 1..N).for_each(|j| rows[i][j] -= share * chosen[j]);
            right[i] -= share * right[k];
        }
    }
    for k in (0..N).rev() {
        let known: f64 = (k + 1..N).map(|j| rows[k][j] * right[j]).sum();
        right[k] = (right[k] - known) / rows[k][k];
    }
    Some(right)
}

/// The straight line nearest to some places, (x, y, weight) each, by least squares: y where x is 0, and its slope. `None` where all of
/// them are at one x.
pub fn line(places: impl Iterator<Item = (f64, f64, f64)>) -> Option<(f64, f64)> {
    let (mut n, mut x, mut y, mut xx, mut xy) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (px, py, weight) in places {
        (n, x, y) = (n + weight, x + weight * px, y + weight * py);
        (xx, xy) = (xx + weight * px * px, xy + weight * px * py);
    }
    let spread = n * xx - x * x;
    let slope = (n * xy - x * y) / spread;
    (spread > 1e-9).then(|| ((y - slope * x) / n, slope))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_equations_have_their_solution() {
        assert_eq!(linear([[0.0, 2.0, 4.0], [1.0, 1.0, 5.0]]), Some([3.0, 2.0]));
        assert_eq!(linear([[1.0, 2.0, 4.0], [2.0, 4.0, 5.0]]), None);
    }

    #[test]
    fn symmetric_equations_have_their_solution() {
        let rows = [[4.0, 2.0, 1.0], [2.0, 3.0, 0.5], [1.0, 0.5, 2.0]];
        let solution = symmetric(rows, [11.0, 9.5, 8.0]).unwrap();
        let right = rows.map(|row| row.iter().zip(solution).map(|(c, s)| c * s).sum::<f64>());
        assert!(right.iter().zip([11.0, 9.5, 8.0]).all(|(a, b)| (a - b).abs() < 1e-12), "{right:?}");
        assert_eq!(symmetric([[1.0, 2.0], [2.0, 4.0]], [1.0, 1.0]), None);
        assert_eq!(symmetric([[f64::NAN]], [1.0]), None);
    }
}
