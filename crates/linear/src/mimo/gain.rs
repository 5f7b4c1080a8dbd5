use crate::{Complex, LinearError, Matrix, StateSpace};

/// A complex matrix of any size.
pub type ComplexMatrix = nalgebra::DMatrix<Complex>;

impl StateSpace {
    /// The transfer matrix at a place, outputs × inputs.
    ///
    /// # Errors
    /// [`LinearError::NotFinite`] at a pole.
    pub fn at(&self, place: Complex) -> Result<ComplexMatrix, LinearError> {
        let complex = |m: &Matrix| m.map(Complex::from);
        let resolvent =
            ComplexMatrix::from_diagonal_element(self.order(), self.order(), place) - complex(self.a());
        let states = resolvent.lu().solve(&complex(self.b())).ok_or(LinearError::NotFinite)?;
        let value = complex(self.c()) * states + complex(self.d());
        if value.iter().all(|entry| entry.is_finite()) { Ok(value) } else { Err(LinearError::NotFinite) }
    }
}
