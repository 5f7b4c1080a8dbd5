//! Local regression: position, direction and curvature from a window of samples.

use kurbo::{Point, Vec2};
use tracelight_maths::atan2;

/// A parabola x(s), y(s) through samples by least squares; `s` is arc length.
#[derive(Clone, Copy, Debug)]
pub struct Parabola {
    origin: f64,
    at: Point,
    slope: Vec2,
    bend: Vec2,
    /// Root mean square distance of the samples from it.
    pub rms: f64,
}

/// A bend is believed when it takes away more than this times the variance that stays: 3 standard errors.
const BELIEVED: f64 = 9.0;

/// Whether a bend that takes `gain` off the squared residuals of `n` samples, and leaves `left`, is more than noise.
pub(super) fn is_believed(n: f64, gain: f64, left: f64) -> bool {
    n >= 5.0 && gain * (n - 3.0) > BELIEVED * left
}

/// Sums over samples, about the first of them, from which a parabola through them follows.
#[derive(Clone, Copy, Debug)]
struct Moments {
    /// Arc length and place of the first sample.
    first: (f64, Point),
    /// Sums of powers 0 to 4 of the arc length.
    powers: [f64; 5],
    /// Sums of the places times powers 0 to 2 of the arc length.
    places: [Vec2; 3],
    /// Sum of the squared places.
    square: f64,
}

impl Moments {
    fn about(first: (f64, Point)) -> Self {
        Self { first, powers: [0.0; 5], places: [Vec2::ZERO; 3], square: 0.0 }
    }

    fn add(&mut self, (s, p): (f64, Point)) {
        let (u, v) = (s - self.first.0, p - self.first.1);
        let (uu, [n, m1, m2, m3, m4]) = (u * u, self.powers);
        self.powers = [n + 1.0, m1 + u, m2 + uu, m3 + uu * u, m4 + uu * uu];
        let [p0, p1, p2] = self.places;
        self.places = [p0 + v, p1 + v * u, p2 + v * uu];
        self.square += v.hypot2();
    }

    /// The parabola by least squares, with polynomials orthogonal on the samples; `None` for fewer than two.
    fn parabola(&self) -> Option<Parabola> {
        let [n, sum, ..] = self.powers;
        let (mean, at) = (sum / n, self.places[0] / n);
        // powers about the mean
        let (m2, m3, m4) = self.central(mean);
        if n < 2.0 || m2 <= 0.0 {
            return None;
        }
        // q₂(u) = u² − (m3/m2) u − m2/n is orthogonal to 1 and u on these very samples
        let (tilt, shift) = (m3 / m2, m2 / n);
        let norm = m4 - m3 * tilt - m2 * shift;
        let line = self.places[1] - self.places[0] * mean;
        let squared = self.places[2] - self.places[1] * (2.0 * mean) + self.places[0] * (mean * mean);
        let slope = line / m2;
        let bend = squared - line * tilt - self.places[0] * shift;
        let of_line = (self.square - at.hypot2() * n - slope.hypot2() * m2).max(0.0);
        let gain = bend.hypot2() / norm.max(1e-300);
        let left = (of_line - gain).max(0.0);
        let believed = norm > 1e-9 * m4 && is_believed(n, gain, left);
        let bend = if believed { bend / norm } else { Vec2::ZERO };
        Some(Parabola {
            origin: self.first.0 + mean,
            at: self.first.1 + at - bend * shift,
            slope: slope - bend * tilt,
            bend,
            rms: ((if believed { left } else { of_line }) / n).sqrt(),
        })
    }

    /// Sums of powers 2 to 4 about `mean`.
    fn central(&self, mean: f64) -> (f64, f64, f64) {
        let [n, _, s2, s3, s4] = self.powers;
        let square = mean * mean;
        let m2 = s2 - n * square;
        let m3 = s3 - 3.0 * mean * s2 + 2.0 * n * square * mean;
        let m4 = s4 - 4.0 * mean * s3 + 6.0 * square * s2 - 3.0 * n * square * square;
        (m2, m3, m4)
    }
}

impl Parabola {
    /// Through samples at arc lengths `s`; `None` for fewer than two.
    ///
    /// A bend that noise explains as well is left out: extrapolated, it would do more harm than good.
    pub fn through(samples: impl Iterator<Item = (f64, Point)>) -> Option<Self> {
        let mut samples = samples.peekable();
        let mut moments = Moments::about(*samples.peek()?);
        samples.for_each(|sample| moments.add(sample));
        moments.parabola()
    }

    /// The parabola of the widest window that still is one: the first `sizes[0]` samples are taken as they are, then
    /// more of them, a size after the other, until they are further than `rms` from their parabola.
    pub fn widest(samples: impl Iterator<Item = (f64, Point)>, sizes: &[usize], rms: f64) -> Option<Self> {
        let mut samples = samples.peekable();
        let mut moments = Moments::about(*samples.peek()?);
        let (mut taken, mut best) = (0, None::<Self>);
        for &size in sizes {
            let before = taken;
            for sample in samples.by_ref().take(size.saturating_sub(before)) {
                moments.add(sample);
                taken += 1;
            }
            if size <= before {
                continue; // as wide as the one before
            }
            let Some(parabola) = (taken > before).then(|| moments.parabola()).flatten() else { break };
            if best.is_some() && parabola.rms > rms {
                break;
            }
            best = Some(parabola);
        }
        best
    }

    /// Whether the samples show no bend.
    pub fn is_straight(&self) -> bool {
        self.bend == Vec2::ZERO
    }

    /// Place at arc length `s`.
    pub fn point(&self, s: f64) -> Point {
        let u = s - self.origin;
        self.at + self.slope * u + self.bend * (u * u)
    }

    /// Unit direction at arc length `s`; zero where there is none.
    pub fn tangent(&self, s: f64) -> Vec2 {
        unit(self.slope + self.bend * (2.0 * (s - self.origin)))
    }
}

/// A vector of length one, or zero.
pub(super) fn unit(v: Vec2) -> Vec2 {
    let length = v.hypot();
    if length > 1e-300 { v / length } else { Vec2::ZERO }
}

/// Signed angle from `a` to `b`, rad.
pub(super) fn turn(a: Vec2, b: Vec2) -> f64 {
    atan2(a.cross(b), a.dot(b))
}
