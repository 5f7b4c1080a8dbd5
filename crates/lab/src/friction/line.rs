use crate::regression::{Uncertain, regression};

/// Friction in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// N m s/rad.
    pub viscous: Uncertain,
    /// N m, negative backwards.
    pub coulomb_nm: Uncertain,
}

/// A straight line through points: `coulomb_nm` + `viscous` ω.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Slope, N m s/rad.
    pub viscous: Uncertain,
    /// Intercept, N m.
    pub coulomb_nm: Uncertain,
    /// Share of the torques' variance that it explains.
    pub r2: f64,
    /// Points it was laid through.
    pub points: usize,
}

impl Line {
    /// The friction it says.
    pub const fn side(&self) -> Side {
        Side { viscous: self.viscous, coulomb_nm: self.coulomb_nm }
    }

    /// The line of least squares through (speed, torque); `None` of fewer than three points, or of one speed.
    pub fn through(points: &[(f64, f64)]) -> Option<Self> {
        let (rates, torques): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
        let found = regression(&[vec![1.0; points.len()], rates], &torques)?;
        let &[coulomb_nm, viscous] = found.factors.as_slice() else { return None };
        Some(Self { viscous, coulomb_nm, r2: found.r2, points: points.len() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Draper & Smith's steam data would do as well; these five are worked by hand: slope 0.6, intercept 2.2, s² 0.8.
    #[test]
    fn a_line_has_the_textbooks_intervals() {
        let line = Line::through(&[(1.0, 2.0), (2.0, 4.0), (3.0, 5.0), (4.0, 4.0), (5.0, 5.0)]).unwrap();
        assert!((line.viscous.value - 0.6).abs() < 1e-12 && (line.coulomb_nm.value - 2.2).abs() < 1e-12);
        assert!((line.r2 - 0.6).abs() < 1e-12);
        // t of 3 degrees: 3.182446; √(0.8/10) and √(0.8 (1/5 + 9/10))
        assert!((line.viscous.within - 3.182_446 * 0.08_f64.sqrt()).abs() < 1e-5, "{line:?}");
        assert!((line.coulomb_nm.within - 3.182_446 * 0.88_f64.sqrt()).abs() < 1e-5, "{line:?}");
    }

    #[test]
    fn one_speed_has_no_line() {
        assert_eq!(Line::through(&[(1.0, 2.0), (1.0, 4.0), (1.0, 5.0)]), None);
        assert_eq!(Line::through(&[(1.0, 2.0), (2.0, 4.0)]), None);
    }
}
