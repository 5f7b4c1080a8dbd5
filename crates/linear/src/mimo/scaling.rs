use tracelight_maths::{exp, ln};

use crate::golden::lowest;
use crate::mimo::gain::ComplexMatrix;
use crate::mimo::singular::singular_values;
use crate::{Complex, LinearError, Matrix, Peak, StateSpace};

/// Sets of frequencies that scales are chosen for; some three are enough.
const MOST_SETS: usize = 12;
/// Largest logarithm of a scale: beyond it digits run out.
const MOST: f64 = 10.0;
/// Sections of the search for each.
const SECTIONS: usize = 60;

impl StateSpace {
    /// The least H∞ norm of D G D⁻¹ that was found over constant diagonal D, and where it is: a bound on what changes of each channel in
    /// its own way see, from above (Doyle, *Analysis of feedback systems with structured uncertainties*, IEE Proc. D 129, 1982).
    ///
    /// `whole` is the norm without D. The scales are the best of the frequencies at which the norm was largest so far; the norm itself is
    /// that of all frequencies, so whatever the scales are it is a bound. Where the last scales are best at one frequency it is the
    /// largest over frequency of the least over D of each.
    pub(super) fn scaled_norm(&self, whole: Peak, tolerance: f64) -> Result<Peak, LinearError> {
        let channels = self.d().nrows();
        let mut best = whole;
        if channels < 2 {
            return Ok(best);
        }
        let mut logs = vec![0.0; channels];
        let (mut values, mut worst) = (Vec::new(), whole);
        for _ in 0..MOST_SETS {
            values.push(self.value_at(worst.rad_s)?);
            let reached = choose(&values, &mut logs);
            let Some(peak) = self.scaled(&logs)?.h_infinity_norm(tolerance)? else { break };
            if peak.gain < best.gain {
                best = peak;
            }
            if peak.gain <= reached * (1.0 + 1e-7) {
                break;
            }
            worst = peak;
        }
        Ok(best)
    }

    fn value_at(&self, rad_s: f64) -> Result<ComplexMatrix, LinearError> {
        if rad_s.is_finite() {
            self.at(self.time().at_frequency(rad_s))
        } else {
            Ok(self.d().map(Complex::from))
        }
    }

    /// D G D⁻¹ of these logarithms of D.
    fn scaled(&self, logs: &[f64]) -> Result<Self, LinearError> {
        let scales = |sign: f64| {
            let size = logs.len();
            Matrix::from_fn(size, size, |i, j| if i == j { exp(sign * logs[i]) } else { 0.0 })
        };
        let (left, right) = (scales(1.0), scales(-1.0));
        let (b, c, d) = (self.b() * &right, &left * self.c(), &left * self.d() * &right);
        Self::new(self.a().clone(), b, c, d, self.time())
    }
}

/// The largest singular value of all these matrices, scaled.
fn largest(values: &[ComplexMatrix], logs: &[f64]) -> f64 {
    let of = |value: &ComplexMatrix| {
        let scaled = ComplexMatrix::from_fn(value.nrows(), value.ncols(), |i, j| {
            value[(i, j)] * exp(logs[i] - logs[j])
        });
        singular_values(&scaled).first().copied().unwrap_or(0.0)
    };
    values.iter().map(of).fold(0.0, f64::max)
}

/// Better scales, one after the other: what the largest singular value is over each is convex. The value that is reached.
fn choose(values: &[ComplexMatrix], logs: &mut [f64]) -> f64 {
    const ROUNDS: usize = 8;
    balance(values, logs);
    let mut reached = largest(values, logs);
    // more channels have the scales of the balance: each round is a singular value for each channel and section
    if logs.len() > 8 {
        return reached;
    }
    for _ in 0..ROUNDS {
        let before = reached;
        for i in 1..logs.len() {
            let old = logs[i];
            let value = |log| {
                logs[i] = log;
                largest(values, logs)
            };
            let new = lowest(value, (-MOST, MOST), SECTIONS);
            logs[i] = if new.1 < reached { new.0 } else { old };
            reached = reached.min(new.1);
        }
        if before - reached <= 1e-12 * before || logs.len() == 2 {
            break;
        }
    }
    reached
}

/// Scales by which row and column of each channel are about as large (Osborne), the first being 1.
fn balance(values: &[ComplexMatrix], logs: &mut [f64]) {
    const ROUNDS: usize = 20;
    let channels = logs.len();
    for _ in 0..ROUNDS {
        for i in 0..channels {
            let (mut row, mut column) = (0.0, 0.0);
            for value in values {
                for j in (0..channels).filter(|j| *j != i) {
                    row += value[(i, j)].norm_sqr() * exp(2.0 * (logs[i] - logs[j]));
                    column += value[(j, i)].norm_sqr() * exp(2.0 * (logs[j] - logs[i]));
                }
            }
            if row > 0.0 && column > 0.0 {
                logs[i] = (logs[i] + 0.25 * ln(column / row)).clamp(-MOST, MOST);
            }
        }
        let first = logs[0];
        logs.iter_mut().for_each(|log| *log = (*log - first).clamp(-MOST, MOST));
    }
}
