/// A symmetric system of equations whose matrix has three bands beside its diagonal.
pub(super) struct Band {
    /// Of each row the diagonal and what is right of it.
    rows: Vec<[f64; 4]>,
    right: Vec<f64>,
}

/// What a cell adds: to the matrix, and to the right-hand side.
pub(super) type Local = ([[f64; 4]; 4], [f64; 4]);

impl Band {
    pub(super) fn new(size: usize) -> Self {
        Self { rows: vec![[0.0; 4]; size], right: vec![0.0; size] }
    }

    /// Adds four by four from row `first` on.
    pub(super) fn add(&mut self, first: usize, (matrix, right): &Local) {
        for a in 0..4 {
            for (entry, value) in self.rows[first + a].iter_mut().zip(&matrix[a][a..]) {
                *entry += value;
            }
            self.right[first + a] += right[a];
        }
    }

    /// The solution, by LDLᵀ.
    pub(super) fn solve(mut self) -> Vec<f64> {
        let size = self.rows.len();
        for i in 0..size {
            // a whisper on the diagonal keeps what hardly matters from being divided by nothing
            let diagonal = (self.rows[i][0] * (1.0 + 1e-13)).max(f64::MIN_POSITIVE);
            self.rows[i][0] = diagonal;
            let row = self.rows[i];
            for a in 1..4.min(size - i) {
                let factor = row[a] / diagonal;
                for (entry, value) in self.rows[i + a].iter_mut().zip(&row[a..]) {
                    *entry -= factor * value;
                }
                self.right[i + a] -= factor * self.right[i];
            }
        }
        for i in (0..size).rev() {
            let known: f64 = (1..4.min(size - i)).map(|a| self.rows[i][a] * self.right[i + a]).sum();
            self.right[i] = (self.right[i] - known) / self.rows[i][0];
        }
        self.right
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_solution_solves() {
        let mut dice = oorandom::Rand64::new(5);
        let mut draw = || dice.rand_float() - 0.5;
        let cells: Vec<Local> = (0..20)
            .map(|_| {
                let root: [[f64; 4]; 4] = core::array::from_fn(|_| core::array::from_fn(|_| draw()));
                let entry = |a: usize, b: usize| {
                    (0..4).map(|k| root[k][a] * root[k][b]).sum::<f64>() + if a == b { 0.1 } else { 0.0 }
                };
                (
                    core::array::from_fn(|a| core::array::from_fn(|b| entry(a, b))),
                    core::array::from_fn(|_| draw()),
                )
            })
            .collect();
        let mut system = Band::new(42);
        cells.iter().enumerate().for_each(|(i, cell)| system.add(2 * i, cell));
        let right = system.right.clone();
        let solution = system.solve();
        let mut product = vec![0.0; 42];
        for (i, (matrix, _)) in cells.iter().enumerate() {
            for (a, row) in matrix.iter().enumerate() {
                for (b, entry) in row.iter().enumerate() {
                    product[2 * i + a] += entry * solution[2 * i + b];
                }
            }
        }
        assert!(product.iter().zip(&right).all(|(a, b)| (a - b).abs() < 1e-10));
    }
}
