//! One cubic through many points, its ends and end directions given.
//!
//! Schneider, "An algorithm for automatically fitting digitized curves", Graphics Gems (1990): the two handle
//! lengths by least squares, the parameters moved to the nearest points by Newton's method, again.

use kurbo::{CubicBez, ParamCurve, ParamCurveDeriv, Point, Vec2};

/// Where a cubic begins and ends and in which directions it passes there (unit vectors, drawing direction).
#[derive(Clone, Copy, Debug)]
pub(super) struct Ends {
    pub(super) from: Point,
    pub(super) leaving: Vec2,
    pub(super) to: Point,
    pub(super) arriving: Vec2,
}

/// Rounds of least squares and re-parametrization; the gain of a further one is below 1 % of the tolerance.
const ROUNDS: usize = 6;
/// A cubic that is off by less than this share of the tolerance is not improved further.
const GOOD: f64 = 0.5;

/// A handle this share of the points' length makes the parameter run evenly; that is 1/3 on a line, 0.35 on a
/// quarter circle.
const EVEN_HANDLE: f64 = 0.345;

/// Shortest and longest handle as a share of the points' length: beyond, the curvature peaks at the ends.
const HANDLES: std::ops::RangeInclusive<f64> = 0.16..=0.62;

/// The best cubic and its greatest distance from the points; one well within `tolerance` is good enough.
pub(super) fn through(points: &[Point], ends: &Ends, tolerance: f64) -> (CubicBez, f64) {
    let (mut u, length) = chord_parameters(points, ends);
    let mut curve = with_handles(ends, EVEN_HANDLE * length, EVEN_HANDLE * length);
    let mut off = f64::INFINITY;
    for _ in 0..ROUNDS {
        let (a, b) = handles(points, &u, ends, length);
        curve = with_handles(ends, a, b);
        reparametrize(points, &mut u, &curve);
        let square = points.iter().zip(&u).map(|(p, &t)| p.distance_squared(curve.eval(t)));
        off = square.fold(0.0, f64::max).sqrt();
        if off <= GOOD * tolerance {
            break;
        }
    }
    (curve, off)
}

fn with_handles(ends: &Ends, a: f64, b: f64) -> CubicBez {
    CubicBez::new(ends.from, ends.from + ends.leaving * a, ends.to - ends.arriving * b, ends.to)
}

/// Shares of arc length along the polyline from end to end, and its length.
fn chord_parameters(points: &[Point], ends: &Ends) -> (Vec<f64>, f64) {
    let mut at = ends.from;
    let mut passed = 0.0;
    let mut u: Vec<f64> = Vec::with_capacity(points.len());
    for &p in points {
        passed += p.distance(at);
        at = p;
        u.push(passed);
    }
    let length = passed + ends.to.distance(at);
    u.iter_mut().for_each(|s| *s /= length.max(1e-300));
    (u, length)
}

/// Handle lengths by least squares. A weak pull to even handles (a fifth of a point's weight) decides where the
/// points do not: on short and on straight stretches.
fn handles(points: &[Point], u: &[f64], ends: &Ends, length: f64) -> (f64, f64) {
    let even = EVEN_HANDLE * length;
    let pull = 0.2 * 0.02 * points.len() as f64; // a handle moves the curve by 0.02 of its square on average
    let (mut aa, mut ab, mut bb) = (pull, 0.0, pull);
    let (mut ax, mut bx) = (pull * even, pull * even);
    for (&p, &t) in points.iter().zip(u) {
        let s = 1.0 - t;
        let (b0, b1, b2, b3) = (s * s * s, 3.0 * t * s * s, 3.0 * t * t * s, t * t * t);
        let (a, b) = (ends.leaving * b1, ends.arriving * -b2);
        let fixed = ends.from.to_vec2() * (b0 + b1) + ends.to.to_vec2() * (b2 + b3);
        let rest = p.to_vec2() - fixed;
        (aa, ab, bb) = (aa + a.hypot2(), ab + a.dot(b), bb + b.hypot2());
        (ax, bx) = (ax + a.dot(rest), bx + b.dot(rest));
    }
    let determinant = aa * bb - ab * ab;
    if determinant <= 1e-12 * aa * bb {
        return (even, even);
    }
    let (low, high) = (HANDLES.start() * length, HANDLES.end() * length);
    let a = (ax * bb - bx * ab) / determinant;
    let b = (bx * aa - ax * ab) / determinant;
    (a.clamp(low, high), b.clamp(low, high))
}

/// One step of Newton's method towards each point's nearest parameter.
fn reparametrize(points: &[Point], u: &mut [f64], curve: &CubicBez) {
    let (first, second) = (curve.deriv(), curve.deriv().deriv());
    for (&p, t) in points.iter().zip(u) {
        let off = curve.eval(*t) - p;
        let (d, dd) = (first.eval(*t).to_vec2(), second.eval(*t).to_vec2());
        let slope = d.hypot2() + off.dot(dd);
        if slope > 1e-12 * d.hypot2() {
            *t = (*t - off.dot(d) / slope).clamp(0.0, 1.0);
        }
    }
}
