use std::collections::BTreeMap;

use kurbo::Point;

use super::matching::most_pairs;
use super::segments::{Foot, Segments};
use super::{length, polylines};
use crate::{Drawing, polyline_length};

/// Share of a true stroke that one drawn stroke must cover, and share of the drawn one that must lie on it, for the two
/// to match.
const MATCHED_SHARE: f64 = 0.9;

/// A drawn stroke longer than this many times the true one goes over it more than once.
const LONGEST_MATCH: f64 = 1.5;

/// Samples in one tolerance along a line.
const SAMPLES_PER_TOLERANCE: f64 = 4.0;

/// Samples of a stroke at least, so that shares of a short one mean something.
const LEAST_SAMPLES: f64 = 50.0;

/// Samples of one side at most, so that a tiny tolerance on a huge drawing ends.
const MOST_SAMPLES: f64 = 2e6;

/// Tolerances in a bin along the truth, in which drawn length is counted: a bin holds more than its own length where
/// something was drawn twice.
const TOLERANCES_PER_BIN: f64 = 4.0;

/// Drawn length in a bin from which on it counts as doubled. A pixel staircase has √2; a stroke that ends a tolerance
/// beyond the truth's end has 1.25.
const DOUBLED_BIN: f64 = 1.5;

/// Agreement of drawn strokes with true strokes. Lengths in plane units, shares in [0, 1].
///
/// [`Comparison`](super::Comparison) asks whether the same ink was drawn; this also asks whether it was drawn in the
/// same strokes. Counts alone cannot tell: one stroke broken and another one missing leave them right, so
/// [`matched`](Self::matched) pairs them off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Score {
    /// Strokes drawn.
    pub drawn: usize,
    /// Strokes there are.
    pub truth: usize,
    /// True strokes with a drawn stroke of their own: it covers nine tenths of the true one, lies to nine tenths on it,
    /// and is at most half as long again.
    pub matched: usize,
    /// Distance of the drawn strokes to the truth, root of the mean square along them.
    pub rms: f64,
    /// Largest distance of the drawn strokes to the truth.
    pub max: f64,
    /// Share of the truth's length that is further than the tolerance from everything drawn.
    pub missed: f64,
    /// Share of the drawn length that is further than the tolerance from the truth: false strokes.
    pub stray: f64,
    /// Length drawn again where the truth was already drawn, over the truth's length; more than 1 if drawn thrice.
    pub doubled: f64,
    /// Drawn length over the truth's.
    pub length_ratio: f64,
}

impl Score {
    /// Whether each true stroke has one drawn stroke of its own and nothing else was drawn.
    pub const fn is_right(&self) -> bool {
        self.matched == self.truth && self.drawn == self.truth
    }
}

/// Scores drawn strokes against the true ones. Curves are followed to a hundredth of `tolerance`.
///
/// Both are sampled evenly along their length; distances to the other side are exact. `None` if either has no length,
/// or one that is no number.
pub fn score(drawn: &Drawing, truth: &Drawing, tolerance: f64) -> Option<Score> {
    score_polylines(&polylines(drawn, tolerance), &polylines(truth, tolerance), tolerance)
}

/// [`score`] for two sets of polylines, each of which is a stroke. A closed one repeats its first point.
pub fn score_polylines(drawn: &[Vec<Point>], truth: &[Vec<Point>], tolerance: f64) -> Option<Score> {
    let (drawn_length, truth_length) = (length(drawn), length(truth));
    let measurable = drawn_length > 0.0 && truth_length > 0.0 && (drawn_length + truth_length).is_finite();
    if !measurable {
        return None;
    }
    let (on_drawn, on_truth) = (Segments::of(drawn), Segments::of(truth));
    let mut laps = Laps::new(truth, tolerance);
    let forth = Walk::of(drawn, &on_truth, tolerance, |foot, step| laps.add(foot, step));
    let back = Walk::of(truth, &on_drawn, tolerance, |_, _| ());
    Some(Score {
        drawn: drawn.len(),
        truth: truth.len(),
        matched: matched(&forth, &back, drawn, truth),
        rms: (forth.squares / drawn_length).sqrt(),
        max: forth.largest_sq.sqrt(),
        missed: back.beyond / truth_length,
        stray: forth.beyond / drawn_length,
        doubled: laps.doubled() / truth_length,
        length_ratio: drawn_length / truth_length,
    })
}

/// What a walk along the lines of one side saw of the other.
#[derive(Default)]
struct Walk {
    /// Distance squared, times length.
    squares: f64,
    largest_sq: f64,
    /// Length further away than the tolerance.
    beyond: f64,
    /// Length of a line of this side (first) that is within the tolerance of a line of the other.
    shared: BTreeMap<(usize, usize), f64>,
}

impl Walk {
    /// Walks along `lines`; `each` is told where the walk is nearest to within the tolerance, and for what length.
    fn of(lines: &[Vec<Point>], to: &Segments, tolerance: f64, mut each: impl FnMut(Foot, f64)) -> Self {
        let spacing = (tolerance / SAMPLES_PER_TOLERANCE).max(length(lines) / MOST_SAMPLES);
        let mut walk = Self::default();
        let mut near = Vec::new();
        for (number, line) in lines.iter().enumerate() {
            for_samples(line, spacing, |at, step| {
                let Some(foot) = to.nearest(at) else { return };
                walk.squares += foot.distance_sq * step;
                walk.largest_sq = walk.largest_sq.max(foot.distance_sq);
                if foot.distance_sq > tolerance * tolerance {
                    walk.beyond += step;
                    return;
                }
                each(foot, step);
                to.lines_near(at, tolerance, &mut near);
                near.iter().for_each(|&other| *walk.shared.entry((number, other)).or_default() += step);
            });
        }
        walk
    }
}

/// Calls `each` with the middles of equal steps along a line, and the step.
fn for_samples(line: &[Point], spacing: f64, mut each: impl FnMut(Point, f64)) {
    let whole = polyline_length(line);
    let step = whole / (whole / spacing).max(LEAST_SAMPLES).ceil();
    let mut next = 0.5 * step;
    for pair in line.windows(2) {
        let piece = pair[0].distance(pair[1]);
        while next < piece {
            each(pair[0].lerp(pair[1], next / piece), step);
            next += step;
        }
        next -= piece;
    }
}

/// True strokes that have a drawn stroke of their own.
fn matched(forth: &Walk, back: &Walk, drawn: &[Vec<Point>], truth: &[Vec<Point>]) -> usize {
    let lengths = |lines: &[Vec<Point>]| -> Vec<f64> {
        lines.iter().map(|line| length(std::slice::from_ref(line))).collect()
    };
    let (drawn_lengths, truth_lengths) = (lengths(drawn), lengths(truth));
    let mut likes = vec![Vec::new(); truth.len()];
    for (&(true_one, drawn_one), &covered) in &back.shared {
        let (of_truth, of_drawn) = (truth_lengths[true_one], drawn_lengths[drawn_one]);
        let on_it = forth.shared.get(&(drawn_one, true_one)).copied().unwrap_or(0.0);
        let fits = covered >= MATCHED_SHARE * of_truth && on_it >= MATCHED_SHARE * of_drawn;
        if fits && of_drawn <= LONGEST_MATCH * of_truth {
            likes[true_one].push(drawn_one);
        }
    }
    most_pairs(&likes, drawn.len())
}

/// How often each stretch of the truth was drawn: drawn length in bins along it.
struct Laps {
    /// For each line: the length of one of its bins, and the drawn length in each.
    bins: Vec<(f64, Vec<f64>)>,
}

impl Laps {
    fn new(truth: &[Vec<Point>], tolerance: f64) -> Self {
        let wished = (tolerance * TOLERANCES_PER_BIN).max(length(truth) / MOST_SAMPLES);
        let bins = truth.iter().map(|line| {
            let whole = length(std::slice::from_ref(line));
            let count = (whole / wished).max(1.0).floor();
            (whole / count, vec![0.0; count as usize])
        });
        Self { bins: bins.collect() }
    }

    fn add(&mut self, foot: Foot, step: f64) {
        let (bin, drawn) = &mut self.bins[foot.line];
        let last = drawn.len() - 1;
        drawn[((foot.along / *bin) as usize).min(last)] += step;
    }

    /// Length beyond one lap, where there is clearly more than one.
    fn doubled(&self) -> f64 {
        let bins = self.bins.iter().flat_map(|(bin, drawn)| drawn.iter().map(move |d| (bin, d)));
        // summed from zero: the sum of no floats is −0
        bins.filter(|&(bin, d)| *d > DOUBLED_BIN * bin).fold(0.0, |sum, (bin, d)| sum + d - bin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Element, Path, Stroke};
    use std::f64::consts::TAU;

    fn line(points: &[(f64, f64)]) -> Vec<Point> {
        points.iter().map(|&p| p.into()).collect()
    }

    /// A cross, a tick and a line apart.
    fn truth() -> Vec<Vec<Point>> {
        vec![
            line(&[(0., 0.), (100., 100.)]),
            line(&[(0., 100.), (100., 0.)]),
            line(&[(150., 0.), (150., 50.), (200., 50.)]),
            line(&[(0., 200.), (200., 200.)]),
        ]
    }

    /// Scores what is drawn against [`truth`] at a tolerance of 2.
    fn check(drawn: &[Vec<Point>]) -> Score {
        score_polylines(drawn, &truth(), 2.0).unwrap()
    }

    fn near(found: f64, expected: f64, within: f64) {
        assert!((found - expected).abs() <= within, "{found}, expected {expected}");
    }

    #[test]
    fn the_truth_is_right_in_any_order_and_direction() {
        let mut drawn = truth();
        drawn.reverse();
        drawn[1].reverse();
        let found = check(&drawn);
        assert!(found.is_right(), "{found:?}");
        near(found.max, 0.0, 1e-6);
        assert_eq!((found.missed, found.stray, found.doubled), (0.0, 0.0, 0.0));
        near(found.length_ratio, 1.0, 1e-12);
    }

    #[test]
    fn a_shift_within_the_tolerance_is_right_and_measured() {
        let shifted =
            truth().into_iter().map(|l| l.into_iter().map(|p| p + kurbo::Vec2::new(0.0, 0.3)).collect());
        let found = check(&shifted.collect::<Vec<_>>());
        assert!(found.is_right());
        assert!((0.2..=0.3).contains(&found.rms), "{found:?}");
        near(found.max, 0.3, 1e-9);
    }

    #[test]
    fn a_stroke_drawn_twice_is_doubled_and_not_right() {
        let mut drawn = truth();
        drawn.push(line(&[(200., 200.5), (0., 200.5)]));
        let found = check(&drawn);
        assert_eq!((found.drawn, found.matched), (5, 4));
        near(found.doubled, 200. / 582.84, 1e-3);
        assert!(!found.is_right());
    }

    #[test]
    fn a_stroke_drawn_there_and_back_is_doubled_and_unmatched() {
        let mut drawn = truth();
        drawn[3] = line(&[(0., 200.), (200., 200.), (0., 200.)]);
        let found = check(&drawn);
        assert_eq!((found.drawn, found.matched), (4, 3));
        near(found.doubled, 200. / 582.84, 1e-3);
    }

    #[test]
    fn a_part_drawn_again_counts_for_its_length() {
        let mut drawn = truth();
        drawn.push(line(&[(40., 200.), (120., 200.)]));
        near(check(&drawn).doubled, 80. / 582.84, 8. / 582.84);
    }

    #[test]
    fn both_sides_of_a_pen_line_are_doubled() {
        let sides = line(&[(0., 199.), (200., 199.), (200., 201.), (0., 201.), (0., 199.)]);
        let found = score_polylines(&[sides], &truth()[3..], 2.0).unwrap();
        assert_eq!(found.matched, 0);
        near(found.doubled, 1.0, 0.05);
    }

    #[test]
    fn a_broken_stroke_is_unmatched_though_all_ink_is_covered() {
        let mut drawn = truth();
        drawn[3] = line(&[(0., 200.), (110., 200.)]);
        drawn.push(line(&[(110., 200.), (200., 200.)]));
        let found = check(&drawn);
        assert_eq!((found.drawn, found.matched), (5, 3));
        assert_eq!((found.missed, found.stray, found.doubled), (0.0, 0.0, 0.0));
    }

    #[test]
    fn a_missing_stroke_is_missed_and_unmatched() {
        let found = check(&truth()[..3]);
        assert_eq!((found.drawn, found.matched), (3, 3));
        near(found.missed, 200. / 582.84, 1e-3);
        assert!(!found.is_right());
    }

    #[test]
    fn a_false_stroke_is_stray_and_not_right() {
        let mut drawn = truth();
        drawn.push(line(&[(0., 300.), (50., 300.)]));
        let found = check(&drawn);
        assert_eq!((found.drawn, found.matched), (5, 4));
        near(found.stray, 50. / 632.84, 1e-3);
        near(found.max, 100.0, 1e-6);
        assert!(!found.is_right());
    }

    #[test]
    fn one_broken_and_one_missing_do_not_look_right() {
        let mut drawn = truth();
        drawn[2] = line(&[(0., 200.), (100., 200.)]);
        drawn[3] = line(&[(100., 200.), (200., 200.)]);
        let found = check(&drawn);
        assert_eq!(found.drawn, found.truth);
        assert_eq!(found.matched, 2);
        assert!(!found.is_right());
    }

    #[test]
    fn merged_strokes_are_unmatched() {
        let mut drawn = truth();
        // the cross as two bent strokes: >< instead of X
        drawn[0] = line(&[(0., 0.), (50., 50.), (0., 100.)]);
        drawn[1] = line(&[(100., 0.), (50., 50.), (100., 100.)]);
        let bent = check(&drawn);
        assert_eq!((bent.drawn, bent.matched), (4, 2));
        assert_eq!((bent.missed, bent.stray), (0.0, 0.0));

        // and as one stroke through all four arms
        drawn[0] = line(&[(0., 0.), (100., 100.), (100., 0.), (0., 100.)]);
        drawn.remove(1);
        assert_eq!(check(&drawn).matched, 2);
    }

    #[test]
    fn a_closed_stroke_may_begin_anywhere() {
        let circle = |from: f64| {
            let mut path = Path::new(Point::new(from.cos() * 20.0, from.sin() * 20.0));
            path.push(Element::Arc { centre: Point::ORIGIN, sweep: TAU });
            path.close();
            Drawing { strokes: vec![Stroke::new(path)] }
        };
        let found = score(&circle(1.0), &circle(4.0), 1.0).unwrap();
        assert!(found.is_right() && found.max < 0.02, "{found:?}");
    }

    #[test]
    fn nothing_can_be_scored_against_nothing() {
        let nan = [line(&[(0., 0.), (f64::NAN, 0.)])];
        for other in [&[][..], &nan] {
            assert_eq!(score_polylines(&truth(), other, 2.0), None);
            assert_eq!(score_polylines(other, &truth(), 2.0), None);
        }
        assert!(score_polylines(&truth(), &truth(), 1e-300).is_some());
    }
}
