//! How well one drawing matches another.

mod matching;
mod score;
mod segments;

use kurbo::Point;

use crate::Drawing;
use segments::Segments;

pub use score::{Score, score, score_polylines};

/// Samples in one tolerance along a line: a stretch that is just out of tolerance is then found to a tenth.
const SAMPLES_PER_TOLERANCE: f64 = 10.0;

/// Samples of one side at most, so that a tiny tolerance on a huge drawing ends.
const MOST_SAMPLES: f64 = 2e6;

/// How well what was drawn matches the truth. Lengths in plane units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Distance of the drawn line to the truth, root of the mean square along it.
    pub rms: f64,
    /// What 99 % of it are nearer than.
    pub p99: f64,
    /// The largest.
    pub max: f64,
    /// Share of the truth's length that lies within the tolerance of the drawn line.
    pub coverage: f64,
    /// Share of the drawn length that lies within the tolerance of the truth.
    pub precision: f64,
    /// Drawn length over the truth's.
    pub length_ratio: f64,
}

/// Compares drawn polylines with a drawing's strokes, whose curves are followed to a hundredth of `tolerance`.
///
/// Both are sampled evenly along their length; distances to the other side are exact. `None` if either has no
/// length: nothing can be said of it then.
pub fn compare(drawn: &[Vec<Point>], truth: &Drawing, tolerance: f64) -> Option<Comparison> {
    compare_polylines(drawn, &polylines(truth, tolerance), tolerance)
}

/// A drawing's strokes as polylines, to a hundredth of `tolerance`.
fn polylines(drawing: &Drawing, tolerance: f64) -> Vec<Vec<Point>> {
    drawing.strokes.iter().map(|s| s.path.flatten(0.01 * tolerance)).collect()
}

/// [`compare`] for two sets of polylines.
pub fn compare_polylines(drawn: &[Vec<Point>], truth: &[Vec<Point>], tolerance: f64) -> Option<Comparison> {
    let (drawn_length, truth_length) = (length(drawn), length(truth));
    // a length that is not a number is none either
    let measurable = drawn_length > 0.0 && truth_length > 0.0 && (drawn_length + truth_length).is_finite();
    if !measurable {
        return None;
    }
    let mut off_truth = Spread::of(drawn, &Segments::of(truth), tolerance, drawn_length);
    let off_drawn = Spread::of(truth, &Segments::of(drawn), tolerance, truth_length);
    Some(Comparison {
        rms: off_truth.rms(),
        p99: off_truth.p99(),
        max: off_truth.distances.iter().copied().fold(0.0, f64::max),
        coverage: off_drawn.within,
        precision: off_truth.within,
        length_ratio: drawn_length / truth_length,
    })
}

fn length(polylines: &[Vec<Point>]) -> f64 {
    polylines.iter().flat_map(|line| line.windows(2)).map(|w| w[0].distance(w[1])).sum()
}

/// Distances of evenly spaced samples.
struct Spread {
    distances: Vec<f64>,
    /// Share of them that are within the tolerance.
    within: f64,
}

impl Spread {
    fn of(lines: &[Vec<Point>], to: &Segments, tolerance: f64, length: f64) -> Self {
        let wished = (length / tolerance * SAMPLES_PER_TOLERANCE).clamp(1000.0, MOST_SAMPLES);
        let step = length / wished.round();
        let mut distances = Vec::with_capacity(wished as usize + 1);
        // the samples lie in the middles of equal steps, counted through all lines as if they were one
        let mut next = 0.5 * step;
        for pair in lines.iter().flat_map(|line| line.windows(2)) {
            let piece = pair[0].distance(pair[1]);
            while next < piece {
                distances.push(to.distance(pair[0].lerp(pair[1], next / piece)));
                next += step;
            }
            next -= piece;
        }
        let within = distances.iter().filter(|distance| **distance <= tolerance).count() as f64;
        Self { within: within / distances.len() as f64, distances }
    }

    fn rms(&self) -> f64 {
        (self.distances.iter().map(|d| d * d).sum::<f64>() / self.distances.len() as f64).sqrt()
    }

    fn p99(&mut self) -> f64 {
        let place = (0.99 * self.distances.len() as f64) as usize;
        if place >= self.distances.len() {
            0.0
        } else {
            *self.distances.select_nth_unstable_by(place, f64::total_cmp).1
        }
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

    fn check(found: f64, expected: f64, within: f64) {
        assert!((found - expected).abs() <= within, "{found}, expected {expected}");
    }

    #[test]
    fn a_drawing_matches_itself() {
        let lines = [line(&[(0., 0.), (1., 0.), (1., 2.)]), line(&[(5., 5.), (4., 4.)])];
        let found = compare_polylines(&lines, &lines, 1e-3).unwrap();
        let exact =
            Comparison { rms: 0.0, p99: 0.0, max: 0.0, coverage: 1.0, precision: 1.0, length_ratio: 1.0 };
        assert_eq!(found, exact);
    }

    #[test]
    fn a_shifted_line_is_off_by_its_shift() {
        let found = compare_polylines(&[line(&[(0., 0.1), (1., 0.1)])], &[line(&[(0., 0.), (1., 0.)])], 0.01)
            .unwrap();
        check(found.rms, 0.1, 1e-12);
        check(found.max, 0.1, 1e-12);
        check(found.p99, 0.1, 1e-12);
        assert_eq!((found.coverage, found.precision), (0.0, 0.0));
    }

    #[test]
    fn one_sample_in_a_hundred_may_be_further_off_than_p99() {
        // a tenth off along 99 parts of the way, one off along 1; and one more part of it
        let truth = [line(&[(0., 0.), (100., 0.)])];
        let drawn = |far: f64| [line(&[(0., 0.1), (100. - far, 0.1)]), line(&[(100. - far, 1.), (100., 1.)])];
        check(compare_polylines(&drawn(0.9), &truth, 0.01).unwrap().p99, 0.1, 1e-9);
        check(compare_polylines(&drawn(1.1), &truth, 0.01).unwrap().p99, 1.0, 1e-9);
    }

    #[test]
    fn half_a_line_covers_half_and_strays_nowhere() {
        let found = compare_polylines(&[line(&[(0., 0.), (0.5, 0.)])], &[line(&[(0., 0.), (1., 0.)])], 0.01);
        let found = found.unwrap();
        check(found.coverage, 0.51, 1e-3);
        check(found.precision, 1.0, 0.0);
        check(found.length_ratio, 0.5, 1e-12);
    }

    #[test]
    fn a_stray_line_lowers_the_precision_only() {
        let truth = [line(&[(0., 0.), (3., 0.)])];
        let drawn = [line(&[(3., 0.), (0., 0.)]), line(&[(0., 9.), (1., 9.)])];
        let found = compare_polylines(&drawn, &truth, 0.1).unwrap();
        check(found.precision, 0.75, 1e-3);
        check(found.coverage, 1.0, 0.0);
        check(found.max, 9.0, 1e-9);
        check(found.rms, (0.25_f64 * 81.0).sqrt(), 1e-2);
    }

    #[test]
    fn curves_are_followed_far_below_the_tolerance() {
        let mut circle = Path::new(Point::new(1.0, 0.0));
        circle.push(Element::Arc { centre: Point::ORIGIN, sweep: TAU });
        circle.close();
        let drawn = [circle.flatten(1e-9)];
        let truth = Drawing { strokes: vec![Stroke::new(circle)] };
        let found = compare(&drawn, &truth, 1e-2).unwrap();
        assert!(found.max < 1e-4 && found.coverage == 1.0, "{found:?}");
    }

    #[test]
    fn distances_agree_with_the_slow_way() {
        let mut random = 1_u64;
        let mut next = || {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (random >> 40) as f64 / f64::from(1 << 24)
        };
        let lines: Vec<_> =
            (0..200).map(|_| line(&[(next(), next()), (next(), next()), (next(), next())])).collect();
        let tree = Segments::of(&lines);
        for _ in 0..200 {
            let at = Point::new(3.0 * next() - 1.0, 3.0 * next() - 1.0);
            let one_by_one = lines.iter().map(|l| Segments::of(std::slice::from_ref(l)).distance(at));
            check(tree.distance(at), one_by_one.fold(f64::INFINITY, f64::min), 1e-15);
        }
    }

    #[test]
    fn nothing_can_be_said_of_nothing() {
        let one = [line(&[(0., 0.), (1., 0.)])];
        let point = [line(&[(0., 0.)])];
        let nan = [line(&[(0., 0.), (f64::NAN, 0.)])];
        let huge = [line(&[(-1e308, 0.), (1e308, 0.)])];
        for other in [&[][..], &point, &nan, &huge] {
            assert_eq!(compare_polylines(&one, other, 0.1), None);
            assert_eq!(compare_polylines(other, &one, 0.1), None);
        }
        assert!(compare_polylines(&one, &one, 1e-300).is_some());
    }
}
