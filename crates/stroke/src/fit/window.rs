//! Local regression: what a stretch of samples says about place, direction and bend.

use kurbo::{Point, Vec2};

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

impl Parabola {
    /// Through samples at arc lengths `s`, by orthogonal polynomials; `None` for fewer than two.
    ///
    /// A bend that noise explains as well is left out: extrapolated, it would do more harm than good.
    pub fn through(samples: impl Iterator<Item = (f64, Point)> + Clone) -> Option<Self> {
        let n = samples.clone().count() as f64;
        let origin = samples.clone().map(|(s, _)| s).sum::<f64>() / n;
        let mean = samples.clone().map(|(_, p)| p.to_vec2()).sum::<Vec2>() / n;
        let power = |k: i32| samples.clone().map(|(s, _)| (s - origin).powi(k)).sum::<f64>();
        let (m2, m3, m4) = (power(2), power(3), power(4));
        if n < 2.0 || m2 <= 0.0 {
            return None;
        }
        // q₂(u) = u² − (m3/m2) u − m2/n is orthogonal to 1 and u on these very samples
        let (tilt, shift) = (m3 / m2, m2 / n);
        let second = |u: f64| u * u - tilt * u - shift;
        let norm = m4 - m3 * tilt - m2 * shift;
        let (mut slope, mut bend, mut square) = (Vec2::ZERO, Vec2::ZERO, 0.0);
        for (s, p) in samples {
            let (u, v) = (s - origin, p.to_vec2() - mean);
            (slope, bend, square) = (slope + v * u, bend + v * second(u), square + v.hypot2());
        }
        slope /= m2;
        let of_line = (square - slope.hypot2() * m2).max(0.0);
        let gain = bend.hypot2() / norm.max(1e-300);
        let left = (of_line - gain).max(0.0);
        let believed = n >= 5.0 && norm > 1e-9 * m4 && gain * (n - 3.0) > BELIEVED * left;
        bend = if believed { bend / norm } else { Vec2::ZERO };
        let rms = ((if believed { left } else { of_line }) / n).sqrt();
        Some(Self { origin, at: (mean - bend * shift).to_point(), slope: slope - bend * tilt, bend, rms })
    }

    /// The parabola of the widest window that still is one: windows of growing size are tried until the samples are
    /// further than `rms` from it. The first is taken as it is.
    pub fn widest(windows: impl Iterator<Item = Option<Self>>, rms: f64) -> Option<Self> {
        let mut best: Option<Self> = None;
        for parabola in windows.map_while(|p| p) {
            if best.is_some() && parabola.rms > rms {
                break;
            }
            best = Some(parabola);
        }
        best
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
    a.cross(b).atan2(a.dot(b))
}
