//! Fits a curved section with few cubics that share their tangents at the joints.

use kurbo::{CubicBez, Point, Vec2};

use super::cubic::{self, Ends};
use super::window::{Parabola, turn, unit};

/// Samples either side from which a joint's place and direction are taken: as many as lie on a parabola.
const WINDOWS: [usize; 6] = [7, 10, 14, 20, 28, 40];
/// Samples in such a window on both sides, with the sample itself.
const BOTH: [usize; 6] = [15, 21, 29, 41, 57, 81];
/// Directions are looked at this often, in steps; between, the turning is even.
const STRIDE: usize = 6;

/// More turn than this in one cubic makes its curvature uneven, rad (100°).
const MOST_TURN: f64 = 1.75;

/// Cubics through `points` from end to end, nowhere further off than `tolerance` where that is possible.
///
/// The joints share out the turning evenly; a cubic that is too far off is cut in two. `points` lie strictly
/// between the ends.
pub(super) fn through(points: &[Point], ends: &Ends, tolerance: f64) -> Vec<CubicBez> {
    let row = Row::of([&[ends.from], points, &[ends.to]].concat(), 0.3 * tolerance);
    let turned: f64 = row.weights.iter().sum::<f64>() / (1.0 + EVEN);
    let least = ((turned / MOST_TURN).ceil() as usize).clamp(1, row.points.len() / SHORTEST + 1);
    let mut joints: Vec<usize> =
        (1..least).map(|k| row.share(0, row.last(), k as f64 / least as f64)).collect();
    joints.dedup();
    let mut stops = vec![Stop { index: 0, at: ends.from, along: ends.leaving }];
    stops.extend(joints.into_iter().filter_map(|i| row.stop(i)));
    stops.push(Stop { index: row.last(), at: ends.to, along: ends.arriving });
    let mut chain = Vec::new();
    stops.windows(2).for_each(|w| row.fit(&w[0], &w[1], tolerance, &mut chain));
    chain
}

/// Where two cubics meet.
struct Stop {
    index: usize,
    at: Point,
    along: Vec2,
}

/// Share of the turning that is spread evenly over the length, so that straight stretches get joints too.
const EVEN: f64 = 0.2;

/// Fewest steps in one cubic.
const SHORTEST: usize = 4;

/// Points from end to end of a curved stretch.
struct Row {
    points: Vec<Point>,
    /// Arc length at each point.
    lengths: Vec<f64>,
    /// What each step counts when the stretch is shared out: its turning, rad, and some of its length.
    weights: Vec<f64>,
    /// How far samples may be from a parabola that stands for them, root mean square.
    rms: f64,
}

impl Row {
    fn of(points: Vec<Point>, rms: f64) -> Self {
        let lengths = arc_lengths(&points);
        let mut row = Self { points, lengths, weights: Vec::new(), rms };
        let stops: Vec<usize> = (0..row.last()).step_by(STRIDE).chain([row.last()]).collect();
        let tangent = |&i: &usize| row.local(i).map_or_else(Vec2::default, |p| p.tangent(row.lengths[i]));
        let tangents: Vec<Vec2> = stops.iter().map(tangent).collect();
        let mut bends = Vec::with_capacity(row.points.len());
        for (ends, way) in stops.windows(2).zip(tangents.windows(2)) {
            let steps = ends[1] - ends[0];
            bends.extend(std::iter::repeat_n(turn(way[0], way[1]).abs() / steps as f64, steps));
        }
        let even = EVEN * bends.iter().sum::<f64>().max(1e-9) / row.lengths[row.last()].max(1e-300);
        let steps = row.lengths.windows(2).map(|w| w[1] - w[0]);
        row.weights = bends.iter().zip(steps).map(|(bend, step)| bend + even * step).collect();
        row
    }

    fn last(&self) -> usize {
        self.points.len() - 1
    }

    /// The parabola about point `i`.
    fn local(&self, i: usize) -> Option<Parabola> {
        // outwards, both sides in turn; near an end the other side goes on alone
        let both = i.min(self.last() - i);
        let outwards = |k: usize| match k {
            _ if k > 2 * both && both < i => i + both - k,
            _ if k > 2 * both => i + k - both,
            _ if k % 2 == 1 => i - k.div_ceil(2),
            _ => i + k / 2,
        };
        let samples = (0..self.points.len()).map(outwards).map(|k| (self.lengths[k], self.points[k]));
        Parabola::widest(samples, &BOTH, self.rms)
    }

    /// The point strictly between two others before which this share of the weights between them lies.
    fn share(&self, from: usize, to: usize, share: f64) -> usize {
        let due = share * self.weights[from..to].iter().sum::<f64>();
        let mut passed = 0.0;
        let reached = self.weights[from..to].iter().position(|w| {
            passed += w;
            passed >= due
        });
        let at = from + 1 + reached.unwrap_or(0);
        at.clamp(from + 2, to.max(4) - 2).clamp(from + 1, to.max(from + 2) - 1)
    }

    /// The joint at a point.
    fn stop(&self, index: usize) -> Option<Stop> {
        let local = self.local(index)?;
        let length = self.lengths[index];
        Some(Stop { index, at: local.point(length), along: local.tangent(length) })
    }

    /// Adds the cubic from stop to stop, or those of its halves where it is too far off.
    fn fit(&self, from: &Stop, to: &Stop, tolerance: f64, chain: &mut Vec<CubicBez>) {
        let ends = Ends { from: from.at, leaving: from.along, to: to.at, arriving: to.along };
        let (curve, off) = cubic::through(&self.points[from.index + 1..to.index], &ends, tolerance);
        let is_long = to.index - from.index >= 2 * SHORTEST;
        let cut = || self.stop(self.share(from.index, to.index, 0.5));
        match if off > tolerance && is_long { cut() } else { None } {
            Some(middle) => {
                self.fit(from, &middle, tolerance, chain);
                self.fit(&middle, to, tolerance, chain);
            }
            None => chain.push(curve),
        }
    }
}

fn arc_lengths(row: &[Point]) -> Vec<f64> {
    let mut passed = 0.0;
    let steps = row.windows(2).map(|w| {
        passed += w[0].distance(w[1]);
        passed
    });
    [0.0].into_iter().chain(steps).collect()
}

/// Direction in which a row leaves its first point; samples count as on a parabola up to `rms` from it.
pub(super) fn leaving(row: &[Point], rms: f64) -> Vec2 {
    let lengths = arc_lengths(&row[..row.len().min(2 * WINDOWS[WINDOWS.len() - 1])]);
    let samples = lengths.iter().copied().zip(row.iter().copied());
    let along = Parabola::widest(samples, &WINDOWS.map(|half| 2 * half), rms);
    along.map_or_else(|| unit(row[row.len() - 1] - row[0]), |p| p.tangent(0.0))
}
