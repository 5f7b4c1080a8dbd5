/// Solves n linear equations by Gaussian elimination with row pivoting; each row holds its coefficients and, behind
/// them, the right-hand side. `None` where they are dependent.
pub(crate) fn linear<const N: usize, const M: usize>(mut rows: [[f64; M]; N]) -> Option<[f64; N]> {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_equations_have_their_solution() {
        assert_eq!(linear([[0.0, 2.0, 4.0], [1.0, 1.0, 5.0]]), Some([3.0, 2.0]));
        assert_eq!(linear([[1.0, 2.0, 4.0], [2.0, 4.0, 5.0]]), None);
    }
}
