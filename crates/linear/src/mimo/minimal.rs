use crate::eigen::eigenvalues;
use crate::mimo::compressed::{balanced_states, compressed};
use crate::{Complex, LinearError, Matrix, StateSpace};

/// What is smaller beside A, or beside B or C, is rounding.
const NOTHING: f64 = 1e-11;

/// A system without what does not show from its inputs to its outputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Minimal {
    /// The part that is controllable and observable.
    pub system: StateSpace,
    /// Poles that no input moves.
    pub uncontrollable: Vec<Complex>,
    /// Poles of the rest that no output sees.
    pub unobservable: Vec<Complex>,
}

impl StateSpace {
    /// The minimal realization: Kalman's decomposition by orthogonal staircases of balanced states (Rosenbrock 1970; Varga, *Numerically
    /// stable algorithm for standard controllability form determination*, Electron. Lett. 17, 1981).
    ///
    /// # Errors
    /// As [`eigenvalues`].
    pub fn minimal(&self) -> Result<Minimal, LinearError> {
        let (a, b, c) = balanced_states(self);
        let reached = moved(a, b, c)?;
        let shown = moved(reached.a.transpose(), reached.c.transpose(), reached.b.transpose())?;
        let (a, b, c) = (shown.a.transpose(), shown.c.transpose(), shown.b.transpose());
        let system = Self::new(a, b, c, self.d().clone(), self.time())?;
        Ok(Minimal { system, uncontrollable: reached.rest, unobservable: shown.rest })
    }
}

/// The part of a system that its inputs move.
pub(super) struct Moved {
    a: Matrix,
    b: Matrix,
    c: Matrix,
    /// Poles of the rest.
    pub(super) rest: Vec<Complex>,
    /// Directions of the rest, a row each, at right angles.
    pub(super) directions: Matrix,
}

/// Parts what inputs move from what they do not.
pub(super) fn moved(mut a: Matrix, mut b: Matrix, mut c: Matrix) -> Result<Moved, LinearError> {
    let n = a.nrows();
    let mut all = Matrix::identity(n, n);
    let (size_a, size_b) = (a.norm(), b.norm());
    let mut block = b.clone();
    let (mut start, mut least) = (0, NOTHING * size_b);
    // each step takes at least one state
    while start < n {
        let (turn, rank) = compressed(&block, least);
        if rank == 0 {
            break;
        }
        let mut whole = Matrix::identity(n, n);
        whole.view_mut((start, start), turn.shape()).copy_from(&turn);
        a = &whole * a * whole.transpose();
        b = &whole * b;
        c *= whole.transpose();
        all = whole * all;
        let next = start + rank;
        block = a.view((next, start), (n - next, rank)).into_owned();
        (start, least) = (next, NOTHING * size_a);
    }
    let rest = eigenvalues(&a.view((start, start), (n - start, n - start)).into_owned())?;
    Ok(Moved {
        a: a.view((0, 0), (start, start)).into_owned(),
        b: b.rows(0, start).into_owned(),
        c: c.columns(0, start).into_owned(),
        rest,
        directions: all.rows(start, n - start).into_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Time, TransferFunction};

    #[test]
    fn what_is_cancelled_is_left_out_and_told() {
        let g = |text: &str| TransferFunction::parse(text, Time::Continuous).unwrap().state_space().unwrap();
        let (one, two) = (g("(s+2)/(s+1)"), g("3/((s+2)(s+5))"));
        for (chain, which) in [(one.series(&two).unwrap(), 0), (two.series(&one).unwrap(), 1)] {
            let minimal = chain.minimal().unwrap();
            assert_eq!(minimal.system.order(), 2);
            let told = [&minimal.uncontrollable, &minimal.unobservable];
            assert_eq!(told.map(Vec::len).iter().sum::<usize>(), 1, "{which}: {told:?}");
            assert!((told[0].first().or(told[1].first()).unwrap().re + 2.0).abs() < 1e-12);
            let at = Complex::new(0.3, 1.0);
            assert!((chain.at(at).unwrap() - minimal.system.at(at).unwrap()).norm() < 1e-13);
        }
    }
}
