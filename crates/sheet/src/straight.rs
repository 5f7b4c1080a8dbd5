//! The straight line that most of some places are on.

use tracelight_image::median::middle;
use tracelight_image::solve;
use tracelight_maths::powi;

/// How far inside, at a line's beginning and at its end, the straight line lies that most steps are on: least squares
/// whose weights are the less the further off a step is (Beaton & Tukey, 1974).
pub(crate) fn straight(steps: &[(f64, f64)]) -> (f64, f64) {
    let level = middle(steps.iter().map(|s| s.1).collect()).unwrap_or(0.0);
    let (mut first, mut last) = (level, level);
    for _ in 0..8 {
        let off = |&(s, off): &(f64, f64)| off - first - (last - first) * s;
        let spread = 4.0 * middle(steps.iter().map(|s| off(s).abs()).collect()).unwrap_or(0.0).max(0.25);
        let near = |step: &(f64, f64)| powi((1.0 - powi(off(step) / spread, 2)).max(0.0), 2);
        let Some((at, slope)) = solve::line(steps.iter().map(|step| (step.0, step.1, near(step)))) else {
            break;
        };
        (first, last) = (at, at + slope);
    }
    (first, last)
}
