//! Decides whether the residual of a fit is noise or unfitted shape.

use std::f64::consts::PI;

use tracelight_maths as maths;

/// Slow waves that are looked for: an arc laid along a curve leaves one to three of them.
const WAVES: usize = 5;
/// Slow waves are a shape when they have more than this times the power that noise puts there.
const SIGNIFICANT: f64 = 8.0;
/// Smallest root mean square of a shape, as a share of what points may be off: tracers bend a line by as much.
const FLOOR: f64 = 0.35;

/// Whether deviations `off` in order have no more slow waves in them than their quick ones explain, or than a third of
/// `rms`.
///
/// The waves are those of the discrete cosine transform (Ahmed, Natarajan & Rao, 1974): orthogonal on the points.
pub(super) fn is_even(off: &[f64], rms: f64) -> bool {
    let n = off.len() as f64;
    let total: f64 = off.iter().map(|e| e * e).sum();
    let waves = (off.len() / 4).clamp(2, WAVES);
    let mut sums = [0.0; WAVES];
    let (sin, cos) = maths::sin_cos(PI / n);
    let (mut c, mut s) = (maths::cos(0.5 * PI / n), maths::sin(0.5 * PI / n));
    for e in off {
        // cos(m t) by Chebyshev's recurrence
        let (mut before, mut now) = (1.0, c);
        for sum in &mut sums[..waves] {
            *sum += e * now;
            (before, now) = (now, 2.0 * c * now - before);
        }
        (c, s) = (c * cos - s * sin, s * cos + c * sin);
    }
    let slow = sums.iter().map(|a| a * a).sum::<f64>() * 2.0 / n;
    let quick = (total - slow).max(0.0);
    let share = waves as f64 / (n - waves as f64 - 1.0).max(1.0);
    slow <= n * maths::powi(FLOOR * rms, 2) || slow <= SIGNIFICANT * share * quick
}
