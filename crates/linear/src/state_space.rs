use tracelight_maths::complex;

use crate::eigen::eigenvalues;
use crate::error::LinearError;
use crate::time::Time;
use crate::{Complex, DistinctRoot, Matrix, Root};

/// ẋ = A x + B u, y = C x + D u; of samples, the next x instead of ẋ.
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpace {
    a: Matrix,
    b: Matrix,
    c: Matrix,
    d: Matrix,
    time: Time,
}

impl StateSpace {
    /// A is n × n, B n × inputs, C outputs × n, D outputs × inputs, all of numbers.
    pub fn new(a: Matrix, b: Matrix, c: Matrix, d: Matrix, time: Time) -> Result<Self, LinearError> {
        if !a.is_square() {
            return Err(LinearError::Shape("A is not square"));
        }
        if b.nrows() != a.nrows() || c.ncols() != a.ncols() {
            return Err(LinearError::Shape("B has not as many rows, or C not as many columns, as A"));
        }
        if d.nrows() != c.nrows() || d.ncols() != b.ncols() {
            return Err(LinearError::Shape("D has not as many rows as C and as many columns as B"));
        }
        if ![&a, &b, &c, &d].into_iter().flatten().all(|entry| entry.is_finite()) {
            return Err(LinearError::NotFinite);
        }
        Ok(Self { a, b, c, d, time })
    }

    /// How the state goes on by itself.
    pub const fn a(&self) -> &Matrix {
        &self.a
    }

    /// How it takes its inputs.
    pub const fn b(&self) -> &Matrix {
        &self.b
    }

    /// How it is seen.
    pub const fn c(&self) -> &Matrix {
        &self.c
    }

    /// What goes straight through.
    pub const fn d(&self) -> &Matrix {
        &self.d
    }

    /// Its time.
    pub const fn time(&self) -> Time {
        self.time
    }

    /// Number of states.
    pub fn order(&self) -> usize {
        self.a.nrows()
    }

    /// Eigenvalues of A.
    pub fn poles(&self) -> Result<Vec<Complex>, LinearError> {
        eigenvalues(&self.a)
    }

    /// Eigenvalues of A as they can be told apart, the smallest first: what rounding alone moves off an axis is on it.
    ///
    /// # Errors
    /// As [`eigenvalues`].
    pub fn distinct_poles(&self) -> Result<Vec<DistinctRoot>, LinearError> {
        let mut poles = self.poles()?;
        poles.sort_by(|a, b| complex::norm(*a).total_cmp(&complex::norm(*b)));
        let rounding = 4.0 * self.order() as f64 * f64::EPSILON;
        let largest = poles.last().map_or(0.0, |pole| complex::norm(*pole));
        let root = |&value: &Complex| DistinctRoot::from(Root { value, radius: rounding * largest });
        Ok(poles.iter().map(root).collect())
    }

    /// One input to one output, the others left alone.
    pub fn channel(&self, output: usize, input: usize) -> Result<Self, LinearError> {
        if output >= self.c.nrows() || input >= self.b.ncols() {
            return Err(LinearError::Shape("there is no such input or output"));
        }
        Ok(Self {
            a: self.a.clone(),
            b: self.b.columns(input, 1).into_owned(),
            c: self.c.rows(output, 1).into_owned(),
            d: Matrix::from_element(1, 1, self.d[(output, input)]),
            time: self.time,
        })
    }

    /// Of one input and one output: the gain before the zeros, and these.
    ///
    /// An output that stays zero keeps the state it sees zero, and what would move that has to be zero, too: what then is left is a
    /// smaller system with the same zeros, until the input goes straight through (Emami-Naeini & Van Dooren, *Computation of
    /// zeros of linear multivariable systems*, Automatica 18, 1982).
    pub(crate) fn gain_and_zeros(&self) -> Result<(f64, Vec<Complex>), LinearError> {
        /// What is smaller beside the rest of B is rounding.
        const NOTHING: f64 = 1e3 * f64::EPSILON;
        let (mut a, mut b, mut c, mut d) = (self.a.clone(), self.b.clone(), self.c.clone(), self.d[(0, 0)]);
        let mut gain = 1.0;
        while d == 0.0 {
            let (n, seen) = (a.nrows(), c.norm());
            if n == 0 || seen == 0.0 {
                return Ok((0.0, Vec::new()));
            }
            // turned so that only the last state is seen
            let turn = turn_to_last(&c);
            a = &turn * a * turn.transpose();
            b = &turn * b;
            gain *= seen;
            d = if b[(n - 1, 0)].abs() > NOTHING * b.norm() { b[(n - 1, 0)] } else { 0.0 };
            c = a.view((n - 1, 0), (1, n - 1)).into_owned();
            a = a.view((0, 0), (n - 1, n - 1)).into_owned();
            b = b.rows(0, n - 1).into_owned();
        }
        Ok((gain * d, eigenvalues(&(&a - &b * &c / d))?))
    }

    /// First this, then that.
    pub fn series(&self, next: &Self) -> Result<Self, LinearError> {
        let time = self.time.with(next.time)?;
        if next.b.ncols() != self.c.nrows() {
            return Err(LinearError::Shape("the second has not as many inputs as the first has outputs"));
        }
        let zero = Matrix::zeros(self.order(), next.order());
        let a = stack(&[&[&self.a, &zero], &[&(&next.b * &self.c), &next.a]]);
        let b = stack(&[&[&self.b], &[&(&next.b * &self.d)]]);
        let c = stack(&[&[&(&next.d * &self.c), &next.c]]);
        Self::new(a, b, c, &next.d * &self.d, time)
    }

    /// The sum of both.
    pub fn parallel(&self, other: &Self) -> Result<Self, LinearError> {
        let time = self.time.with(other.time)?;
        if self.d.shape() != other.d.shape() {
            return Err(LinearError::Shape("both need the same inputs and outputs"));
        }
        let (right, left) =
            (Matrix::zeros(self.order(), other.order()), Matrix::zeros(other.order(), self.order()));
        let a = stack(&[&[&self.a, &right], &[&left, &other.a]]);
        let b = stack(&[&[&self.b], &[&other.b]]);
        let c = stack(&[&[&self.c, &other.c]]);
        Self::new(a, b, c, &self.d + &other.d, time)
    }

    /// Closed by negative feedback through `back`.
    pub fn feedback(&self, back: &Self) -> Result<Self, LinearError> {
        let time = self.time.with(back.time)?;
        if back.b.ncols() != self.c.nrows() || back.c.nrows() != self.b.ncols() {
            return Err(LinearError::Shape(
                "the way back has not as many inputs as there are outputs, or the other way round",
            ));
        }
        // e = u − H y is solved for: (I + D₂ D₁) e = u − C₂ x₂ − D₂ C₁ x₁
        let whole = Matrix::identity(self.b.ncols(), self.b.ncols()) + &back.d * &self.d;
        let open = whole.try_inverse().ok_or(LinearError::AlgebraicLoop)?;
        let (from_first, from_second) = (-(&open * &back.d * &self.c), -(&open * &back.c));
        let y = [&self.c + &self.d * &from_first, &self.d * &from_second];
        let a = stack(&[
            &[&(&self.a + &self.b * &from_first), &(&self.b * &from_second)],
            &[&(&back.b * &y[0]), &(&back.a + &back.b * &y[1])],
        ]);
        let b = stack(&[&[&(&self.b * &open)], &[&(&back.b * &self.d * &open)]]);
        Self::new(a, b, stack(&[&[&y[0], &y[1]]]), &self.d * &open, time)
    }
}

/// An orthogonal matrix whose transpose turns that row onto the last axis, with a positive entry there: Householder's reflection.
fn turn_to_last(row: &Matrix) -> Matrix {
    let n = row.ncols();
    let mut v = row.transpose() / row.norm();
    let sign = if v[(n - 1, 0)] > 0.0 { 1.0 } else { -1.0 };
    v[(n - 1, 0)] += sign;
    let mirror = Matrix::identity(n, n) - &v * v.transpose() * (2.0 / v.norm_squared());
    // it turns the row onto −sign times the last axis
    let mut turn = mirror;
    turn.row_mut(n - 1).iter_mut().for_each(|entry| *entry *= -sign);
    turn
}

/// Matrices side by side, rows of them below each other.
pub(crate) fn stack(rows: &[&[&Matrix]]) -> Matrix {
    let height = rows.iter().map(|row| row[0].nrows()).sum();
    let width = rows[0].iter().map(|part| part.ncols()).sum();
    let mut all = Matrix::zeros(height, width);
    let mut top = 0;
    for row in rows {
        let mut left = 0;
        for part in *row {
            all.view_mut((top, left), part.shape()).copy_from(part);
            left += part.ncols();
        }
        top += row[0].nrows();
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polynomial::Polynomial;
    use crate::transfer::TransferFunction;

    fn tf(numerator: &[f64], denominator: &[f64]) -> TransferFunction {
        TransferFunction::new(Polynomial::new(numerator), Polynomial::new(denominator), Time::Continuous)
            .unwrap()
    }

    fn same(one: &TransferFunction, other: &TransferFunction) {
        for at in [Complex::new(0.3, 0.0), Complex::new(0.0, 2.0), Complex::new(-1.1, 5.0)] {
            let (a, b) = (one.at(at), other.at(at));
            assert!(complex::norm(a - b) < 1e-11 * (1.0 + complex::norm(a)), "{one} is not {other}");
        }
    }

    fn back(system: &StateSpace) -> TransferFunction {
        system.transfer(0, 0).unwrap().transfer()
    }

    #[test]
    fn to_state_space_and_back_is_the_same() {
        for g in [
            tf(&[13.16, 1.754, 10.29], &[1.0, 0.2649, 0.7997, 0.1029, 0.0]),
            tf(&[1.0, 2.0, 3.0], &[2.0, 5.0, 7.0]),
            tf(&[-4.0], &[1.0, 0.0, 0.0]),
            tf(&[5.0], &[1.0]),
            tf(&[1e3, 1.0], &[1e-3, 1.0, 1e6, 7.0]),
        ] {
            same(&back(&g.state_space().unwrap()), &g);
        }
        let improper = tf(&[1.0, 0.0], &[1.0]).state_space();
        assert_eq!(improper, Err(LinearError::Improper { zeros: 1, poles: 0, what: "state space" }));
    }

    #[test]
    fn connections_are_those_of_transfer_functions() {
        let (g, h) = (tf(&[2.0, 1.0], &[1.0, 3.0, 4.0]), tf(&[1.0, 1.0], &[1.0, 9.0]));
        let (gs, hs) = (g.state_space().unwrap(), h.state_space().unwrap());
        same(&back(&gs.series(&hs).unwrap()), &g.series(&h).unwrap());
        same(&back(&gs.parallel(&hs).unwrap()), &g.parallel(&h).unwrap());
        same(&back(&gs.feedback(&hs).unwrap()), &g.feedback(&h).unwrap());
        same(&back(&hs.feedback(&gs).unwrap()), &h.feedback(&g).unwrap());
    }

    #[test]
    fn what_no_output_sees_has_no_transfer_function_but_its_poles() {
        let a = Matrix::from_row_slice(2, 2, &[-1.0, 0.0, 0.0, -2.0]);
        let b = Matrix::from_column_slice(2, 1, &[1.0, 0.0]);
        let c = Matrix::from_row_slice(1, 2, &[0.0, 1.0]);
        let system = StateSpace::new(a, b, c, Matrix::zeros(1, 1), Time::Continuous).unwrap();
        let zpk = system.transfer(0, 0).unwrap();
        assert_eq!((zpk.gain(), zpk.zeros().len(), zpk.poles().len()), (0.0, 0, 2));
        assert!(system.transfer(1, 0).is_err());
    }

    #[test]
    fn matrices_that_do_not_fit_are_refused() {
        let (one, two) = (Matrix::identity(1, 1), Matrix::identity(2, 2));
        let new = |a: &Matrix, b: &Matrix, c: &Matrix, d: &Matrix| {
            StateSpace::new(a.clone(), b.clone(), c.clone(), d.clone(), Time::Continuous)
        };
        assert!(new(&two, &two, &two, &two).is_ok());
        assert!(new(&two, &one, &two, &two).is_err() && new(&two, &two, &two, &one).is_err());
        assert!(new(&Matrix::zeros(2, 1), &two, &two, &two).is_err());
    }
}
