use tracelight_maths::{complex, powi};

use crate::polynomial::are_paired;
use crate::{Complex, LinearError, Matrix, Polynomial, StateSpace, eigenvalues};

impl StateSpace {
    /// A state feedback u = −K x that puts the poles there, inputs × states; as many poles as states, conjugates in pairs.
    ///
    /// K X = G where A X − X F = B G and F has those poles (Bhattacharyya & de Souza, *Pole assignment via Sylvester's equation*,
    /// Systems & Control Letters 1, 1982). With more than one input G is free: of some the one is taken whose X is inverted best. Some
    /// feedback before takes the system's own poles out of the way.
    pub fn place(&self, poles: &[Complex]) -> Result<Matrix, LinearError> {
        let n = self.order();
        if poles.len() != n {
            return Err(LinearError::Wish(format!("{} poles for {n} states: give as many", poles.len())));
        }
        if let Some(alone) = poles.iter().find(|_| !are_paired(poles)) {
            return Err(LinearError::Unpaired(alone.to_string()));
        }
        if n == 0 {
            return Ok(Matrix::zeros(self.b().ncols(), 0));
        }
        if n > MOST_STATES {
            return Err(LinearError::Wish(format!("{n} states: poles of {MOST_STATES} at most are placed")));
        }
        let wanted = blocks(poles);
        let mut best: Option<(f64, Matrix)> = None;
        // with one input there is but one feedback
        for attempt in 0..if self.b().ncols() == 1 { 1 } else { ATTEMPTS } {
            let Some((condition, gain)) = self.placed(&wanted, attempt) else { continue };
            if best.as_ref().is_none_or(|(least, _)| condition < *least) {
                best = Some((condition, gain));
            }
        }
        let (condition, gain) = best.ok_or_else(|| {
            LinearError::Wish(
                "the poles cannot be put there: the input does not move all states, or they are too far apart for the digits there are".into(),
            )
        })?;
        self.check_placed(poles, &gain, condition)?;
        Ok(gain)
    }

    /// X's condition and K for one G.
    fn placed(&self, wanted: &Matrix, attempt: usize) -> Option<(f64, Matrix)> {
        let (n, inputs) = self.b().shape();
        let size = |m: &Matrix| m.norm().max(f64::MIN_POSITIVE);
        // some feedback before, so that A and F have no pole in common
        let unit = size(wanted).max(size(self.a())) / size(self.b());
        let before = Matrix::from_fn(inputs, n, |i, j| 0.3 * unit * spread(attempt, 1 + i * n + j));
        let a = self.a() - self.b() * &before;
        let g = Matrix::from_fn(inputs, n, |i, j| 1.0 + 0.5 * spread(attempt, 1000 + i * n + j));
        // A X − X F = B G, column by column of X
        let one = Matrix::identity(n, n);
        let whole = one.kronecker(&a) - wanted.transpose().kronecker(&one);
        let right = Matrix::from_column_slice(n * n, 1, (self.b() * &g).as_slice());
        let mut x = Matrix::from_column_slice(n, n, whole.lu().solve(&right)?.as_slice());
        // columns of X and G in another unit leave K as it is
        let mut g = g;
        for j in 0..n {
            let scale = x.column(j).norm();
            x.column_mut(j).iter_mut().for_each(|entry| *entry /= scale);
            g.column_mut(j).iter_mut().for_each(|entry| *entry /= scale);
        }
        if !x.iter().chain(g.iter()).all(|entry| entry.is_finite()) {
            return None;
        }
        let values = x.clone().svd(false, false).singular_values;
        let condition = values.max() / values.min();
        let gain = x.transpose().lu().solve(&g.transpose())?.transpose() + before;
        (condition.is_finite() && gain.iter().all(|entry| entry.is_finite())).then_some((condition, gain))
    }

    /// Whether the poles are where they should be: as polynomials, since repeated ones scatter.
    fn check_placed(&self, poles: &[Complex], gain: &Matrix, condition: f64) -> Result<(), LinearError> {
        let there = eigenvalues(&(self.a() - self.b() * gain))?;
        let (wanted, there) = (Polynomial::from_roots(1.0, poles), Polynomial::from_roots(1.0, &there));
        let size = poles.iter().map(|z| complex::norm(*z)).fold(f64::MIN_POSITIVE, f64::max);
        let n = poles.len();
        let off = (0..n)
            .map(|k| (wanted.coefficient(k) - there.coefficient(k)).abs() / powi(size, (n - k) as i32))
            .fold(0.0, f64::max);
        // (1 + z)ⁿ at most, all poles being of one size
        if off <= 1e-6 * powi(2.0, n as i32) {
            return Ok(());
        }
        Err(LinearError::Wish(format!(
            "the input hardly moves some of the states (condition {condition:.1e}): the poles cannot be put there with so many digits"
        )))
    }
}

/// States beyond which n² equations are too many.
const MOST_STATES: usize = 24;

/// Ways that are tried with more inputs than one.
const ATTEMPTS: usize = 8;

/// Evenly spread in −1 … 1, without a generator: multiples of the golden section.
fn spread(attempt: usize, place: usize) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    2.0 * ((attempt * 7919 + place) as f64 * GOLDEN).fract() - 1.0
}

/// A real matrix with these eigenvalues: each real one and each pair in its block, blocks joined so that equal ones are one chain.
fn blocks(poles: &[Complex]) -> Matrix {
    let n = poles.len();
    let mut f = Matrix::zeros(n, n);
    let mut sorted: Vec<Complex> = poles.iter().copied().filter(|z| z.im >= 0.0).collect();
    sorted.sort_by(|a, b| (a.im, a.re).partial_cmp(&(b.im, b.re)).unwrap_or(std::cmp::Ordering::Equal));
    let size = poles.iter().map(|z| complex::norm(*z)).fold(f64::MIN_POSITIVE, f64::max);
    let (mut at, mut before): (usize, Option<Complex>) = (0, None);
    // a real one and a pair are no chain, however near
    let alike = |a: Complex, b: Complex| (a.im == 0.0) == (b.im == 0.0) && complex::norm(a - b) < 1e-3 * size;
    for pole in sorted {
        let wide = if pole.im == 0.0 { 1 } else { 2 };
        for i in 0..wide {
            f[(at + i, at + i)] = pole.re;
        }
        if wide == 2 {
            (f[(at, at + 1)], f[(at + 1, at)]) = (pole.im, -pole.im);
        }
        if before.is_some_and(|before| alike(before, pole)) {
            for i in 0..wide {
                f[(at + i - wide, at + i)] = size;
            }
        }
        (at, before) = (at + wide, Some(pole));
    }
    f
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Time, TransferFunction};

    fn real(values: &[f64]) -> Vec<Complex> {
        values.iter().map(|&re| Complex::new(re, 0.0)).collect()
    }

    fn system(text: &str) -> StateSpace {
        TransferFunction::parse(text, Time::Continuous).unwrap().state_space().unwrap()
    }

    #[test]
    fn a_double_integrator_gets_the_gains_of_the_textbook() {
        let a = Matrix::from_row_slice(2, 2, &[0.0, 1.0, 0.0, 0.0]);
        let b = Matrix::from_row_slice(2, 1, &[0.0, 2.0]);
        let plant =
            StateSpace::new(a, b, Matrix::identity(2, 2), Matrix::zeros(2, 1), Time::Continuous).unwrap();
        // (s + 3)(s + 5) = s² + 8 s + 15
        let gain = plant.place(&real(&[-3.0, -5.0])).unwrap();
        assert!((gain[(0, 0)] - 7.5).abs() < 1e-12 && (gain[(0, 1)] - 4.0).abs() < 1e-12, "{gain}");
        // a repeated pole, a pair, one where it was
        let gain = plant.place(&real(&[-3.0, -3.0])).unwrap();
        assert!((gain[(0, 0)] - 4.5).abs() < 1e-10 && (gain[(0, 1)] - 3.0).abs() < 1e-10, "{gain}");
        let pair = [Complex::new(-1.0, 2.0), Complex::new(-1.0, -2.0)];
        let gain = plant.place(&pair).unwrap();
        assert!((gain[(0, 0)] - 2.5).abs() < 1e-12 && (gain[(0, 1)] - 1.0).abs() < 1e-12, "{gain}");
        // a real pole beside a pair
        let three = system("1/(s(s+1)(s+2))");
        let beside = [Complex::new(-40.0, 0.0), Complex::new(-40.0, 0.01), Complex::new(-40.0, -0.01)];
        assert!(three.place(&beside).is_ok());
        assert!(plant.place(&real(&[-1e300, -1e300])).is_err());
        let gain = plant.place(&real(&[0.0, -4.0])).unwrap();
        assert!(gain[(0, 0)].abs() < 1e-12 && (gain[(0, 1)] - 2.0).abs() < 1e-12, "{gain}");
        assert!(plant.place(&pair[..1]).is_err() && plant.place(&[pair[0], pair[0]]).is_err());
    }

    #[test]
    fn poles_of_larger_systems_are_where_they_were_wished() {
        for text in ["(s+3)/((s+1)(s-2)(s^2+s+40)(s+7)s)", "1/(s+1)^8", "100/((s+0.1)(s+100)(s^2+3))"] {
            let plant = system(text);
            let wanted: Vec<Complex> =
                (0..plant.order()).map(|k| Complex::new(-2.0 - k as f64, 0.0)).collect();
            let gain = plant.place(&wanted).unwrap();
            let mut there = eigenvalues(&(plant.a() - plant.b() * gain)).unwrap();
            there.sort_by(|a, b| b.re.total_cmp(&a.re));
            for (there, wanted) in there.iter().zip(&wanted) {
                assert!(
                    complex::norm(there - wanted) < 1e-5 * complex::norm(*wanted),
                    "{text}: {there} {wanted}"
                );
            }
        }
    }

    #[test]
    fn two_inputs_share_the_work() {
        let a = Matrix::from_row_slice(
            4,
            4,
            &[0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.001, -0.13, 0.0, 0.0, -0.78, 0.0, -0.13],
        );
        let b = Matrix::from_row_slice(4, 2, &[0.0, 0.0, 0.0, 0.0, 13.0, -0.015, -0.015, 13.3]);
        let plant =
            StateSpace::new(a, b, Matrix::identity(4, 4), Matrix::zeros(4, 2), Time::Continuous).unwrap();
        let wanted = real(&[-10.0, -10.0, -20.0, -30.0]);
        let gain = plant.place(&wanted).unwrap();
        let mut there = eigenvalues(&(plant.a() - plant.b() * gain)).unwrap();
        there.sort_by(|a, b| b.re.total_cmp(&a.re));
        assert!(there.iter().zip(&wanted).all(|(a, b)| complex::norm(a - b) < 1e-4), "{there:?}");
    }

    #[test]
    fn what_no_input_moves_is_not_placed() {
        let a = Matrix::from_row_slice(2, 2, &[-1.0, 0.0, 0.0, -2.0]);
        let b = Matrix::from_row_slice(2, 1, &[1.0, 0.0]);
        let plant =
            StateSpace::new(a, b, Matrix::identity(2, 2), Matrix::zeros(2, 1), Time::Continuous).unwrap();
        assert!(plant.place(&real(&[-3.0, -4.0])).is_err());
    }
}
