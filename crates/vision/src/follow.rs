//! Makes a path of points found in an image.

use tracelight_stroke::{FitOptions, Parabola, Path, Piece, Point, fit, polyline_length, simplify};

use crate::bridge::{angle, measured};
use crate::options::Options;

/// Tolerance over the points' own noise: their largest deviations are three to four times its mean square's root,
/// and the fit uses 0.7 of the tolerance.
const TOLERANCE_TO_NOISE: f64 = 4.4;

/// Noise is worth up to this share of the reach about a corner, which is half the pen, and for thin lines px.
const NOISE_REACHES: f64 = 0.3;
const LEAST_NOISE_PX: f64 = 0.5;

/// Length over which a line is a parabola, but for noise, px: a bend of 16 px leaves 0.03 px.
const WINDOW_PX: f64 = 13.0;
/// Fewer points than this say nothing about a parabola.
const LEAST_WINDOW: usize = 6;
/// More windows than this do not move their median.
const MOST_WINDOWS: usize = 100;

/// The path through points; where their noise is worth more than the tolerance, the tolerance gives way. `reach_px`
/// is how far about a corner they are not to be trusted, `level` how dark it is at a place.
pub(crate) fn path(
    points: &[Point],
    closed: bool,
    noise_px: f64,
    reach_px: f64,
    level: impl Fn(Point) -> f64,
    options: &Options,
) -> Option<Path> {
    // corners near each other, and tight bends, look like noise
    let noise = (TOLERANCE_TO_NOISE * noise_px).min((NOISE_REACHES * reach_px).max(LEAST_NOISE_PX));
    let tolerance = options.tolerance_px.max(noise);
    let fitted =
        |reach| fit(points, closed, &FitOptions { tolerance, corner_rad: options.corner_rad, reach });
    let margin = 2.0 * tolerance + 1.0 + (2.0 * reach_px).min(6.0);
    // blots make rows so wild that a corner is put where nothing is: then the pen's width is no guide
    let first = fitted(reach_px)?;
    let tame = |path: &Path| stays_near(path, points, margin);
    if tame(&first) {
        // a tight bow looks like a corner, whose points are not to be trusted
        let is_bow = |path: &Path| has_false_corner(path, points, reach_px, options.corner_rad, &level);
        let bow = is_bow(&first).then(|| fitted(options.tolerance_px)).flatten();
        let round = bow.filter(|bow| tame(bow) && !is_bow(bow));
        return Some(round.unwrap_or(first));
    }
    let second = fitted(options.tolerance_px).filter(tame);
    second.or_else(|| Path::polyline(&simplify(points, closed, tolerance), closed))
}

/// Points this far outside a corner, in reaches, belong to no corner: those of one lie inside, for its skeleton is rounded.
const OUTSIDE: f64 = 0.4;

/// At a corner it is at least this share as dark as at the nearest point.
const CORNER_LEVEL: f64 = 1.0 / 3.0;

/// Whether a path has a corner that cuts its points off, or lies off the ink.
fn has_false_corner(
    path: &Path,
    points: &[Point],
    reach: f64,
    corner_rad: f64,
    level: impl Fn(Point) -> f64,
) -> bool {
    /// Samples along either side of a corner.
    const SAMPLES: u32 = 12;
    let pieces: Vec<Piece> = path.pieces().collect();
    let first = path.is_closed().then(|| pieces.first()).flatten();
    let after = pieces.iter().skip(1).chain(first);
    pieces.iter().zip(after).any(|(a, b)| {
        let (into, out) = (a.end_tangent(), b.start_tangent());
        if angle(into, out).abs() < corner_rad {
            return false;
        }
        let at = b.from;
        let share = |piece: &Piece| (3.0 * reach / piece.length(1.0).max(1e-9)).min(1.0) / f64::from(SAMPLES);
        let (before, behind) = (share(a), share(b));
        let side: Vec<Point> = (0..=SAMPLES).rev().map(|k| a.at(1.0 - before * f64::from(k))).collect();
        let sides: Vec<Point> =
            side.into_iter().chain((1..=SAMPLES).map(|k| b.at(behind * f64::from(k)))).collect();
        let inward = (sides[0] - at) + (sides[sides.len() - 1] - at);
        let near = || points.iter().filter(|p| p.distance(at) < 2.0 * reach);
        let nearest = points.iter().min_by(|a, b| a.distance_squared(at).total_cmp(&b.distance_squared(at)));
        let is_off = |p: &Point| level(at) < CORNER_LEVEL * level(*p);
        nearest.is_some_and(is_off)
            || near().any(|p| {
                let nearest =
                    sides.iter().min_by(|a, b| a.distance_squared(*p).total_cmp(&b.distance_squared(*p)));
                let off = *p - *nearest.unwrap_or(&at);
                off.dot(inward) < 0.0 && off.hypot() > OUTSIDE * reach
            })
    })
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

/// The median of windows' scatters over the quarter of them, where all have the same noise.
const QUARTER_TO_MEDIAN: f64 = 1.15;

/// How far points scatter about their line, px: in the median over windows, as their quarter tells it, for of a small
/// star's most have a corner in them. (Not as the calmest tells it, which may be where a line was carried on.)
pub(crate) fn noise_px(points: &[Point]) -> f64 {
    let mut scatters = scatters(points);
    let Some(last) = scatters.len().checked_sub(1) else { return 0.0 };
    let quarter = (scatters.len() / 4).max(1).min(last);
    QUARTER_TO_MEDIAN * *scatters.select_nth_unstable_by(quarter, f64::total_cmp).1
}

/// How far points scatter about the parabola through each of up to [`MOST_WINDOWS`] windows and some, px, root mean square.
fn scatters(points: &[Point]) -> Vec<f64> {
    let spacing = polyline_length(points) / points.len() as f64;
    let window = ((WINDOW_PX / spacing.max(1e-9)) as usize).clamp(LEAST_WINDOW, WINDOW_PX as usize);
    // three points of each window are the parabola's own
    let own = (window as f64 / (window - 3) as f64).sqrt();
    let rms = |window: &[Point]| Parabola::through(measured(window, 0)).map(|p| own * p.rms);
    let stride = (points.len() / MOST_WINDOWS).max(4);
    points.windows(window).step_by(stride).filter_map(rms).collect()
}
