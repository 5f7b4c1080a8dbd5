use tracelight_maths::{complex, exp2, log2, powf, powi};

use crate::eigen::{balanced, eigenvalues};
use crate::{Complex, LinearError, Matrix, StateSpace, Time};

/// Halvings of the error's exponent: each doubles the digits, and poles a million apart need some twenty.
const MOST_DOUBLINGS: usize = 60;

/// States beyond which a solution is not refined: Lyapunov's equation is solved as one of n² unknowns.
const MOST_REFINED: usize = 24;

/// A gain that Newton's iteration would move by more than this share of it is not the best yet.
const MOST_MOVED: f64 = 1e-9;

/// What the best cost is, xᵀ X x, and what it needs: ẋ = A x + B u with cost ∫ xᵀ Q x + uᵀ R u, or a sum over samples.
pub(super) struct Riccati<'a> {
    pub(super) a: &'a Matrix,
    pub(super) b: &'a Matrix,
    pub(super) q: &'a Matrix,
    pub(super) r: &'a Matrix,
    pub(super) time: Time,
}

impl Riccati<'_> {
    /// X and the gain of u = −K x.
    ///
    /// By a structure-preserving doubling algorithm (Chu, Fan & Lin, *A structure-preserving doubling algorithm for continuous-time
    /// algebraic Riccati equations*, Linear Algebra Appl. 396, 2005; of samples Chu, Fan, Lin & Wang, Int. J. Control 77, 2004),
    /// then by Newton's iteration (Kleinman 1968), on balanced states.
    pub(super) fn solve(&self) -> Result<(Matrix, Matrix), LinearError> {
        if self.a.nrows() == 0 {
            return Ok((Matrix::zeros(0, 0), Matrix::zeros(self.b.ncols(), 0)));
        }
        let r_inverse = self.r.clone().cholesky().ok_or(LinearError::NotPositive("R"))?.inverse();
        let scales = scales(self.a, &(self.b * &r_inverse * self.b.transpose()), self.q);
        // x = D y
        let rows = |m: &Matrix, power: i32| {
            let mut m = m.clone();
            for (i, scale) in scales.iter().enumerate() {
                m.row_mut(i).iter_mut().for_each(|entry| *entry *= powi(*scale, power));
            }
            m
        };
        let columns = |m: &Matrix, power: i32| rows(&m.transpose(), power).transpose();
        let a = columns(&rows(self.a, -1), 1);
        let (b, q) = (rows(self.b, -1), columns(&rows(self.q, 1), 1));
        let g = &b * &r_inverse * b.transpose();
        let inner = Riccati { a: &a, b: &b, q: &q, r: self.r, time: self.time };
        let doubled = match self.time {
            Time::Continuous => continuous(&a, &g, &q),
            Time::Sampled(_) => doubled(a.clone(), g, q.clone()),
        };
        let is_small = a.nrows() <= MOST_REFINED;
        let refined = doubled.and_then(|x| {
            let (x, moved) = if is_small { inner.refined(x) } else { (x, 0.0) };
            inner.gain(&x).map(|gain| ((x, gain), moved))
        });
        let refined = refined.ok().filter(|((_, gain), _)| inner.settles(gain));
        // what grows fast beside what is slow leaves doubling no digits: then Newton's iteration would go on
        let (x, gain) = match refined {
            Some((found, moved)) if moved <= MOST_MOVED => found,
            Some((found, _)) => inner.approached().unwrap_or(found),
            None if is_small => inner.approached()?,
            None => return Err(LinearError::NoRegulator),
        };
        let back = columns(&rows(&x, -1), -1);
        Ok((0.5 * (&back + back.transpose()), columns(&gain, -1)))
    }

    fn gain(&self, x: &Matrix) -> Result<Matrix, LinearError> {
        match self.time {
            Time::Continuous => {
                let r = self.r.clone().cholesky().ok_or(LinearError::NotPositive("R"))?;
                Ok(r.solve(&(self.b.transpose() * x)))
            }
            Time::Sampled(_) => {
                let r = self.r + self.b.transpose() * x * self.b;
                let r = r.cholesky().ok_or(LinearError::NotPositive("R + BᵀXB"))?;
                Ok(r.solve(&(self.b.transpose() * x * self.a)))
            }
        }
    }

    /// Whether all that is fed back so dies out.
    fn settles(&self, gain: &Matrix) -> bool {
        let poles = eigenvalues(&(self.a - self.b * gain)).unwrap_or_default();
        let is_stable = |pole: &Complex| match self.time {
            Time::Continuous => pole.re < 0.0,
            Time::Sampled(_) => complex::norm(*pole) < 1.0,
        };
        poles.len() == self.a.nrows() && poles.iter().all(is_stable)
    }

    /// By Newton's iteration alone, from a feedback that mirrors each pole that does not die out; it converges from any that settles
    /// the system (Kleinman, *On an iterative technique for Riccati equation computations*, IEEE Trans. Autom. Control 13, 1968; of
    /// samples Hewer 1971).
    fn approached(&self) -> Result<(Matrix, Matrix), LinearError> {
        const MOST_STEPS: usize = 80;
        let n = self.a.nrows();
        let (c, d) = (Matrix::zeros(1, n), Matrix::zeros(1, self.b.ncols()));
        let plant = StateSpace::new(self.a.clone(), self.b.clone(), c, d, self.time)?;
        let poles = eigenvalues(self.a)?;
        let size = poles.iter().map(|pole| complex::norm(*pole)).fold(f64::MIN_POSITIVE, f64::max);
        let mirrored = |pole: &Complex| match self.time {
            // those at the edge a little inside
            Time::Continuous => Complex::new(-pole.re.abs().max(1e-3 * size), pole.im),
            Time::Sampled(_) if complex::norm(*pole) > 0.999 => {
                pole / complex::norm(*pole) * (1.0 / complex::norm(*pole)).min(0.999)
            }
            Time::Sampled(_) => *pole,
        };
        let mirrored: Vec<Complex> = poles.iter().map(mirrored).collect();
        let mut gain = plant.place(&mirrored).map_err(|_| LinearError::NoRegulator)?;
        let mut last = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            let (x, next) = self.newton(&gain)?;
            let moved = (&next - &gain).norm();
            gain = next;
            // it comes ever closer, until rounding moves it
            if moved <= 4.0 * f64::EPSILON * gain.norm() || (moved < 1e-6 * gain.norm() && moved >= last) {
                return if self.settles(&gain) { Ok((x, gain)) } else { Err(LinearError::NoRegulator) };
            }
            last = moved;
        }
        Err(LinearError::NotConverged)
    }

    /// What is fed back so, and what it costs.
    fn closed(&self, gain: &Matrix) -> (Matrix, Matrix) {
        (self.a - self.b * gain, self.q + gain.transpose() * self.r * gain)
    }

    /// A step of Newton's iteration: what a feedback costs, and the feedback that is best for that.
    fn newton(&self, gain: &Matrix) -> Result<(Matrix, Matrix), LinearError> {
        let (closed, cost) = self.closed(gain);
        let x = lyapunov(&closed, &cost, self.time).ok_or(LinearError::NoRegulator)?;
        let next = self.gain(&x)?;
        Ok((x, next))
    }

    /// What is left of the equation.
    fn residual(&self, x: &Matrix, gain: &Matrix) -> f64 {
        let (closed, cost) = self.closed(gain);
        match self.time {
            Time::Continuous => (closed.transpose() * x + x * closed + cost).norm(),
            Time::Sampled(_) => (closed.transpose() * x * closed + cost - x).norm(),
        }
    }

    /// Newton's iteration as long as it makes the residual smaller; and by which share of itself one step more moves the gain.
    fn refined(&self, mut x: Matrix) -> (Matrix, f64) {
        const MOST_STEPS: usize = 4;
        let Ok(mut gain) = self.gain(&x) else { return (x, f64::INFINITY) };
        let mut left = self.residual(&x, &gain);
        let mut steps = 0;
        while let Ok((next, next_gain)) = self.newton(&gain) {
            let next_left = self.residual(&next, &next_gain);
            if steps == MOST_STEPS || next_left.is_nan() || next_left >= left {
                return (x, (&next_gain - &gain).norm() / gain.norm());
            }
            (x, gain, left) = (next, next_gain, next_left);
            steps += 1;
        }
        (x, f64::INFINITY)
    }
}

/// Units of the states, powers of two, in which A is balanced, and what moves them is about as large as what they cost.
fn scales(a: &Matrix, g: &Matrix, q: &Matrix) -> Vec<f64> {
    let (_, mut scales) = balanced(a.clone());
    let size = |m: &Matrix, power: i32| {
        let entry = |(i, j): (usize, usize)| m[(i, j)] * powi(scales[i] * scales[j], power);
        let all = (0..a.nrows()).flat_map(|i| (0..a.nrows()).map(move |j| (i, j)));
        all.map(|at| powi(entry(at), 2)).sum::<f64>().sqrt()
    };
    let unit = exp2(log2(powf(size(g, -1) / size(q, 1), 0.25)).round());
    if unit.is_finite() && unit > 0.0 {
        scales.iter_mut().for_each(|scale| *scale *= unit);
    }
    scales
}

/// Continuous time to samples by Cayley's transform s = γ (z + 1)/(z − 1), which leaves X as it is.
fn continuous(a: &Matrix, g: &Matrix, q: &Matrix) -> Result<Matrix, LinearError> {
    let n = a.nrows();
    // the middle of the closed loop's poles: of the Hamiltonian's eigenvalues those to the left
    let mut hamiltonian = Matrix::zeros(2 * n, 2 * n);
    hamiltonian.view_mut((0, 0), (n, n)).copy_from(a);
    hamiltonian.view_mut((0, n), (n, n)).copy_from(&-g);
    hamiltonian.view_mut((n, 0), (n, n)).copy_from(&-q);
    hamiltonian.view_mut((n, n), (n, n)).copy_from(&-a.transpose());
    let sizes: Vec<f64> =
        eigenvalues(&hamiltonian)?.iter().map(|z| complex::norm(*z)).filter(|s| *s > 0.0).collect();
    let (least, most) =
        (sizes.iter().copied().fold(f64::INFINITY, f64::min), sizes.iter().copied().fold(0.0, f64::max));
    let middle = if most > 0.0 { (least * most).sqrt() } else { 1.0 };
    // an eigenvalue of A at γ would be divided by; others are taken
    let rates = [1.0, 1.31, 0.73, 2.3, 0.41].map(|factor| factor * middle);
    let found = rates.into_iter().find_map(|rate| {
        let shifted = (a - Matrix::identity(n, n) * rate).try_inverse()?;
        let inner = (a.transpose() - Matrix::identity(n, n) * rate + q * &shifted * g).try_inverse()?;
        let start = Matrix::identity(n, n) + inner.transpose() * (2.0 * rate);
        let g = &shifted * g * &inner * (2.0 * rate);
        let q = &inner * q * &shifted * (2.0 * rate);
        doubled(start, g, q).ok()
    });
    found.ok_or(LinearError::NoRegulator)
}

/// The limit of H: A ← A (1 + G H)⁻¹ A, G ← G + A (1 + G H)⁻¹ G Aᵀ, H ← H + Aᵀ H (1 + G H)⁻¹ A.
fn doubled(mut a: Matrix, mut g: Matrix, mut h: Matrix) -> Result<Matrix, LinearError> {
    let n = a.nrows();
    for _ in 0..MOST_DOUBLINGS {
        let inner = (Matrix::identity(n, n) + &g * &h).lu();
        let through = inner.solve(&a).ok_or(LinearError::NoRegulator)?;
        let across = inner.solve(&g).ok_or(LinearError::NoRegulator)?;
        let more = a.transpose() * &h * &through;
        g += &a * across * a.transpose();
        h += &more;
        // they are symmetric but for rounding
        g = 0.5 * (&g + g.transpose());
        h = 0.5 * (&h + h.transpose());
        a = &a * through;
        if !h.iter().chain(a.iter()).all(|entry| entry.is_finite()) {
            return Err(LinearError::NoRegulator);
        }
        if more.norm() <= f64::EPSILON * h.norm() {
            return Ok(h);
        }
    }
    Err(LinearError::NoRegulator)
}

/// X of AᵀX + XA + Q = 0, or of AᵀXA − X + Q = 0 of samples, as n² linear equations; none if a sum (a product) of two poles is 0 (1).
fn lyapunov(a: &Matrix, q: &Matrix, time: Time) -> Option<Matrix> {
    let n = a.nrows();
    let one = Matrix::identity(n, n);
    let across = a.transpose();
    let whole = match time {
        Time::Continuous => one.kronecker(&across) + across.kronecker(&one),
        Time::Sampled(_) => across.kronecker(&across) - Matrix::identity(n * n, n * n),
    };
    let right = Matrix::from_column_slice(n * n, 1, (-q).as_slice());
    let x = Matrix::from_column_slice(n, n, whole.lu().solve(&right)?.as_slice());
    Some(0.5 * (&x + x.transpose()))
}
