//! Finds circular runs in a point sequence.

use std::ops::RangeInclusive;

use kurbo::{Point, Vec2};

use super::noise;

/// Fewest points of an arc: three decide a circle, two more confirm it.
pub(super) const FEWEST: usize = 5;
/// Fewest points of an arc beside another one: the joint takes some.
const LEAST_POINTS: usize = 8;
/// Most arcs that are looked for in one bend; what needs more is a curve of its own.
const MOST_ARCS: usize = 6;

/// A circle with a way round it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Circle {
    pub(super) centre: Point,
    /// Positive where the way turns x towards y.
    pub(super) radius: f64,
}

/// An arc of a row: its points, `first..=last`, and the circle through them; none where they are straight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bow {
    pub(super) first: usize,
    pub(super) last: usize,
    pub(super) circle: Option<Circle>,
}

/// An arc whose sagitta is below this, in root mean square distances, is a line.
const STRAIGHT: f64 = 1.5;

/// The few arcs that the points `range` of a row are made of, in order; none where they are something else. Points may
/// be `rms` from their circle, root mean square. Those first and last ones that may show the tip of a pen, `tips`, are
/// left out if they are in the way, otherwise only the ends themselves.
pub(super) fn bows(row: &[Point], range: RangeInclusive<usize>, rms: f64, tips: [usize; 2]) -> Vec<Bow> {
    let start = *range.start();
    let points = row.get(range).unwrap_or_default();
    if points.len() <= FEWEST + tips[0] + tips[1] {
        return Vec::new();
    }
    let roundness = Roundness::new(points, rms).measured();
    let without = |[before, after]: [usize; 2]| roundness.cuts(before, points.len() - 1 - after);
    let mut cuts = without(tips.map(|tip| tip.min(1)));
    if cuts.is_empty() && tips.iter().any(|&tip| tip > 1) {
        cuts = without(tips);
    }
    let bow = |w: &[usize]| {
        // half the way round: the chord of the whole may be short, for it may end near where it begins
        let half = points[w[0]].distance_squared(points[w[0].midpoint(w[1])]);
        let circle = roundness.circle(w[0], w[1]).map(|(circle, _)| circle);
        let circle = circle.filter(|c| half > 2.0 * c.radius.abs() * STRAIGHT * rms);
        Bow { first: start + w[0], last: start + w[1], circle }
    };
    let bows: Vec<Bow> = cuts.windows(2).map(bow).collect();
    if bows.windows(2).any(|w| w[0].circle.is_none() && w[1].circle.is_none()) { Vec::new() } else { bows }
}

/// How far points are off the circle that fits them best, mean square; `None` where that is more than noise.
pub(super) fn scatter(points: &[Point], rms: f64) -> Option<f64> {
    let last = points.len().checked_sub(4)? + 3;
    let roundness = Roundness::new(points, rms);
    let (_, square) = roundness.circle(0, last).filter(|_| roundness.is_even(0, last))?;
    Some(square)
}

/// Across a joint of two arcs, points are off an arc by this much more than along either, in mean square.
const JUMP: f64 = 2.5;

/// Noise is measured over so many points.
const WINDOW: usize = 16;
/// An arc goes on while its points are within this many times the noise, root mean square.
const NOISY: f64 = 1.6;

/// Sums of powers of the coordinates, so that a circle through any run costs the same.
struct Roundness<'a> {
    points: &'a [Point],
    /// Sums of x, y, xx, xy, yy, xz, yz and zz, where z is xx + yy.
    sums: Vec<[f64; 8]>,
    rms: f64,
    /// Tolerance for separating several arcs: no more than the noise requires.
    tight: f64,
}

impl<'a> Roundness<'a> {
    fn new(points: &'a [Point], rms: f64) -> Self {
        let origin = points.get(points.len() / 2).copied().unwrap_or_default();
        let mut sums = Vec::with_capacity(points.len() + 1);
        let mut sum = [0.0; 8];
        sums.push(sum);
        for &p in points {
            let (x, y) = (p - origin).into();
            let z = x * x + y * y;
            for (s, term) in sum.iter_mut().zip([x, y, x * x, x * y, y * y, x * z, y * z, z * z]) {
                *s += term;
            }
            sums.push(sum);
        }
        Self { points, sums, rms, tight: rms }
    }

    /// Circle through points `i..=j` and the mean of their squared distances from it; `None` on a line.
    ///
    /// Pratt, "Direct least-squares fitting of algebraic surfaces" (1987), with Newton's method for the least eigenvalue,
    /// which is that mean (Chernov, *Circular and Linear Regression*, 2010, §5.5): short arcs do not draw it inwards.
    fn circle(&self, i: usize, j: usize) -> Option<(Circle, f64)> {
        let n = (j + 1 - i) as f64;
        let [mx, my, sxx, sxy, syy, sxz, syz, szz] =
            std::array::from_fn(|k| (self.sums[j + 1][k] - self.sums[i][k]) / n);
        // the same about the mean: u, v, w = uu + vv
        let (uu, uv, vv) = (sxx - mx * mx, sxy - mx * my, syy - my * my);
        let (z, mm, w) = (sxx + syy, mx * mx + my * my, uu + vv);
        let uw = sxz - mx * z - 2.0 * (mx * uu + my * uv);
        let vw = syz - my * z - 2.0 * (mx * uv + my * vv);
        let zw = szz - 2.0 * (mx * sxz + my * syz) + mm * z;
        let ww = zw - 2.0 * (mx * (uw + mx * w) + my * (vw + my * w)) + mm * w;
        let area = uu * vv - uv * uv;
        let eta = least_root([
            uw * (uw * vv - vw * uv) + vw * (vw * uu - uw * uv) - area * (ww - w * w),
            w * (ww + 4.0 * area - w * w) - uw * uw - vw * vw,
            4.0 * area - 3.0 * w * w - ww,
        ]);
        let determinant = 2.0 * (eta * eta - eta * w + area);
        let arm = Vec2::new(uw * (vv - eta) - vw * uv, vw * (uu - eta) - uw * uv) / determinant;
        let square = arm.hypot2() + w + 2.0 * eta;
        let (p, q, r) = (self.points[i], self.points[i.midpoint(j)], self.points[j]);
        let circle = Circle {
            centre: self.origin() + Vec2::new(mx, my) + arm,
            radius: square.sqrt().copysign((q - p).cross(r - q)),
        };
        (determinant != 0.0 && square < 1e12 * w).then_some((circle, eta.max(0.0)))
    }

    /// With `tight` from how far points are off circles through a few of them, in the median.
    fn measured(mut self) -> Self {
        let ends = (WINDOW - 1..self.points.len()).step_by(WINDOW);
        let mut squares: Vec<f64> =
            ends.filter_map(|j| self.circle(j + 1 - WINDOW, j)).map(|(_, square)| square).collect();
        squares.sort_by(f64::total_cmp);
        if let Some(median) = squares.get(squares.len() / 2) {
            // three degrees of freedom went into each circle
            let noise = (median * WINDOW as f64 / (WINDOW - 3) as f64).sqrt();
            self.tight = (NOISY * noise).clamp(0.4 * self.rms, self.rms);
        }
        self
    }

    fn origin(&self) -> Point {
        self.points[self.points.len() / 2]
    }

    fn is_round(&self, i: usize, j: usize, rms: f64) -> bool {
        self.circle(i, j).is_none_or(|(_, square)| square <= rms * rms)
    }

    /// The points `first` and `last` and those between at which one arc passes into the next; none where arcs do not do.
    fn cuts(&self, first: usize, last: usize) -> Vec<usize> {
        if self.is_round(first, last, self.rms) {
            return vec![first, last];
        }
        let mut cuts = vec![first];
        while let Some(&from) = cuts.last().filter(|&&c| c < last) {
            let to = self.reach(from, last);
            // carried on as far as it goes, the first arc of several has a little too much of the next one; a curve
            // that is no arc has bent away long before
            let arc = to >= from + LEAST_POINTS && self.is_even(from, from + (to - from) * 4 / 5);
            if !arc || cuts.len() > MOST_ARCS {
                return Vec::new();
            }
            cuts.push(to);
        }
        self.settle(&mut cuts);
        let parted = (1..cuts.len() - 1).all(|k| self.breaks(cuts[k - 1], cuts[k], cuts[k + 1]));
        if parted { cuts } else { Vec::new() }
    }

    /// Whether the curvature jumps at point `at`, where one arc passes into the next: then no arc of their length
    /// fits there. A curve that bends more and more is as round there as anywhere.
    fn breaks(&self, from: usize, at: usize, to: usize) -> bool {
        let square = |i, j| self.circle(i, j).map_or(0.0, |(_, square)| square);
        let half = (at - from).min(to - at) / 2;
        square(at - half, at + half) > JUMP * square(from, at).max(square(at, to))
    }

    /// The furthest point up to which a circle goes from point `i`, by doubling and halving steps.
    fn reach(&self, i: usize, last: usize) -> usize {
        let (mut good, mut step) = (i + 3, WINDOW);
        if good >= last {
            return last;
        }
        while good < last && self.is_round(i, (good + step).min(last), self.tight) {
            good = (good + step).min(last);
            step *= 2;
        }
        while step > 0 {
            if good + step <= last && self.is_round(i, good + step, self.tight) {
                good += step;
            }
            step /= 2;
        }
        good
    }

    fn is_even(&self, i: usize, j: usize) -> bool {
        let Some((circle, _)) = self.circle(i, j) else { return false };
        let off: Vec<f64> =
            self.points[i..=j].iter().map(|p| p.distance(circle.centre) - circle.radius.abs()).collect();
        noise::is_even(&off, self.rms)
    }

    /// Moves the inner cuts to where the arcs either side are least off, one after the other, twice.
    fn settle(&self, cuts: &mut [usize]) {
        let inner = 1..cuts.len() - 1;
        let rounds = if cuts.len() > 3 { 2 } else { 1 };
        for k in (0..rounds).flat_map(|_| inner.clone()) {
            let (from, to) = (cuts[k - 1], cuts[k + 1]);
            let cost = |&at: &usize| {
                let of =
                    |i: usize, j: usize| (j - i) as f64 * self.circle(i, j).map_or(0.0, |(_, square)| square);
                of(from, at) + of(at, to)
            };
            let (low, high) = (from + LEAST_POINTS, to.saturating_sub(LEAST_POINTS));
            let best = |low: usize, high: usize, stride: usize| {
                (low..=high).step_by(stride).min_by(|a, b| cost(a).total_cmp(&cost(b)))
            };
            let stride = (high.saturating_sub(low) / 16).max(1);
            let Some(coarse) = best(low, high, stride) else { continue };
            let near = low.max(coarse.saturating_sub(stride))..=high.min(coarse + stride);
            cuts[k] = best(*near.start(), *near.end(), (stride / 4).max(1)).unwrap_or(coarse);
        }
    }
}

/// The least root of 4x⁴ + a₂x² + a₁x + a₀ that is not negative, by Newton's method from 0 upwards.
fn least_root([a0, a1, a2]: [f64; 3]) -> f64 {
    let (mut x, mut y) = (0.0, a0);
    for _ in 0..12 {
        let step = y / (a1 + x * (2.0 * a2 + 16.0 * x * x));
        let next: f64 = x - step;
        let value = a0 + next * (a1 + next * (a2 + 4.0 * next * next));
        if !next.is_finite() || value.abs() >= y.abs() {
            break;
        }
        (x, y) = (next, value);
        if step.abs() <= 1e-9 * x {
            break;
        }
    }
    x
}
