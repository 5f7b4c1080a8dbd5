use tracelight_maths::{atan, complex};

use crate::eigen::eigenvalues;
use crate::mimo::gain::ComplexMatrix;
use crate::mimo::singular::singular_values;
use crate::state_space::stack;
use crate::{Complex, LinearError, Matrix, Peak, StateSpace, Time};

/// Steps from one bound to the next; some four are enough.
const MOST_STEPS: usize = 40;
/// Doublings of the time that Lyapunov's sum has come to.
const MOST_DOUBLINGS: usize = 64;
/// An eigenvalue that is no further from the imaginary axis, beside its size, may be on it.
const MAY_BE_ON_AXIS: f64 = 1e-4;

impl StateSpace {
    /// The largest singular value over all frequencies and where it is, to that relative tolerance; none of what is not stable.
    ///
    /// Where a singular value is at a level is an imaginary eigenvalue of a Hamiltonian matrix: nothing is missed between grid points
    /// (Bruinsma & Steinbuch, *A fast algorithm to compute the H∞-norm of a transfer function matrix*, Systems & Control Letters 14,
    /// 1990). What is sampled is mapped by z = (1 + s)/(1 − s) first.
    ///
    /// # Errors
    /// [`LinearError::Range`] of a tolerance below 10⁻¹², [`LinearError::NotConverged`].
    pub fn h_infinity_norm(&self, tolerance: f64) -> Result<Option<Peak>, LinearError> {
        if !(1e-12..1.0).contains(&tolerance) {
            return Err(LinearError::Range {
                name: "the tolerance of the norm",
                value: tolerance,
                below: " by 1e-12 at least, and less than 1".into(),
            });
        }
        if !self.is_stable()? {
            return Ok(None);
        }
        let Time::Sampled(period_s) = self.time() else { return self.peak(tolerance).map(Some) };
        let peak = self.unsampled()?.peak(tolerance)?;
        Ok(Some(Peak { rad_s: 2.0 * atan(peak.rad_s) / period_s, gain: peak.gain }))
    }

    /// The energy of all responses to impulses, or what white noise of 1 comes out as: its square is the trace of C X Cᵀ with the
    /// states' covariance X. None of what is not stable, or lets an impulse straight through in continuous time.
    ///
    /// # Errors
    /// [`LinearError::NotConverged`].
    pub fn h2_norm(&self) -> Result<Option<f64>, LinearError> {
        let through = self.d().norm_squared();
        if !self.is_stable()? || (self.time() == Time::Continuous && through > 0.0) {
            return Ok(None);
        }
        let (a, q) = (self.a(), self.b() * self.b().transpose());
        let covariance = match self.time() {
            Time::Sampled(_) => summed(a.clone(), q)?,
            Time::Continuous => {
                // Smith's: what is summed over steps of a rule as Tustin's is what is integrated
                let sizes: Vec<f64> = eigenvalues(a)?.into_iter().map(complex::norm).collect();
                let (least, most) =
                    sizes.iter().fold((f64::INFINITY, 0.0_f64), |(l, m), s| (l.min(*s), m.max(*s)));
                let rate = if sizes.is_empty() { 1.0 } else { least.sqrt() * most.sqrt() };
                let one = Matrix::identity(a.nrows(), a.nrows());
                let inverse = (&one * rate - a).try_inverse().ok_or(LinearError::NotConverged)?;
                summed(&inverse * (&one * rate + a), &inverse * q * inverse.transpose() * (2.0 * rate))?
            }
        };
        let energy = (self.c() * covariance * self.c().transpose()).trace();
        Ok(Some((energy + if self.time() == Time::Continuous { 0.0 } else { through }).max(0.0).sqrt()))
    }

    pub(super) fn is_stable(&self) -> Result<bool, LinearError> {
        let inside = |pole: &Complex| match self.time() {
            Time::Continuous => pole.re < 0.0,
            Time::Sampled(_) => complex::norm(*pole) < 1.0,
        };
        Ok(self.poles()?.iter().all(inside))
    }

    /// In continuous time, with the values at tan(ωT/2) that this has at ω.
    fn unsampled(&self) -> Result<Self, LinearError> {
        let n = self.order();
        let one = Matrix::identity(n, n);
        let inverse = (self.a() + &one).try_inverse().ok_or(LinearError::NotConverged)?;
        let root = std::f64::consts::SQRT_2;
        Self::new(
            &inverse * (self.a() - &one),
            &inverse * self.b() * root,
            self.c() * &inverse * root,
            self.d() - self.c() * &inverse * self.b(),
            Time::Continuous,
        )
    }

    fn peak(&self, tolerance: f64) -> Result<Peak, LinearError> {
        let through = largest(&self.d().map(Complex::from));
        let mut best = Peak { rad_s: f64::INFINITY, gain: through };
        let mut starts = vec![0.0];
        for pole in self.poles()? {
            let size = complex::norm(pole);
            starts.push(size);
            // where a lightly damped one resonates
            starts.push((size * size - 2.0 * pole.re * pole.re).max(0.0).sqrt());
        }
        starts.iter().for_each(|w| self.raise(&mut best, *w));
        for _ in 0..MOST_STEPS {
            let level = (1.0 + 2.0 * tolerance) * best.gain;
            if best.gain == 0.0 {
                return Ok(best);
            }
            let crossings = self.crossings(level)?;
            let before = best.gain;
            for pair in crossings.windows(2) {
                self.raise(&mut best, (pair[0] * pair[1]).sqrt());
                self.raise(&mut best, 0.5 * (pair[0] + pair[1]));
            }
            crossings.iter().for_each(|w| self.raise(&mut best, *w));
            if best.gain <= level.max(before) {
                return Ok(best);
            }
        }
        Err(LinearError::NotConverged)
    }

    fn raise(&self, best: &mut Peak, rad_s: f64) {
        let gain = self.at(Complex::new(0.0, rad_s)).map_or(0.0, |value| largest(&value));
        if gain > best.gain {
            *best = Peak { rad_s, gain };
        }
    }

    /// Frequencies at which a singular value may be at that level, rising: some may be none.
    fn crossings(&self, level: f64) -> Result<Vec<f64>, LinearError> {
        let [a, b, c, d] = [self.a(), self.b(), self.c(), self.d()];
        let (inputs, outputs) = (b.ncols(), c.nrows());
        // in units in which the level is 1
        let (c, d) = (c / level, d / level);
        let r = d.transpose() * &d - Matrix::identity(inputs, inputs);
        let s = &d * d.transpose() - Matrix::identity(outputs, outputs);
        let inverse = |m: Matrix| m.try_inverse().ok_or(LinearError::NotConverged);
        let (r, s) = (inverse(r)?, inverse(s)?);
        let own = a - b * &r * d.transpose() * &c;
        let hamiltonian = stack(&[
            &[&own, &(-(b * &r * b.transpose()))],
            &[&(c.transpose() * s * &c), &(-own.transpose())],
        ]);
        let found = eigenvalues(&hamiltonian)?;
        let on_axis =
            found.into_iter().filter(|z| z.im >= 0.0 && z.re.abs() <= MAY_BE_ON_AXIS * complex::norm(*z));
        let mut crossings: Vec<f64> = on_axis.map(|z| z.im).collect();
        crossings.push(0.0);
        crossings.sort_by(f64::total_cmp);
        Ok(crossings)
    }
}

fn largest(value: &ComplexMatrix) -> f64 {
    singular_values(value).first().copied().unwrap_or(0.0)
}

/// X = A X Aᵀ + Q of what dies out, twice as many steps at a time.
fn summed(mut a: Matrix, mut x: Matrix) -> Result<Matrix, LinearError> {
    for _ in 0..MOST_DOUBLINGS {
        let more = &a * &x * a.transpose();
        let size = x.norm();
        x += &more;
        if !x.norm().is_finite() {
            break;
        }
        if more.norm() <= 1e-17 * size || more.norm() == 0.0 {
            return Ok(x);
        }
        a = &a * &a;
    }
    Err(LinearError::NotConverged)
}
