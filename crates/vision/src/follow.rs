//! From points found in an image to a path.

use tracelight_stroke::{FitOptions, Parabola, Path, Point, fit, simplify};

use crate::Options;
use crate::ridge::median;

/// Tolerance over the points' own noise: their largest deviations are three to four times its mean square's root,
/// and the fit uses 0.7 of the tolerance.
const TOLERANCE_TO_NOISE: f64 = 5.0;

/// Points in a window over which a line is a parabola, but for noise: 13 px of a bend of 16 px leave 0.03 px.
const WINDOW: usize = 13;

/// The path through points; where their noise is worth more than the tolerance, the tolerance gives way. `reach_px`
/// is how far about a corner they are not to be trusted.
pub(crate) fn path(points: &[Point], closed: bool, reach_px: f64, options: &Options) -> Option<Path> {
    let tolerance = options.tolerance_px.max(TOLERANCE_TO_NOISE * noise_px(points));
    let fitted =
        |reach| fit(points, closed, &FitOptions { tolerance, corner_rad: options.corner_rad, reach });
    let margin = 2.0 * tolerance + 1.0 + (2.0 * reach_px).min(6.0);
    // blots make rows so wild that a corner is put where nothing is: then the pen's width is no guide
    let first = fitted(reach_px)?;
    let tame = |path: &Path| stays_near(path, points, margin);
    if tame(&first) {
        return Some(first);
    }
    let second = fitted(options.tolerance_px).filter(tame);
    second.or_else(|| Path::polyline(&simplify(points, closed, tolerance), closed))
}

/// Whether a path keeps within the bounding box of its points, widened by `margin`.
fn stays_near(path: &Path, points: &[Point], margin: f64) -> bool {
    let bound = |of: fn(f64, f64) -> f64, from: f64| {
        points.iter().fold((from, from), |(x, y), p| (of(x, p.x), of(y, p.y)))
    };
    let ((left, top), (right, low)) = (bound(f64::min, f64::MAX), bound(f64::max, f64::MIN));
    path.flatten(0.5).iter().all(|p| {
        (left - margin..=right + margin).contains(&p.x) && (top - margin..=low + margin).contains(&p.y)
    })
}

/// How far points scatter about their line, px: the median over windows.
fn noise_px(points: &[Point]) -> f64 {
    let rms = |window: &[Point]| {
        let mut length = 0.0;
        let lengths = window.windows(2).map(|w| {
            length += w[0].distance(w[1]);
            length
        });
        let lengths: Vec<f64> = [0.0].into_iter().chain(lengths).collect();
        Parabola::through(lengths.iter().copied().zip(window.iter().copied())).map(|p| p.rms)
    };
    median(&points.windows(WINDOW).step_by(4).filter_map(rms).collect::<Vec<f64>>())
}
