//! SPLINE: B-splines of any degree, with or without weights, and splines that only name the points they pass.

use tracelight_stroke::{Path, Point, Vec2};

use super::groups::Record;
use crate::FormatError;
use crate::pen::Pen;

/// Degrees that are read. Drawing programs go to 11.
const MAX_DEGREE: usize = 15;

/// How far a cubic may be from the curve it stands for, as a share of the control points' spread: 10 µm in a metre.
const TOLERANCE: f64 = 1e-5;

/// Halvings of a span at most; each makes the error eight times smaller or more.
const MAX_HALVINGS: u32 = 8;

/// A point times its weight, and its weight.
type Weighted = [f64; 3];

/// The spline of a record.
///
/// # Errors
/// Counts that do not fit each other, knots that fall, weights that are not positive.
pub(super) fn path(record: &Record) -> Result<Option<Path>, FormatError> {
    let is_closed = record.whole_or(70, 0)? & 1 != 0;
    let controls = record.points(10)?;
    if controls.is_empty() {
        let (start, end) = (record.point(12)?.to_vec2(), record.point(13)?.to_vec2());
        return Ok(through(record.points(11)?, [start, end], is_closed));
    }
    let spline = Spline::of(record, controls)?;
    let path = spline.path(is_closed);
    let is_sound = path.as_ref().is_none_or(|p| crate::controls::controls(p).all(Point::is_finite));
    match is_sound {
        true => Ok(path),
        false => Err(record.wrong("the curve", "not finite".into(), "knots and weights of one magnitude")),
    }
}

/// A B-spline (Piegl & Tiller, *The NURBS Book*, 2nd ed., chapters 2 to 5).
struct Spline {
    degree: usize,
    knots: Vec<f64>,
    controls: Vec<Weighted>,
    is_rational: bool,
}

impl Spline {
    fn of(record: &Record, controls: Vec<Point>) -> Result<Self, FormatError> {
        let degree = record.whole_or(71, 3)?;
        let degree = usize::try_from(degree)
            .ok()
            .filter(|d| (1..=MAX_DEGREE).contains(d) && *d < controls.len())
            .ok_or_else(|| {
                let found = format!("{degree} with {} control points", controls.len());
                record.wrong("the degree", found, "1 to 15, and less than there are control points")
            })?;
        let weights = record.numbers(41)?;
        if weights.iter().any(|&w| w <= 0.0) || !(weights.is_empty() || weights.len() == controls.len()) {
            let found = format!("{} for {} control points", weights.len(), controls.len());
            return Err(record.wrong("the list of weights", found, "a positive one for each, or none"));
        }
        let mut knots = record.numbers(40)?;
        if knots.is_empty() {
            knots = even_knots(controls.len(), degree);
        }
        if knots.len() != controls.len() + degree + 1 || knots.windows(2).any(|k| k[0] > k[1]) {
            let found = format!("{} for {} control points", knots.len(), controls.len());
            return Err(record.wrong(
                "the list of knots",
                found,
                "control points + degree + 1, never falling",
            ));
        }
        let weight = |i: usize| weights.get(i).copied().unwrap_or(1.0);
        let is_rational = weights.windows(2).any(|w| (w[0] - w[1]).abs() > 1e-12 * w[0]);
        let weighted = |(i, p): (usize, &Point)| [p.x * weight(i), p.y * weight(i), weight(i)];
        let controls = controls.iter().enumerate().map(weighted).collect();
        Ok(Self { degree, knots, controls, is_rational })
    }

    fn path(&self, is_closed: bool) -> Option<Path> {
        let tolerance = TOLERANCE * self.spread();
        let mut pen: Option<Pen> = None;
        for span in self.degree..self.controls.len() {
            if self.knots[span] < self.knots[span + 1] {
                let bezier = self.bezier(span);
                let pen = pen.get_or_insert_with(|| Pen::new(plane(bezier[0])));
                self.draw(&bezier, pen, tolerance);
            }
        }
        // one that returns to its start and is not closed may be a part of something: `join` closes it if it is alone
        pen?.finish(is_closed)
    }

    fn spread(&self) -> f64 {
        let points = self.controls.iter().map(|&c| plane(c));
        points.map(|p| p.distance(plane(self.controls[0]))).fold(0.0, f64::max)
    }

    /// Control points of the curve between two knots: its blossom at so many of the one and so many of the other
    /// (Ramshaw, "Blossoms are polar forms", 1989).
    fn bezier(&self, span: usize) -> Vec<Weighted> {
        let (from, to) = (self.knots[span], self.knots[span + 1]);
        (0..=self.degree).map(|i| self.blossom(span, |k| if k < i { to } else { from })).collect()
    }

    /// De Boor's scheme with an argument of its own at each level.
    fn blossom(&self, span: usize, argument: impl Fn(usize) -> f64) -> Weighted {
        let p = self.degree;
        let mut d: Vec<Weighted> = self.controls[span - p..=span].to_vec();
        for level in 1..=p {
            let t = argument(level - 1);
            for j in (level..=p).rev() {
                let (low, high) = (self.knots[span - p + j], self.knots[span + 1 + j - level]);
                d[j] = between(d[j - 1], d[j], (t - low) / (high - low));
            }
        }
        d[p]
    }

    /// Exact where a cubic can be, else as many cubics as the tolerance takes.
    fn draw(&self, bezier: &[Weighted], pen: &mut Pen, tolerance: f64) {
        match *bezier {
            _ if self.is_rational => approximate(bezier, pen, tolerance, MAX_HALVINGS),
            [_, b] => pen.line_to(plane(b)),
            [_, b, c] => pen.quadratic_to(plane(b), plane(c)),
            [_, b, c, d] => pen.cubic_to([b, c, d].map(plane)),
            _ => approximate(bezier, pen, tolerance, MAX_HALVINGS),
        }
    }
}

/// Knots for a spline that has none: it begins and ends at its first and last control point.
fn even_knots(controls: usize, degree: usize) -> Vec<f64> {
    let spans = controls - degree;
    let inner = (1..spans).map(|i| i as f64);
    let ends = |value: f64| std::iter::repeat_n(value, degree + 1);
    ends(0.0).chain(inner).chain(ends(spans as f64)).collect()
}

fn plane([x, y, w]: Weighted) -> Point {
    Point::new(x / w, y / w)
}

fn between(a: Weighted, b: Weighted, t: f64) -> Weighted {
    [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * t)
}

/// A cubic with the curve's ends and end tangents, if it is near enough at seven places between; else both halves.
fn approximate(bezier: &[Weighted], pen: &mut Pen, tolerance: f64, halvings: u32) {
    let cubic = hermite(bezier);
    let curve = kurbo::CubicBez::new(plane(bezier[0]), cubic[0], cubic[1], cubic[2]);
    let off = |i: u32| {
        let t = f64::from(i) / 8.0;
        kurbo::ParamCurve::eval(&curve, t).distance(plane(halves(bezier, t).1[0]))
    };
    if halvings == 0 || (1..8).all(|i| off(i) <= tolerance) {
        return pen.cubic_to(cubic);
    }
    let (first, second) = halves(bezier, 0.5);
    approximate(&first, pen, tolerance, halvings - 1);
    approximate(&second, pen, tolerance, halvings - 1);
}

/// The cubic with a rational curve's ends and its derivatives there, p·(w₁/w₀)·(P₁ − P₀) (Piegl & Tiller, eq. 4.9).
fn hermite(bezier: &[Weighted]) -> [Point; 3] {
    let last = bezier.len() - 1;
    let third = last as f64 / 3.0;
    let [a, b, c, d] = [0, 1, last - 1, last].map(|i| bezier[i]);
    let out = (plane(b) - plane(a)) * (third * b[2] / a[2]);
    let back = (plane(d) - plane(c)) * (third * c[2] / d[2]);
    [plane(a) + out, plane(d) - back, plane(d)]
}

/// De Casteljau's two halves at `t`; they meet at the curve's point there.
fn halves(bezier: &[Weighted], t: f64) -> (Vec<Weighted>, Vec<Weighted>) {
    let mut row = bezier.to_vec();
    let (mut first, mut second) = (Vec::with_capacity(row.len()), Vec::with_capacity(row.len()));
    while let (Some(&head), Some(&tail)) = (row.first(), row.last()) {
        first.push(head);
        second.push(tail);
        row = row.windows(2).map(|w| between(w[0], w[1], t)).collect();
    }
    second.reverse();
    (first, second)
}

/// A cubic spline through points, its parameter the chords' length: smooth to the second derivative, with the given
/// end tangents, or straight at ends that have none (de Boor, *A Practical Guide to Splines*, chapter IV).
pub(super) fn through(points: Vec<Point>, tangents: [Vec2; 2], is_closed: bool) -> Option<Path> {
    let points = apart(points);
    if is_closed && points.len() > 2 {
        return closed_through(&points);
    }
    let first = *points.first()?;
    let slopes = slopes(&points, tangents);
    let mut pen = Pen::new(first);
    draw(&mut pen, &points, &slopes);
    pen.finish(false)
}

/// Points without those that are too near the one before for a chord between them.
fn apart(mut points: Vec<Point>) -> Vec<Point> {
    const NEAR: f64 = 1e-9;
    let size = points.iter().map(|p| p.distance(points[0])).fold(0.0, f64::max);
    points.dedup_by(|next, last| next.distance(*last) <= NEAR * size);
    points
}

/// Points that a closed curve is solved with beyond its seam: the solution forgets 2 − √3 of it at each, 10⁻¹⁴ here.
const OVERLAP: usize = 25;

fn closed_through(points: &[Point]) -> Option<Path> {
    let (first, last) = (points[0], points[points.len() - 1]);
    // the first point may be given again at the end, or nearly
    let is_repeated = first.distance(last) <= 1e-6 * first.distance(points[1]);
    let ring = if is_repeated { &points[1..] } else { points };
    let n = ring.len();
    let around: Vec<Point> =
        (0..n + 1 + 2 * OVERLAP).map(|i| ring[(i + n * OVERLAP - OVERLAP) % n]).collect();
    let slopes = slopes(&around, [Vec2::ZERO; 2]);
    let own = OVERLAP..OVERLAP + n + 1;
    let mut pen = Pen::new(around[OVERLAP]);
    draw(&mut pen, &around[own.clone()], &slopes[own]);
    pen.finish(true)
}

fn draw(pen: &mut Pen, points: &[Point], slopes: &[Vec2]) {
    for (p, d) in points.windows(2).zip(slopes.windows(2)) {
        let third = p[0].distance(p[1]) / 3.0;
        pen.cubic_to([p[0] + d[0] * third, p[1] - d[1] * third, p[1]]);
    }
}

/// Derivatives at the points by the chords' length: a tridiagonal system, solved by Thomas's algorithm.
fn slopes(points: &[Point], tangents: [Vec2; 2]) -> Vec<Vec2> {
    let chords: Vec<Vec2> = points.windows(2).map(|w| w[1] - w[0]).collect();
    let n = points.len();
    let inverse = |i: usize| 1.0 / chords[i].hypot();
    let pull = |i: usize| chords[i] * (3.0 * inverse(i) * inverse(i));
    // row i: below·D[i−1] + diagonal·D[i] + above·D[i+1] = right
    let row = |i: usize| match i {
        _ if n < 2 => (0.0, 1.0, 0.0, Vec2::ZERO),
        0 if tangents[0] != Vec2::ZERO => (0.0, 1.0, 0.0, tangents[0].normalize()),
        0 => (0.0, 2.0 * inverse(0), inverse(0), pull(0)),
        _ if i == n - 1 && tangents[1] != Vec2::ZERO => (0.0, 1.0, 0.0, tangents[1].normalize()),
        _ if i == n - 1 => (inverse(i - 1), 2.0 * inverse(i - 1), 0.0, pull(i - 1)),
        _ => (inverse(i - 1), 2.0 * (inverse(i - 1) + inverse(i)), inverse(i), pull(i - 1) + pull(i)),
    };
    let mut above = vec![0.0; n];
    let mut slopes = vec![Vec2::ZERO; n];
    for i in 0..n {
        let (below, diagonal, over, right) = row(i);
        let (last_above, last) = if i == 0 { (0.0, Vec2::ZERO) } else { (above[i - 1], slopes[i - 1]) };
        let pivot = diagonal - below * last_above;
        above[i] = over / pivot;
        slopes[i] = (right - last * below) / pivot;
    }
    for i in (1..n).rev() {
        slopes[i - 1] = slopes[i - 1] - slopes[i] * above[i - 1];
    }
    slopes
}
