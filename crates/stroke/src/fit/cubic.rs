//! One cubic through many points, its ends and end directions given.
//!
//! Schneider, "An algorithm for automatically fitting digitized curves", Graphics Gems (1990): the two handle
//! lengths by least squares, the parameters moved to the nearest points by Newton's method, again.

use kurbo::{CubicBez, Point, Vec2};

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

/// Nor is one that is within the tolerance and gained less than this share of its distance in a round.
const WORTH: f64 = 0.04;
/// One that is off by more tolerances than this after its first round will not come within it: of 7500 outlines' that
/// did, the worst began at 2.9.
const HOPELESS: f64 = 3.2;
/// Nor will one that would need more than so many rounds' gain: each gains less than the one before.
const AHEAD: f64 = 4.0;

/// A handle this share of the points' length makes the parameter run evenly; that is 1/3 on a line, 0.35 on a
/// quarter circle.
const EVEN_HANDLE: f64 = 0.345;

/// Shortest and longest handle as a share of the points' length: beyond, the curvature peaks at the ends.
const HANDLES: std::ops::RangeInclusive<f64> = 0.16..=0.62;

/// The best cubic and its greatest distance from the points; one well within `tolerance` is good enough.
pub(super) fn through(points: &[Point], ends: &Ends, tolerance: f64) -> (CubicBez, f64) {
    let (mut u, length) = chord_parameters(points, ends);
    let mut sums = Sums::default();
    points.iter().zip(&u).for_each(|(&p, &t)| sums.add(p - ends.from, ends.to - ends.from, t));
    let (mut curve, mut off) =
        (with_handles(ends, EVEN_HANDLE * length, EVEN_HANDLE * length), f64::INFINITY);
    for _ in 0..ROUNDS {
        let (a, b) = sums.handles(points.len(), ends, length);
        curve = with_handles(ends, a, b);
        let before = std::mem::replace(&mut off, reparametrize(points, &mut u, &curve, &mut sums));
        let gain = before - off;
        let is_good = off <= GOOD * tolerance || (off <= tolerance && gain < WORTH * off);
        if is_good || off > HOPELESS * tolerance || off - tolerance > AHEAD * gain {
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
    let share = 1.0 / length.max(1e-300);
    u.iter_mut().for_each(|s| *s *= share);
    (u, length)
}

/// What the points say about the handles: sums over them, with the Bernstein polynomials b₁ and b₂ at their
/// parameters.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    /// Of b₁², b₁b₂ and b₂².
    squares: [f64; 3],
    /// Of b₁ and b₂ times what the ends leave of a point.
    rests: [Vec2; 2],
}

impl Sums {
    /// A point `p` from the cubic's start, whose end is at `to` from there.
    #[inline]
    fn add(&mut self, p: Vec2, to: Vec2, t: f64) {
        let s = 1.0 - t;
        let (b1, b2) = (3.0 * t * s * s, 3.0 * t * t * s);
        // b₂ + b₃
        let rest = p - to * (t * t * (3.0 - 2.0 * t));
        let [aa, ab, bb] = self.squares;
        self.squares = [aa + b1 * b1, ab + b1 * b2, bb + b2 * b2];
        self.rests = [self.rests[0] + rest * b1, self.rests[1] + rest * b2];
    }

    /// Handle lengths by least squares. A weak pull to even handles (a fifth of a point's weight) decides where the
    /// points do not: on short and on straight stretches.
    fn handles(&self, points: usize, ends: &Ends, length: f64) -> (f64, f64) {
        let even = EVEN_HANDLE * length;
        let pull = 0.2 * 0.02 * points as f64; // a handle moves the curve by 0.02 of its square on average
        let [aa, ab, bb] = self.squares;
        let (aa, bb) = (aa + pull, bb + pull);
        let ab = -ab * ends.leaving.dot(ends.arriving);
        let ax = pull * even + ends.leaving.dot(self.rests[0]);
        let bx = pull * even - ends.arriving.dot(self.rests[1]);
        let determinant = aa * bb - ab * ab;
        if determinant <= 1e-12 * aa * bb {
            return (even, even);
        }
        let (low, high) = (HANDLES.start() * length, HANDLES.end() * length);
        let a = (ax * bb - bx * ab) / determinant;
        let b = (bx * aa - ax * ab) / determinant;
        (a.clamp(low, high), b.clamp(low, high))
    }
}

/// One step of Newton's method towards each point's nearest parameter, summed up for the next handles; the greatest
/// distance of a point from the curve there.
fn reparametrize(points: &[Point], u: &mut [f64], curve: &CubicBez, sums: &mut Sums) -> f64 {
    let (from, to) = (curve.p0, curve.p3 - curve.p0);
    // powers of the parameter, from the start
    let (h1, h2) = (curve.p1 - from, curve.p2 - from);
    let (c1, c2, c3) = (h1 * 3.0, (h2 - h1 * 2.0) * 3.0, to + (h1 - h2) * 3.0);
    let (d2, d3, dd3) = (c2 * 2.0, c3 * 3.0, c3 * 6.0);
    let at = |t: f64| ((c3 * t + c2) * t + c1) * t;
    let mut furthest = 0.0_f64;
    *sums = Sums::default();
    for (&p, t) in points.iter().zip(u) {
        let (p, old) = (p - from, *t);
        let off = at(old) - p;
        let (d, dd) = ((d3 * old + d2) * old + c1, dd3 * old + d2);
        let (speed, slope) = (d.hypot2(), d.hypot2() + off.dot(dd));
        if slope > 1e-12 * speed {
            *t = (old - off.dot(d) / slope).clamp(0.0, 1.0);
        }
        furthest = furthest.max((at(*t) - p).hypot2());
        sums.add(p, to, *t);
    }
    furthest.sqrt()
}
