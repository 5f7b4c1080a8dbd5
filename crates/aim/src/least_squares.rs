use nalgebra::{DMatrix, DVector};
use tracelight_maths::{ln_1p, powi};

/// What a least-squares problem is near a state: JᵀWJ, JᵀWr and half the (robust) sum of squares, r = measured − told.
#[derive(Clone, Debug)]
pub(crate) struct Normal {
    pub(crate) matrix: DMatrix<f64>,
    pub(crate) gradient: DVector<f64>,
    pub(crate) cost: f64,
}

impl Normal {
    pub(crate) fn zero(parameters: usize) -> Self {
        Self {
            matrix: DMatrix::zeros(parameters, parameters),
            gradient: DVector::zeros(parameters),
            cost: 0.0,
        }
    }

    /// Adds one measurement: its residual over its deviation, and the derivatives of what is told, over the same, by the parameters
    /// with these numbers. What is further off than the others counts less (Cauchy's loss; Triggs et al., *Bundle adjustment: a
    /// modern synthesis*, 1999, §3.3).
    pub(crate) fn add(&mut self, residual: f64, by: impl Iterator<Item = (usize, f64)> + Clone) {
        self.weigh(residual, by, 1.0 / (1.0 + powi(residual / SOFT, 2)));
        self.cost += loss(residual);
    }

    /// Adds a prior: weighted without the robust loss.
    pub(crate) fn add_belief(&mut self, residual: f64, by: impl Iterator<Item = (usize, f64)> + Clone) {
        self.weigh(residual, by, 1.0);
        self.cost += 0.5 * residual * residual;
    }

    fn weigh(&mut self, residual: f64, by: impl Iterator<Item = (usize, f64)> + Clone, weight: f64) {
        for (i, di) in by.clone() {
            let di = weight * di;
            self.gradient[i] += di * residual;
            // the lower triangle is all that is read
            by.clone().filter(|&(j, _)| j <= i).for_each(|(j, dj)| self.matrix[(i, j)] += di * dj);
        }
    }

    /// Covariance of the parameters; `None` if the measurements leave one open.
    pub(crate) fn covariance(&self) -> Option<DMatrix<f64>> {
        self.matrix.clone().cholesky().map(|lower| lower.inverse())
    }
}

/// Nearer than that many deviations to the best, a state counts as the best.
const SETTLED: f64 = 1e-4;
/// Damping up to which a step is about what it would be without.
const HARDLY_DAMPED: f64 = 1e-3;

/// From how many deviations on a measurement counts less.
const SOFT: f64 = 3.0;

fn loss(residual: f64) -> f64 {
    0.5 * SOFT * SOFT * ln_1p(powi(residual / SOFT, 2))
}

/// Something with parameters that measurements tell.
pub(crate) trait Problem {
    /// What the parameters are now.
    type State: Clone;

    /// How the measurements stand to it; `None` where it can not be.
    fn normal(&self, state: &Self::State) -> Option<Normal>;

    /// A step from it.
    fn stepped(&self, state: &Self::State, step: &[f64]) -> Self::State;
}

/// The state that fits best, from one nearby: Levenberg and Marquardt's method, each parameter damped by its own size (Marquardt 1963; damping
/// that grows ever faster after Madsen, Nielsen & Tingleff, *Methods for non-linear least squares problems*, 2004, §3.2). `None` if it is lost.
pub(crate) fn solve<P: Problem>(
    problem: &P,
    from: P::State,
    most_steps: usize,
) -> Option<(P::State, Normal)> {
    let mut state = from;
    let mut normal = problem.normal(&state)?;
    let (mut damping, mut growth) = (1e-4, 2.0);
    for _ in 0..most_steps {
        let mut damped = normal.matrix.clone();
        (0..damped.nrows()).for_each(|k| damped[(k, k)] *= 1.0 + damping);
        let step = damped.cholesky().map(|lower| lower.solve(&normal.gradient));
        let near = |step: &DVector<f64>| step.dot(&normal.gradient) <= SETTLED * SETTLED;
        if damping <= HARDLY_DAMPED && step.as_ref().is_some_and(near) {
            break;
        }
        let tried = step.and_then(|step| {
            let next = problem.stepped(&state, step.as_slice());
            let found = problem.normal(&next)?;
            (found.cost.is_finite() && found.cost <= normal.cost).then_some((next, found))
        });
        match tried {
            Some(better) => {
                (state, normal) = better;
                (damping, growth) = ((damping / 10.0).max(1e-12), 2.0);
            }
            None => {
                damping *= growth;
                growth *= 2.0;
                if damping > 1e12 {
                    break;
                }
            }
        }
    }
    normal.cost.is_finite().then_some((state, normal))
}
