use crate::regression::{Uncertain, student};

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

    /// The line of least squares through (speed, torque); `None` of fewer than three points, or of one speed. Draper & Smith, *Applied
    /// Regression Analysis*, 3rd ed., §1.4.
    pub fn through(points: &[(f64, f64)]) -> Option<Self> {
        let count = points.len() as f64;
        if points.len() < 3 {
            return None;
        }
        let mean = |of: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
        let (rate, torque) = (mean(&|p| p.0), mean(&|p| p.1));
        let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
            points.iter().map(|p| of(p.0 - rate, p.1 - torque)).sum()
        };
        let (spread, along, total) = (sum(&|w, _| w * w), sum(&|w, t| w * t), sum(&|_, t| t * t));
        if spread <= 1e-18 * count * (1.0 + rate * rate) {
            return None;
        }
        let slope = along / spread;
        let left = sum(&|w, t| (t - slope * w).powi(2));
        let variance = left / (count - 2.0);
        let t = student(count - 2.0);
        Some(Self {
            viscous: Uncertain { value: slope, within: t * (variance / spread).sqrt() },
            coulomb_nm: Uncertain {
                value: torque - slope * rate,
                within: t * (variance * (1.0 / count + rate * rate / spread)).sqrt(),
            },
            r2: if total > 0.0 { 1.0 - left / total } else { 1.0 },
            points: points.len(),
        })
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
