use crate::mimo::compressed::balanced_states;
use crate::mimo::minimal::moved;
use crate::{Complex, LinearError, Matrix, StateSpace};

/// What of a state does not show, from its inputs or to its outputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Hidden {
    /// The poles that belong to it: as many as there are states too many.
    pub poles: Vec<Complex>,
    /// The states that it is made of, from 0 on: more than there are poles where it is a combination of them.
    pub states: Vec<usize>,
}

impl Hidden {
    fn of(poles: Vec<Complex>, directions: &Matrix) -> Self {
        /// A share of a direction that is rounding.
        const NOTHING: f64 = 1e-8;
        let states = (0..directions.ncols()).filter(|&i| directions.column(i).norm() > NOTHING).collect();
        Self { poles, states }
    }
}

impl StateSpace {
    /// What no input moves: combinations of states, found by the staircase of [`minimal`](Self::minimal).
    ///
    /// # Errors
    /// As [`eigenvalues`](crate::eigenvalues).
    pub fn unmoved(&self) -> Result<Hidden, LinearError> {
        let (a, b, c) = balanced_states(self);
        let moved = moved(a, b, c)?;
        Ok(Hidden::of(moved.rest, &moved.directions))
    }

    /// What no output shows: directions of the state, found by the staircase of [`minimal`](Self::minimal).
    ///
    /// # Errors
    /// As [`eigenvalues`](crate::eigenvalues).
    pub fn unseen(&self) -> Result<Hidden, LinearError> {
        let (a, b, c) = balanced_states(self);
        let shown = moved(a.transpose(), c.transpose(), b.transpose())?;
        Ok(Hidden::of(shown.rest, &shown.directions))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Time;

    fn system(a: &[f64], b: &[f64], c: &[f64]) -> StateSpace {
        let n = b.len();
        let (a, b, c) = (
            Matrix::from_row_slice(n, n, a),
            Matrix::from_row_slice(n, 1, b),
            Matrix::from_row_slice(1, n, c),
        );
        StateSpace::new(a, b, c, Matrix::zeros(1, 1), Time::Continuous).unwrap()
    }

    #[test]
    fn hidden_states_are_named_by_their_number() {
        let apart =
            system(&[-1.0, 0.0, 0.0, 0.0, -2.0, 0.0, 0.0, 0.0, -3.0], &[1.0, 0.0, 4.0], &[1.0, 1.0, 0.0]);
        let (unmoved, unseen) = (apart.unmoved().unwrap(), apart.unseen().unwrap());
        for (hidden, state, pole) in [(unmoved, 1, -2.0), (unseen, 2, -3.0)] {
            assert_eq!((&hidden.states[..], hidden.poles.len()), (&[state][..], 1));
            assert!((hidden.poles[0] - Complex::from(pole)).norm_sqr() < 1e-24, "{hidden:?}");
        }
        // two equal ones beside each other are moved together: their difference is not
        let twins = system(&[-1.0, 0.0, 0.0, -1.0], &[1.0, 1.0], &[1.0, 0.5]);
        let unmoved = twins.unmoved().unwrap();
        assert_eq!((unmoved.states, unmoved.poles.len()), (vec![0, 1], 1));
    }

    #[test]
    fn what_is_minimal_hides_nothing() {
        let chain = system(&[0.0, 1.0, -2.0, -3.0], &[0.0, 1.0], &[1.0, 0.0]);
        for hidden in [chain.unmoved().unwrap(), chain.unseen().unwrap()] {
            assert_eq!(hidden, Hidden { poles: Vec::new(), states: Vec::new() });
        }
    }
}
