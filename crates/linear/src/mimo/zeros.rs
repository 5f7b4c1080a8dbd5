use crate::eigen::eigenvalues;
use crate::mimo::compressed::{balanced_states, compressed};
use crate::{Complex, LinearError, Matrix, StateSpace};

/// What is smaller beside the whole system is rounding.
const NOTHING: f64 = 1e-12;

impl StateSpace {
    /// Transmission zeros and what no input moves or no output sees, the invariant zeros: where the rank of [A − s, B; C, D] falls.
    ///
    /// Outputs that stay zero keep states zero; what is left is a smaller system with the same zeros, until all inputs go straight
    /// through. The same is done with inputs and outputs exchanged (Emami-Naeini & Van Dooren, *Computation of zeros of linear
    /// multivariable systems*, Automatica 18, 1982).
    ///
    /// # Errors
    /// As [`eigenvalues`].
    pub fn zeros(&self) -> Result<Vec<Complex>, LinearError> {
        let (a, b, c) = balanced_states(self);
        let rows = Reduced { a, b, c, d: self.d().clone() }.reduced();
        let both = rows.transposed().reduced();
        if both.a.nrows() == 0 {
            return Ok(Vec::new());
        }
        if both.d.is_empty() {
            return eigenvalues(&both.a);
        }
        let inverse = both.d.try_inverse().ok_or(LinearError::NotConverged)?;
        eigenvalues(&(both.a - both.b * inverse * both.c))
    }
}

struct Reduced {
    a: Matrix,
    b: Matrix,
    c: Matrix,
    d: Matrix,
}

impl Reduced {
    fn transposed(&self) -> Self {
        Self { a: self.a.transpose(), b: self.c.transpose(), c: self.b.transpose(), d: self.d.transpose() }
    }

    /// With the same zeros, and D of full row rank.
    fn reduced(mut self) -> Self {
        let size = [&self.a, &self.b, &self.c, &self.d].map(Matrix::norm).into_iter().fold(0.0, f64::max);
        let least = NOTHING * size;
        // each step takes a state away
        loop {
            let (turn, rank) = compressed(&self.d, least);
            let (c, d) = (&turn * &self.c, &turn * &self.d);
            let unseen = c.rows(rank, c.nrows() - rank).into_owned();
            let (c, d) = (c.rows(0, rank).into_owned(), d.rows(0, rank).into_owned());
            if unseen.nrows() == 0 {
                return Self { c, d, ..self };
            }
            // the first states are those that have to stay zero
            let (turn, count) = compressed(&unseen.transpose(), least);
            if count == 0 {
                return Self { c, d, ..self };
            }
            let a = &turn * &self.a * turn.transpose();
            let (b, c) = (&turn * &self.b, c * turn.transpose());
            let left = a.nrows() - count;
            self = Self {
                a: a.view((count, count), (left, left)).into_owned(),
                b: b.rows(count, left).into_owned(),
                c: below(
                    &c.columns(count, left).into_owned(),
                    &a.view((0, count), (count, left)).into_owned(),
                ),
                d: below(&d, &b.rows(0, count).into_owned()),
            };
        }
    }
}

fn below(above: &Matrix, below: &Matrix) -> Matrix {
    let mut all = Matrix::zeros(above.nrows() + below.nrows(), above.ncols());
    all.rows_mut(0, above.nrows()).copy_from(above);
    all.rows_mut(above.nrows(), below.nrows()).copy_from(below);
    all
}
