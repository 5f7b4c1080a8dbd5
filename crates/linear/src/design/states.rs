use crate::{LinearError, Matrix, StateSpace, TransferFunction};

impl TransferFunction {
    /// This system with states that have a meaning: each is the derivative of the one before, of samples the next value of it. Of a system
    /// without zeros the first is the output itself; else the output is b(s)/b₀ times the first, b being the numerator and b₀ its
    /// constant (its leading coefficient where that is 0).
    ///
    /// # Errors
    /// [`LinearError::Improper`] with more zeros than poles; [`LinearError::Shape`] without poles.
    pub fn phase_variables(&self) -> Result<StateSpace, LinearError> {
        let (above, below) = (self.numerator(), self.denominator());
        let n = below.degree();
        if self.relative_degree() < 0 {
            return Err(LinearError::Improper { zeros: above.degree(), poles: n, what: "states" });
        }
        if n == 0 {
            return Err(LinearError::Shape("it has no states: there is nothing to weigh"));
        }
        let scale = if above.constant() == 0.0 { above.leading() } else { above.constant() };
        let through = above.coefficient(n);
        let scale = if scale == 0.0 { 1.0 } else { scale };
        let a = Matrix::from_fn(n, n, |row, column| match row + 1 == n {
            true => -below.coefficient(column),
            false => f64::from(u8::from(column == row + 1)),
        });
        let b = Matrix::from_fn(n, 1, |row, _| if row + 1 == n { scale } else { 0.0 });
        let c = Matrix::from_fn(1, n, |_, column| {
            (above.coefficient(column) - through * below.coefficient(column)) / scale
        });
        StateSpace::new(a, b, c, Matrix::from_element(1, 1, through), self.time())
    }
}

#[cfg(test)]
mod tests {
    use tracelight_maths::complex;

    use super::*;
    use crate::{Complex, Time};

    #[test]
    fn states_in_a_chain_are_the_same_system() {
        for text in ["13.16/(s(s+0.1316))", "(2s+3)/(s^3+4s+1)", "(s^2+1)/(s^2+3s+7)", "5s/(s^2+s+9)"] {
            let system = TransferFunction::parse(text, Time::Continuous).unwrap();
            let there = system.phase_variables().unwrap().transfer(0, 0).unwrap().transfer();
            let at = Complex::new(0.2, 1.7);
            assert!(complex::norm(there.at(at) - system.at(at)) < 1e-12, "{text}: {there}");
        }
        let constant = TransferFunction::parse("3", Time::Continuous).unwrap();
        assert!(constant.phase_variables().is_err());
    }

    /// Without zeros the states are the output and its derivatives.
    #[test]
    fn the_first_state_is_the_output() {
        let system = TransferFunction::parse("6/((s+1)(s+2)(s+3))", Time::Continuous).unwrap();
        let states = system.phase_variables().unwrap();
        assert_eq!(states.c(), &Matrix::from_row_slice(1, 3, &[1.0, 0.0, 0.0]));
        assert_eq!(states.b(), &Matrix::from_row_slice(3, 1, &[0.0, 0.0, 6.0]));
    }
}
