//! Directions beside a sample, from runs of samples one step apart.

use kurbo::{Point, Vec2};

use super::samples::Samples;
use super::window::{is_believed, unit};

/// A parabola by least squares through so many samples one step apart, and its direction some way off.
///
/// Where the samples are even, the polynomials that are orthogonal on them are the same for every run (Gram's): what
/// is left are three sums.
pub(super) struct Flanks {
    gap: usize,
    length: usize,
    /// Of each sample: its place from the run's middle, and that squared less its mean; in steps.
    weights: Vec<[f64; 2]>,
    /// Sums of the squared weights.
    norms: [f64; 2],
}

impl Flanks {
    /// Of `length` samples, from `gap` samples off on.
    pub(super) fn new(gap: usize, length: usize) -> Self {
        let n = length as f64;
        let mean = (n * n - 1.0) / 12.0;
        let weight = |k: usize| {
            let from_middle = k as f64 - 0.5 * (n - 1.0);
            [from_middle, from_middle * from_middle - mean]
        };
        let weights: Vec<[f64; 2]> = (0..length).map(weight).collect();
        let norm = |which: usize| weights.iter().map(|w| w[which] * w[which]).sum();
        Self { gap, length, norms: [norm(0), norm(1)], weights }
    }

    /// The line's direction at sample `i`, by what lies behind it (`side` −1) or ahead (1); `None` where too little does.
    pub(super) fn tangent(&self, samples: &Samples, i: usize, side: isize) -> Option<Vec2> {
        let first = if side > 0 { Some(i + self.gap) } else { (i + 1).checked_sub(self.gap + self.length) };
        match first.and_then(|first| samples.points.get(first..first + self.length)) {
            Some(run) => Some(self.direction(run, -side as f64)),
            // round the seam, or at an open end
            None => Some(samples.flank(i, side, self.gap, self.length)?.tangent(0.0)),
        }
    }

    /// Direction of a run's parabola ahead of its last sample (`way` 1) or behind its first (−1), the gap away.
    fn direction(&self, run: &[Point], way: f64) -> Vec2 {
        let n = self.length as f64;
        let (mut sum, mut slope, mut bend, mut square) = (Vec2::ZERO, Vec2::ZERO, Vec2::ZERO, 0.0);
        for (&p, [linear, squared]) in run.iter().zip(&self.weights) {
            let v = p - run[0];
            (sum, slope, bend) = (sum + v, slope + v * *linear, bend + v * *squared);
            square += v.hypot2();
        }
        let of_line = (square - sum.hypot2() / n - slope.hypot2() / self.norms[0]).max(0.0);
        let gain = bend.hypot2() / self.norms[1];
        let off = way * (self.gap as f64 + 0.5 * (n - 1.0));
        let turned = if is_believed(n, gain, (of_line - gain).max(0.0)) { 2.0 * off } else { 0.0 };
        unit(slope / self.norms[0] + bend * (turned / self.norms[1]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_runs_lead_where_their_parabolas_do() {
        let wave = |k: u32| {
            let x = f64::from(k);
            Point::new(x + 0.1 * (1.7 * x).sin(), 9.0 * (0.08 * x).sin() + 0.1 * (2.3 * x).cos())
        };
        let row: Vec<Point> = (0..120).map(wave).collect();
        let samples = Samples::of(&row, false, 1.1).unwrap();
        for (gap, length) in [(2, 6), (5, 13), (9, 24)] {
            let flanks = Flanks::new(gap, length);
            for i in 0..samples.len() {
                for side in [-1, 1] {
                    let found = flanks.tangent(&samples, i, side);
                    let slow = samples.flank(i, side, gap, length).map(|p| p.tangent(0.0));
                    let alike = match (found, slow) {
                        (Some(a), Some(b)) => a.dot(b) > 1.0 - 1e-9,
                        (a, b) => a.is_none() && b.is_none(),
                    };
                    assert!(alike, "{i} {side}: {found:?} {slow:?}");
                }
            }
        }
    }
}
