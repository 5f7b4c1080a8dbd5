//! Symmetric linear systems with a skyline (mostly banded) matrix.

/// The lower half of a symmetric matrix, each row from its first entry that is not zero to the diagonal.
#[derive(Default)]
pub(super) struct Skyline {
    rows: Vec<Row>,
}

struct Row {
    first: usize,
    /// Columns `first..=` the row's own.
    entries: Vec<f64>,
}

/// A pivot below this is none; equations are of order one, however many points they stand for.
const LEAST_PIVOT: f64 = 1e-12;

impl Skyline {
    /// Appends a row of zeros that starts at column `first`.
    pub(super) fn push(&mut self, first: usize) {
        let own = self.rows.len();
        self.rows.push(Row { first: first.min(own), entries: vec![0.0; own + 1 - first.min(own)] });
    }

    /// Adds to the entry of `row` and `column`, which must be neither right of the diagonal nor left of the row's first.
    pub(super) fn add(&mut self, row: usize, column: usize, value: f64) {
        let row = &mut self.rows[row];
        row.entries[column - row.first] += value;
    }

    /// What times this matrix is `right`; without a solution, the row where that shows. The matrix is taken apart as
    /// L D Lᵀ without exchange of rows, which needs every constraint after unknowns that it leaves free (Vanderbei, "Symmetric
    /// quasidefinite matrices", 1995).
    pub(super) fn solve(mut self, mut right: Vec<f64>) -> Result<Vec<f64>, usize> {
        for i in 0..self.rows.len() {
            self.eliminate(i).ok_or(i)?;
        }
        for (i, row) in self.rows.iter().enumerate() {
            let before = &right[row.first..i];
            right[i] -= before.iter().zip(&row.entries).map(|(x, l)| x * l).sum::<f64>();
        }
        for (x, row) in right.iter_mut().zip(&self.rows) {
            *x /= row.pivot();
        }
        for (i, row) in self.rows.iter().enumerate().rev() {
            let x = right[i];
            right[row.first..i].iter_mut().zip(&row.entries).for_each(|(y, l)| *y -= l * x);
        }
        right.iter().position(|x| !x.is_finite()).map_or(Ok(right), Err)
    }

    fn eliminate(&mut self, i: usize) -> Option<()> {
        let (done, rest) = self.rows.split_at_mut(i);
        let Row { first, entries } = rest.first_mut()?;
        let first = *first;
        for j in first..i {
            let other = &done[j];
            let low = first.max(other.first);
            let (a, b) = (&entries[low - first..j - first], &other.entries[low - other.first..]);
            let dot: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
            entries[j - first] -= dot;
        }
        let mut pivot = entries[i - first];
        for j in first..i {
            let share = entries[j - first] / done[j].pivot();
            pivot -= share * entries[j - first];
            entries[j - first] = share;
        }
        entries[i - first] = pivot;
        (pivot.abs() > LEAST_PIVOT).then_some(())
    }
}

impl Row {
    fn pivot(&self) -> f64 {
        self.entries[self.entries.len() - 1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_of_springs_with_a_constraint_is_solved() {
        // unknowns 0..5 in a ring, x4 + x0 = 3 as a constraint (row 5)
        let entries =
            [(0, 0, 4.0), (1, 0, 1.0), (1, 1, 5.0), (2, 1, -2.0), (2, 2, 6.0), (3, 2, 1.0), (3, 3, 4.0)];
        let more = [(4, 3, 0.5), (4, 4, 3.0), (5, 0, 1.0), (5, 4, 1.0)];
        let mut matrix = Skyline::default();
        [0, 0, 1, 2, 3, 0].iter().for_each(|&first| matrix.push(first));
        let all = || entries.iter().chain(&more);
        all().for_each(|&(i, j, value)| matrix.add(i, j, value));
        let right = vec![1.0, -2.0, 0.5, 4.0, 1.0, 3.0];
        let x = matrix.solve(right.clone()).unwrap();
        for (i, want) in right.iter().enumerate() {
            let of = |&(row, column, value): &(usize, usize, f64)| match (row == i, column == i) {
                (true, _) => value * x[column],
                (false, true) => value * x[row],
                _ => 0.0,
            };
            assert!((all().map(of).sum::<f64>() - want).abs() < 1e-12, "equation {i}");
        }
    }

    #[test]
    fn contradicting_equations_have_no_solution() {
        let mut matrix = Skyline::default();
        [0, 0, 0].iter().for_each(|&first| matrix.push(first));
        [(0, 0, 1.0), (1, 0, 1.0), (2, 0, 1.0)].iter().for_each(|&(i, j, value)| matrix.add(i, j, value));
        assert!(matrix.solve(vec![0.0, 1.0, 2.0]).is_err());
    }
}
