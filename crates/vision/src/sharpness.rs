//! Measures the sharpness of a picture's edges.

use tracelight_image::median::median;
use tracelight_image::threshold::word_over;
use tracelight_image::{Plane, ink_runs};
use tracelight_maths::hypot;

/// Rows, and columns, that are looked at: of 720 rows every fifteenth crosses each longer stroke, in 0.1 ms.
const LINES: usize = 48;
/// Edges that tell: the median of more would move by less than a tenth of its scatter.
const ENOUGH: usize = 400;
/// With fewer there is no telling.
const LEAST: usize = 6;
/// How far either way an edge is followed, px: blurred more it would be no edge of a drawing.
const REACH: usize = 32;

/// What an edge is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    /// Level between paper and ink.
    pub(crate) threshold: u8,
    /// Least step from paper to ink, levels: half the usual one leaves out dust and the faint end of shadows.
    pub(crate) least: f64,
    /// Rise that is only noise, levels.
    pub(crate) noise: f64,
}

/// Median width of the edges between paper and ink, from 10 % to 90 % of their step, px, measured along sampled rows
/// and columns and projected on the edge's normal, so that a slant makes no edge wider.
pub(crate) fn edge_px(darkness: &Plane<u8>, step: Step) -> Option<f64> {
    let (w, h) = (darkness.width, darkness.height);
    let rows = lines(h).map(|y| Lane { plane: darkness, first: y * w, along: 1, across: w, length: w });
    let columns = lines(w).map(|x| Lane { plane: darkness, first: x, along: w, across: 1, length: h });
    let mut widths = Vec::new();
    for side in [rows.collect::<Vec<_>>(), columns.collect()] {
        let from = widths.len();
        for lane in side {
            lane.measure(step, &mut widths);
            if widths.len() > from + ENOUGH {
                break;
            }
        }
    }
    (widths.len() >= LEAST).then(|| median(&widths))
}

/// Up to [`LINES`] of `n` lines, none of them at a border, in an order that is spread at any time.
fn lines(n: usize) -> impl Iterator<Item = usize> {
    let count = LINES.min(n.saturating_sub(2));
    // 29 and 48 have no common divisor
    let turn = if count == LINES { 29 } else { 1 };
    (0..count).map(move |k| 1 + (k * turn % count) * (n - 2) / count)
}

/// A row or a column of pixels.
struct Lane<'a> {
    plane: &'a Plane<u8>,
    first: usize,
    /// To its next pixel.
    along: usize,
    /// To the next lane's pixel.
    across: usize,
    length: usize,
}

impl Lane<'_> {
    fn at(&self, k: usize) -> u8 {
        self.plane.values[self.first + k * self.along]
    }

    /// Adds the widths of the edges along it.
    fn measure(&self, step: Step, widths: &mut Vec<f64>) {
        let levels = self.plane.values[self.first..].iter().step_by(self.along).take(self.length);
        let levels: Vec<u8> = levels.copied().collect();
        let words: Vec<u64> = levels.chunks(64).map(|levels| word_over(levels, step.threshold)).collect();
        let mut runs = Vec::new();
        ink_runs(&words, 0, &mut runs);
        for run in runs {
            let (from, to) = (run.from as usize, run.to as usize);
            // either end of the ink that has paper beyond it
            let ends = [(from > 0).then(|| (from - 1, from)), (to < self.length).then(|| (to, to - 1))];
            for (paper, ink) in ends.into_iter().flatten() {
                let cosine = self.cosine(paper, ink);
                if cosine > std::f64::consts::FRAC_1_SQRT_2 {
                    widths.extend(self.edge(paper, ink, step).map(|width| width * cosine));
                }
            }
        }
    }

    /// Width of the edge between two neighbours along the lane; `None` of one that is too faint, or runs along it.
    fn edge(&self, paper: usize, ink: usize, step: Step) -> Option<f64> {
        let out = self.walk(paper, ink, -1.0, step.noise);
        let inwards = self.walk(ink, paper, 1.0, step.noise);
        let (foot, top) = (-out.furthest, inwards.furthest);
        if top - foot < step.least {
            return None;
        }
        let (low, high) = (foot + 0.1 * (top - foot), foot + 0.9 * (top - foot));
        // both are counted from the two pixels between which the threshold lies, which are 1 px apart
        Some(out.reaches(-inwards.levels[0], -low)? + inwards.reaches(-out.levels[0], high)? + 1.0)
    }

    /// Levels, times `sign`, from pixel `from` on, away from pixel `other`, for as long as they go on rising.
    fn walk(&self, from: usize, other: usize, sign: f64, noise: f64) -> Walk {
        let mut walk = Walk { levels: [0.0; REACH], count: 0, furthest: f64::NEG_INFINITY };
        for k in 0..REACH {
            let place = if from > other { from.checked_add(k) } else { from.checked_sub(k) };
            let Some(place) = place.filter(|&p| p < self.length) else { break };
            let level = sign * f64::from(self.at(place));
            if level + noise < walk.furthest {
                break;
            }
            walk.furthest = walk.furthest.max(level);
            walk.levels[k] = level;
            walk.count += 1;
        }
        walk
    }

    /// Of the angle between the lane and the direction in which the darkness changes between two pixels of it.
    fn cosine(&self, paper: usize, ink: usize) -> f64 {
        let along = f64::from(self.at(ink)) - f64::from(self.at(paper));
        let change = |k: usize| {
            let at = self.first + k * self.along;
            let [before, after] = [at - self.across, at + self.across].map(|i| self.plane.values[i]);
            f64::from(after) - f64::from(before)
        };
        // two differences over 2 px each
        let across = 0.25 * (change(paper) + change(ink));
        along.abs() / hypot(along, across)
    }
}

/// Levels on one side of an edge.
struct Walk {
    levels: [f64; REACH],
    count: usize,
    /// The highest.
    furthest: f64,
}

impl Walk {
    /// How far from the first pixel a level is reached, px; `before` is the level 1 px before it.
    fn reaches(&self, before: f64, level: f64) -> Option<f64> {
        let mut before = before;
        for (k, &here) in self.levels[..self.count].iter().enumerate() {
            if here >= level && here > before {
                return Some(k as f64 - ((here - level) / (here - before)).min(1.0));
            }
            before = here;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line 12 px wide through the middle, at an angle, its edges blurred by a Gaussian of `sigma`.
    fn line(angle_deg: f64, sigma: f64) -> Plane<u8> {
        let normal = angle_deg.to_radians().sin_cos();
        let level = |i: usize| {
            let (x, y) = ((i % 200) as f64 - 99.7, (i / 200) as f64 - 75.2);
            let beyond = (x * normal.1 + y * normal.0).abs() - 6.0;
            // the logistic curve of slope 1.702/σ is a Gaussian's integral to one per cent
            (230.0 / (1.0 + (1.702 * beyond / sigma).exp())) as u8
        };
        Plane { width: 200, height: 150, values: (0..200 * 150).map(level).collect() }
    }

    #[test]
    fn an_edge_is_as_wide_at_any_slant() {
        let step = Step { threshold: 115, least: 100.0, noise: 1.0 };
        for angle in [0.0, 20.0, 45.0, 70.0, 90.0, 135.0] {
            for sigma in [1.0, 2.0] {
                let width = edge_px(&line(angle, sigma), step).unwrap();
                // 10 % to 90 % of a Gaussian's integral
                assert!((width - 2.563 * sigma).abs() < 0.35, "{angle}° σ {sigma}: {width}");
            }
        }
        let sharp = edge_px(&line(10.0, 0.3), step).unwrap();
        assert!((0.7..1.5).contains(&sharp), "{sharp}");
    }

    #[test]
    fn blank_paper_has_no_edges() {
        let step = Step { threshold: 115, least: 100.0, noise: 1.0 };
        assert_eq!(edge_px(&Plane::filled(64, 64, 0), step), None);
        assert_eq!(edge_px(&Plane::filled(1, 8, 0), step), None);
    }
}
