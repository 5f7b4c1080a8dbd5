use tracelight_maths::complex;

use super::riccati::Riccati;
use crate::state_space::stack;
use crate::{Complex, LinearError, Matrix, StateSpace, Time};

/// A state feedback u = −K x that costs least.
#[derive(Clone, Debug, PartialEq)]
pub struct Regulator {
    /// K, inputs × states.
    pub gain: Matrix,
    /// What it costs to come to rest from a state x is xᵀ X x.
    pub cost: Matrix,
    /// Poles of A − B K.
    pub poles: Vec<Complex>,
}

/// An estimate of the state from the outputs: x̂ follows A x̂ + B u + L (y − C x̂ − D u).
#[derive(Clone, Debug, PartialEq)]
pub struct Estimator {
    /// L, states × outputs; of samples from this one to the next estimate.
    pub gain: Matrix,
    /// What the estimate's error varies by, in the long run.
    pub covariance: Matrix,
    /// Poles of A − L C.
    pub poles: Vec<Complex>,
}

impl StateSpace {
    /// The regulator that makes ∫ xᵀ Q x + uᵀ R u least, of samples the sum (LQR). Q is symmetric and not negative, n × n; R is symmetric
    /// and positive, inputs × inputs.
    pub fn lqr(&self, q: &Matrix, r: &Matrix) -> Result<Regulator, LinearError> {
        let (n, inputs) = self.b().shape();
        if q.shape() != (n, n) || r.shape() != (inputs, inputs) {
            return Err(LinearError::Shape(
                "Q has as many rows and columns as there are states, R as inputs",
            ));
        }
        self.regulator(&weight(q, "Q")?, &weight(r, "R")?)
    }

    fn regulator(&self, q: &Matrix, r: &Matrix) -> Result<Regulator, LinearError> {
        let (cost, gain) = Riccati { a: self.a(), b: self.b(), q, r, time: self.time() }.solve()?;
        let poles = self.stable_poles(&(self.a() - self.b() * &gain))?;
        Ok(Regulator { gain, cost, poles })
    }

    /// The regulator that makes ∫ yᵀ W y + uᵀ R u least: outputs cost instead of states. W is symmetric and not negative, of as many rows as
    /// outputs.
    pub fn lqr_of_outputs(&self, w: &Matrix, r: &Matrix) -> Result<Regulator, LinearError> {
        let (inputs, outputs) = (self.b().ncols(), self.c().nrows());
        if w.shape() != (outputs, outputs) || r.shape() != (inputs, inputs) {
            return Err(LinearError::Shape(
                "W has as many rows and columns as there are outputs, R as inputs",
            ));
        }
        let (w, r) = (weight(w, "W")?, weight(r, "R")?);
        let (c, d) = (self.c(), self.d());
        // y = C x + D u costs xᵀ S u, too: u = v − R⁻¹ Sᵀ x costs without
        let r = &r + d.transpose() * &w * d;
        let across = c.transpose() * &w * d;
        let before = r.clone().cholesky().ok_or(LinearError::NotPositive("R"))?.solve(&across.transpose());
        let plant =
            Self::new(self.a() - self.b() * &before, self.b().clone(), c.clone(), d.clone(), self.time())?;
        let q = c.transpose() * &w * c - across * &before;
        // not negative but for rounding: W is not
        let inner = plant.regulator(&(0.5 * (&q + q.transpose())), &r)?;
        Ok(Regulator { gain: inner.gain + before, ..inner })
    }

    /// The estimator whose error varies least, if every state is pushed by white noise of that intensity, n × n, and outputs show
    /// another beside what they are, outputs × outputs (Kalman and Bucy; of samples Kalman, covariances of both).
    pub fn kalman(&self, pushed: &Matrix, seen: &Matrix) -> Result<Estimator, LinearError> {
        let (n, outputs) = (self.order(), self.c().nrows());
        if pushed.shape() != (n, n) || seen.shape() != (outputs, outputs) {
            return Err(LinearError::Shape(
                "the noise of the states is of n × n, that of the outputs of as many as these",
            ));
        }
        let (pushed, seen) =
            (weight(pushed, "the noise of the states")?, weight(seen, "the noise of the outputs")?);
        let (a, b) = (self.a().transpose(), self.c().transpose());
        let (covariance, gain) = Riccati { a: &a, b: &b, q: &pushed, r: &seen, time: self.time() }.solve()?;
        let gain = gain.transpose();
        let poles = self.stable_poles(&(self.a() - &gain * self.c()))?;
        Ok(Estimator { gain, covariance, poles })
    }

    /// The controller that feeds an estimated state back, u = −K x̂: from outputs to inputs, its sign such that it is closed by negative
    /// feedback.
    pub fn compensator(&self, gain: &Matrix, estimator: &Matrix) -> Result<Self, LinearError> {
        let (n, inputs) = self.b().shape();
        if gain.shape() != (inputs, n) || estimator.shape() != (n, self.c().nrows()) {
            return Err(LinearError::Shape("K is of inputs × states, L of states × outputs"));
        }
        let a = self.a() - self.b() * gain - estimator * self.c() + estimator * self.d() * gain;
        Self::new(a, estimator.clone(), gain.clone(), Matrix::zeros(inputs, self.c().nrows()), self.time())
    }

    /// The same with the integral of each output as another state, of samples their sum times the period: the last ones.
    pub fn with_integrals(&self) -> Result<Self, LinearError> {
        let (n, outputs, inputs) = (self.order(), self.c().nrows(), self.b().ncols());
        let (kept, step) = self.time().integral();
        let a = stack(&[
            &[self.a(), &Matrix::zeros(n, outputs)],
            &[&(self.c() * step), &(Matrix::identity(outputs, outputs) * kept)],
        ]);
        let b = stack(&[&[self.b()], &[&(self.d() * step)]]);
        let c = stack(&[
            &[self.c(), &Matrix::zeros(outputs, outputs)],
            &[&Matrix::zeros(outputs, n), &Matrix::identity(outputs, outputs)],
        ]);
        let d = stack(&[&[self.d()], &[&Matrix::zeros(outputs, inputs)]]);
        Self::new(a, b, c, d, self.time())
    }

    /// Its poles, if all die out.
    fn stable_poles(&self, closed: &Matrix) -> Result<Vec<Complex>, LinearError> {
        let mut poles = crate::eigenvalues(closed)?;
        let size = poles.iter().map(|z| complex::norm(*z)).fold(0.0, f64::max);
        // a mode that nothing moves, or that costs nothing, stays where it was, to rounding at the edge
        let is_stable = |pole: &Complex| match self.time() {
            Time::Continuous => pole.re < -1e-13 * size,
            Time::Sampled(_) => complex::norm(*pole) < 1.0 - 1e-13,
        };
        if !poles.iter().all(is_stable) {
            return Err(LinearError::NoRegulator);
        }
        poles.sort_by(|a, b| complex::norm(*a).total_cmp(&complex::norm(*b)));
        Ok(poles)
    }
}

/// A weight made exactly symmetric; refused if it is not about so, or no numbers, or has a negative entry on its diagonal.
fn weight(m: &Matrix, name: &'static str) -> Result<Matrix, LinearError> {
    let off = (m - m.transpose()).norm();
    if !m.iter().all(|entry| entry.is_finite()) {
        return Err(LinearError::NotFinite);
    }
    if off > 1e-9 * m.norm() || m.diagonal().iter().any(|entry| *entry < -1e-12 * m.norm()) {
        return Err(LinearError::NotPositive(name));
    }
    let m = 0.5 * (m + m.transpose());
    let least = crate::eigenvalues(&m)?.iter().map(|z| z.re).fold(0.0, f64::min);
    if least < -1e-9 * m.norm() { Err(LinearError::NotPositive(name)) } else { Ok(m) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Discretization, TransferFunction};

    fn chain() -> StateSpace {
        let a = Matrix::from_row_slice(2, 2, &[0.0, 1.0, 0.0, 0.0]);
        let b = Matrix::from_row_slice(2, 1, &[0.0, 1.0]);
        let c = Matrix::from_row_slice(1, 2, &[1.0, 0.0]);
        StateSpace::new(a, b, c, Matrix::zeros(1, 1), Time::Continuous).unwrap()
    }

    /// Q = diag(1, 0), R = 1: K = (1, √2).
    #[test]
    fn a_double_integrator_has_butterworths_poles() {
        let q = Matrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, 0.0]);
        let one = Matrix::identity(1, 1);
        let regulator = chain().lqr(&q, &one).unwrap();
        let root = 2.0_f64.sqrt();
        let gain = Matrix::from_row_slice(1, 2, &[1.0, root]);
        assert!((&regulator.gain - gain).norm() < 1e-14, "{}", regulator.gain);
        let cost = Matrix::from_row_slice(2, 2, &[root, 1.0, 1.0, root]);
        assert!((&regulator.cost - cost).norm() < 1e-14, "{}", regulator.cost);
        assert!(complex::norm(regulator.poles[0] - Complex::new(-root / 2.0, root / 2.0)) < 1e-14);
    }

    /// The regulator of fast samples is nearly that of continuous time.
    #[test]
    fn samples_cost_nearly_the_same() {
        let (q, r) = (Matrix::identity(2, 2), Matrix::identity(1, 1) * 0.1);
        let there = chain().lqr(&q, &r).unwrap();
        let step = 1e-4;
        let here =
            chain().sampled(step, Discretization::ZeroOrderHold).unwrap().lqr(&(q * step), &(r * step));
        assert!((here.unwrap().gain - there.gain).norm() < 1e-3);
    }

    #[test]
    fn a_kalman_gain_is_the_dual_of_a_regulators() {
        let plant = chain();
        let pushed = plant.b() * plant.b().transpose() * 4.0;
        let estimator = plant.kalman(&pushed, &Matrix::identity(1, 1)).unwrap();
        // intensity 4 against 1: poles of size √2, L = (2, 2)
        assert!(
            (&estimator.gain - Matrix::from_row_slice(2, 1, &[2.0, 2.0])).norm() < 1e-13,
            "{}",
            estimator.gain
        );
    }

    #[test]
    fn an_estimated_state_controls_as_the_state_and_the_estimator_do() {
        let plant = TransferFunction::parse("13.3/(s^2+0.13s+0.78)", Time::Continuous)
            .unwrap()
            .state_space()
            .unwrap();
        let q = plant.c().transpose() * plant.c() * 1e4;
        let regulator = plant.lqr(&q, &Matrix::identity(1, 1)).unwrap();
        let pushed = plant.b() * plant.b().transpose() * 1e6;
        let estimator = plant.kalman(&pushed, &Matrix::identity(1, 1)).unwrap();
        let back = plant.compensator(&regulator.gain, &estimator.gain).unwrap();
        let mut there = plant.feedback(&back).unwrap().poles().unwrap();
        let mut wanted: Vec<Complex> = regulator.poles.into_iter().chain(estimator.poles).collect();
        for poles in [&mut there, &mut wanted] {
            poles.sort_by(|a, b| (complex::norm(*a), a.im).partial_cmp(&(complex::norm(*b), b.im)).unwrap());
        }
        assert!(
            there.iter().zip(&wanted).all(|(a, b)| complex::norm(a - b) < 1e-9 * complex::norm(*b)),
            "{there:?} {wanted:?}"
        );
    }

    #[test]
    fn an_integral_leaves_no_constant_error() {
        let plant = chain().with_integrals().unwrap();
        assert_eq!((plant.order(), plant.c().nrows()), (3, 2));
        let regulator = plant.lqr(&Matrix::identity(3, 3), &Matrix::identity(1, 1)).unwrap();
        assert!(regulator.poles.iter().all(|pole| pole.re < 0.0));
        let sampled = chain().sampled(0.01, Discretization::ZeroOrderHold).unwrap().with_integrals().unwrap();
        assert!(sampled.lqr(&Matrix::identity(3, 3), &Matrix::identity(1, 1)).is_ok());
    }

    #[test]
    fn what_cannot_be_brought_to_rest_is_refused() {
        let a = Matrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, -2.0]);
        let b = Matrix::from_row_slice(2, 1, &[0.0, 1.0]);
        let plant =
            StateSpace::new(a, b, Matrix::identity(2, 2), Matrix::zeros(2, 1), Time::Continuous).unwrap();
        let (two, one) = (Matrix::identity(2, 2), Matrix::identity(1, 1));
        assert_eq!(plant.lqr(&two, &one), Err(LinearError::NoRegulator));
        // an integrator that costs nothing
        assert!(chain().lqr(&Matrix::zeros(2, 2), &one).is_err());
        let saddle = Matrix::from_row_slice(2, 2, &[1.0, 10.0, 10.0, 1.0]);
        assert_eq!(chain().lqr(&saddle, &one), Err(LinearError::NotPositive("Q")));
        assert!(chain().lqr(&two, &-&one).is_err() && chain().lqr(&one, &one).is_err());
        assert!(chain().lqr(&(&two * f64::NAN), &one).is_err());
    }
}
