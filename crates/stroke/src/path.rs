use kurbo::{Affine, CubicBez, ParamCurve, ParamCurveArclen, ParamCurveDeriv, Point, Vec2};
use tracelight_maths::{acos, atan2, sin_cos};

/// By how much a direction changes to another one, rad, without its sign.
#[must_use]
pub fn turn_rad(incoming: Vec2, outgoing: Vec2) -> f64 {
    atan2(incoming.cross(outgoing), incoming.dot(outgoing)).abs()
}

/// One piece of a [`Path`], from the end of the piece before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Element {
    /// Straight to `to`.
    Line {
        /// End point.
        to: Point,
    },
    /// Along a circle about `centre`, by `sweep` radians (positive turns x towards y).
    Arc {
        /// Centre of the circle.
        centre: Point,
        /// Signed angle swept, rad.
        sweep: f64,
    },
    /// A cubic Bézier curve to `to`.
    Cubic {
        /// First control point.
        c1: Point,
        /// Second control point.
        c2: Point,
        /// End point.
        to: Point,
    },
}

/// An element together with the point it starts from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Start point.
    pub from: Point,
    /// The element that starts there.
    pub element: Element,
}

/// Position, unit tangent and curvature at one place of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// Where.
    pub point: Point,
    /// Unit vector in drawing direction.
    pub tangent: Vec2,
    /// Second derivative by arc length: points to the centre of curvature, length 1/radius.
    pub curvature: Vec2,
}

/// A connected line of straight pieces, arcs and cubics.
///
/// A closed path ends where it starts: its last element returns to [`Path::start`].
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    start: Point,
    /// End of the last element: kept, because finding it means walking all of them.
    end: Point,
    elements: Vec<Element>,
    closed: bool,
}

impl Path {
    /// An open path without elements; add some with [`push`](Self::push).
    pub const fn new(start: Point) -> Self {
        Self { start, end: start, elements: Vec::new(), closed: false }
    }

    fn of(start: Point, elements: impl IntoIterator<Item = Element>, closed: bool) -> Self {
        let mut path = Self::new(start);
        elements.into_iter().for_each(|e| path.push(e));
        path.closed = closed;
        path
    }

    /// Straight lines through `points`; repeated points are dropped. `None` for fewer than two distinct points.
    /// A closed polyline need not repeat its first point.
    pub fn polyline(points: &[Point], closed: bool) -> Option<Self> {
        let (&first, rest) = points.split_first()?;
        let mut path = Self::new(first);
        for &to in rest {
            path.line_to(to);
        }
        if closed {
            path.close();
        }
        (!path.elements.is_empty()).then_some(path)
    }

    /// Appends an element.
    pub fn push(&mut self, element: Element) {
        self.end = Piece { from: self.end, element }.end();
        self.elements.push(element);
    }

    /// Appends a line unless it has no length.
    pub fn line_to(&mut self, to: Point) {
        if to != self.end() {
            self.push(Element::Line { to });
        }
    }

    /// Marks the path closed, with a line back to the start where one is missing. A path without elements stays
    /// open.
    pub fn close(&mut self) {
        if self.elements.is_empty() {
            return;
        }
        // arcs and transforms end a few ulp beside the start: that is closed already
        let reach = self.start.to_vec2().hypot().max(1e-9) * 1e-9;
        if self.end().distance(self.start) > reach {
            self.line_to(self.start);
        }
        self.closed = true;
    }

    /// First point.
    pub const fn start(&self) -> Point {
        self.start
    }

    /// Last point; the first one for a closed path.
    pub const fn end(&self) -> Point {
        if self.closed { self.start } else { self.end }
    }

    /// Whether the path returns to its start.
    pub const fn is_closed(&self) -> bool {
        self.closed
    }

    /// The elements in drawing order.
    pub fn elements(&self) -> &[Element] {
        &self.elements
    }

    /// Each element with the point it starts from.
    pub fn pieces(&self) -> impl Iterator<Item = Piece> + '_ {
        let mut at = self.start;
        self.elements.iter().map(move |&element| {
            let piece = Piece { from: at, element };
            at = piece.end();
            piece
        })
    }

    /// Arc length, to `tolerance` (of the cubics; lines and arcs are exact).
    pub fn length(&self, tolerance: f64) -> f64 {
        self.pieces().map(|p| p.length(tolerance)).sum()
    }

    /// Arc length, of a cubic that of its control polygon: a little too long, and quick.
    pub fn rough_length(&self) -> f64 {
        self.pieces().map(|p| p.rough_length()).sum()
    }

    /// Points of a polyline that stays within `tolerance` of the path; the first point is the start, the last one
    /// the end (for a closed path: the start again).
    pub fn flatten(&self, tolerance: f64) -> Vec<Point> {
        let mut points = vec![self.start];
        for piece in self.pieces() {
            let n = piece.flat_steps(tolerance);
            points.extend((1..n).map(|i| piece.at(i as f64 / n as f64)));
            points.push(piece.end());
        }
        if let (true, Some(last)) = (self.closed, points.last_mut()) {
            *last = self.start;
        }
        points
    }

    /// Returns the path in the opposite direction.
    pub fn reversed(&self) -> Self {
        let pieces: Vec<_> = self.pieces().collect();
        let elements = pieces.iter().rev().map(|p| p.reversed_element());
        Self::of(self.end(), elements, self.closed)
    }

    /// A closed path begun at its element number `first` instead (taken modulo their number); an open one as it is.
    pub fn started_at(&self, first: usize) -> Self {
        if !self.closed || self.elements.is_empty() {
            return self.clone();
        }
        let first = first % self.elements.len();
        let start = self.pieces().nth(first).map_or(self.start, |p| p.from);
        let mut elements = self.elements.clone();
        elements.rotate_left(first);
        Self::of(start, elements, true)
    }

    /// What is left of it from an arc length on, which on cubics is found to `tolerance`; open, and `None` if nothing is.
    pub fn after(&self, length: f64, tolerance: f64) -> Option<Self> {
        let mut left: Option<Self> = None;
        let mut before = 0.0;
        for piece in self.pieces() {
            let own = piece.length(tolerance);
            let skipped = (length - before).max(0.0);
            before += own;
            if skipped + tolerance >= own {
                continue;
            }
            let piece = if skipped > 0.0 { piece.part(skipped, own, tolerance) } else { piece };
            left.get_or_insert_with(|| Self::new(piece.from)).push(piece.element);
        }
        left
    }

    /// The path moved by a similarity (rotation, uniform scale, reflection, shift).
    pub fn transformed(&self, similarity: Affine) -> Self {
        let turn = similarity.determinant().signum();
        let elements = self.elements.iter().map(|&e| match e {
            Element::Line { to } => Element::Line { to: similarity * to },
            Element::Arc { centre, sweep } => {
                Element::Arc { centre: similarity * centre, sweep: sweep * turn }
            }
            Element::Cubic { c1, c2, to } => {
                Element::Cubic { c1: similarity * c1, c2: similarity * c2, to: similarity * to }
            }
        });
        Self::of(similarity * self.start, elements, self.closed)
    }
}

impl Piece {
    /// End point.
    pub fn end(&self) -> Point {
        match self.element {
            Element::Line { to } | Element::Cubic { to, .. } => to,
            Element::Arc { centre, sweep } => centre + rotate(self.from - centre, sweep),
        }
    }

    /// Arc length, to `tolerance` for a cubic, exact otherwise.
    pub fn length(&self, tolerance: f64) -> f64 {
        match self.element {
            Element::Line { to } => self.from.distance(to),
            Element::Arc { centre, sweep } => self.from.distance(centre) * sweep.abs(),
            Element::Cubic { c1, c2, to } => CubicBez::new(self.from, c1, c2, to).arclen(tolerance),
        }
    }

    /// Arc length, of a cubic that of its control polygon: a little too long, and quick.
    pub fn rough_length(&self) -> f64 {
        match self.element {
            Element::Cubic { c1, c2, to } => self.from.distance(c1) + c1.distance(c2) + c2.distance(to),
            _ => self.length(0.0),
        }
    }

    /// The point at parameter `t` in [0, 1].
    pub fn at(&self, t: f64) -> Point {
        match self.element {
            Element::Line { to } => self.from.lerp(to, t),
            Element::Arc { centre, sweep } => centre + rotate(self.from - centre, sweep * t),
            Element::Cubic { c1, c2, to } => CubicBez::new(self.from, c1, c2, to).eval(t),
        }
    }

    /// Position, tangent and curvature at arc length `s` from the start; `tolerance` is the error of that length
    /// on a cubic.
    pub fn at_length(&self, s: f64, tolerance: f64) -> PathPoint {
        match self.element {
            Element::Line { to } => {
                let tangent = (to - self.from).normalize();
                PathPoint { point: self.from + tangent * s, tangent, curvature: Vec2::ZERO }
            }
            Element::Arc { centre, sweep } => arc_at(self.from, centre, sweep.signum(), s),
            Element::Cubic { c1, c2, to } => {
                let curve = CubicBez::new(self.from, c1, c2, to);
                cubic_at(curve, curve.inv_arclen(s, tolerance))
            }
        }
    }

    /// The part between two arc lengths from the start, which on a cubic are found to `tolerance`.
    pub fn part(&self, from: f64, to: f64, tolerance: f64) -> Self {
        match self.element {
            Element::Line { .. } => {
                let [start, end] = [from, to].map(|s| self.at_length(s, tolerance).point);
                Self { from: start, element: Element::Line { to: end } }
            }
            Element::Arc { centre, sweep } => {
                let radius = self.from.distance(centre);
                let part = (to - from) / radius * sweep.signum();
                let start = self.at_length(from, tolerance).point;
                Self { from: start, element: Element::Arc { centre, sweep: part } }
            }
            Element::Cubic { c1, c2, to: end } => {
                let curve = CubicBez::new(self.from, c1, c2, end);
                let [first, last] = [from, to].map(|s| curve.inv_arclen(s, tolerance));
                let part = curve.subsegment(first..last);
                Self { from: part.p0, element: Element::Cubic { c1: part.p1, c2: part.p2, to: part.p3 } }
            }
        }
    }

    /// Unit tangent at the start.
    pub fn start_tangent(&self) -> Vec2 {
        self.at_length(0.0, 1e-6).tangent
    }

    /// Unit tangent at the end.
    pub fn end_tangent(&self) -> Vec2 {
        -Piece { from: self.end(), element: self.reversed_element() }.start_tangent()
    }

    /// The element that leads from this piece's end back to its start.
    fn reversed_element(&self) -> Element {
        match self.element {
            Element::Line { .. } => Element::Line { to: self.from },
            Element::Arc { centre, sweep } => Element::Arc { centre, sweep: -sweep },
            Element::Cubic { c1, c2, .. } => Element::Cubic { c1: c2, c2: c1, to: self.from },
        }
    }

    /// How many equal steps of the parameter keep the chords within `tolerance`.
    ///
    /// For a cubic: Wang's bound n ≥ √(6·max‖Δ²P‖/(8·tol)) on the second differences of the control points (Wang
    /// 1984; Goldman, *Pyramid Algorithms*, §5.6.3). For an arc: the sagitta r(1 − cos(φ/2)).
    fn flat_steps(&self, tolerance: f64) -> usize {
        const MOST: f64 = 1e6; // a bound, not a wish: tolerance 0 must not hang
        let n = match self.element {
            Element::Line { .. } => 1.0,
            Element::Arc { centre, sweep } => {
                let radius = self.from.distance(centre).max(1e-300);
                let step = 2.0 * acos(1.0 - (tolerance / radius).min(1.0));
                (sweep.abs() / step.max(1e-6)).ceil()
            }
            Element::Cubic { c1, c2, to } => {
                let bend = ((self.from - c1) + (c2 - c1)).hypot().max(((c1 - c2) + (to - c2)).hypot());
                (0.75 * bend / tolerance.max(1e-300)).sqrt().ceil()
            }
        };
        n.clamp(1.0, MOST) as usize
    }
}

fn rotate(v: Vec2, angle_rad: f64) -> Vec2 {
    let (s, c) = sin_cos(angle_rad);
    Vec2::new(c * v.x - s * v.y, s * v.x + c * v.y)
}

fn arc_at(from: Point, centre: Point, turn: f64, s: f64) -> PathPoint {
    let radius = from.distance(centre);
    let arm = rotate(from - centre, s / radius * turn);
    let tangent = Vec2::new(-arm.y, arm.x) * (turn / radius);
    PathPoint { point: centre + arm, tangent, curvature: -arm / (radius * radius) }
}

/// Frenet quantities of a cubic at parameter `t`. Where the derivative vanishes (a control point on an end), the
/// direction is taken a little further inside.
fn cubic_at(curve: CubicBez, t: f64) -> PathPoint {
    let first = curve.deriv();
    let mut d = first.eval(t).to_vec2();
    let mut inside = t;
    let size = (curve.p3 - curve.p0).hypot() + (curve.p1 - curve.p0).hypot();
    if d.hypot() <= 1e-6 * size {
        inside = if t < 0.5 { t + 1e-3 } else { t - 1e-3 };
        d = first.eval(inside).to_vec2();
    }
    let dd = first.deriv().eval(inside).to_vec2();
    let speed = d.hypot().max(1e-300);
    let tangent = d / speed;
    let normal = Vec2::new(-tangent.y, tangent.x);
    let curvature = normal * (normal.dot(dd) / (speed * speed));
    PathPoint { point: curve.eval(t), tangent, curvature }
}

#[cfg(test)]
mod tests {
    use tracelight_maths::planar;

    use super::*;
    use std::f64::consts::PI;

    fn quarter() -> Path {
        let mut path = Path::new(Point::new(1.0, 0.0));
        path.push(Element::Arc { centre: Point::ORIGIN, sweep: PI / 2.0 });
        path
    }

    #[test]
    fn an_arc_has_its_length_end_and_curvature() {
        let path = quarter();
        assert!((path.length(1e-9) - PI / 2.0).abs() < 1e-12);
        assert!(path.end().distance(Point::new(0.0, 1.0)) < 1e-12);
        let p = path.pieces().next().unwrap().at_length(PI / 4.0, 1e-9);
        assert!((p.curvature.hypot() - 1.0).abs() < 1e-12);
        assert!(p.tangent.dot(p.curvature).abs() < 1e-12);
        assert!((planar::heading(p.tangent) - 3.0 * PI / 4.0).abs() < 1e-12);
    }

    #[test]
    fn flattening_stays_within_its_tolerance() {
        let path = quarter();
        for tolerance in [1e-2, 1e-4] {
            let points = path.flatten(tolerance);
            for pair in points.windows(2) {
                let middle = pair[0].midpoint(pair[1]).to_vec2().hypot();
                assert!(1.0 - middle <= tolerance, "{middle}");
            }
        }
    }

    #[test]
    fn reversing_twice_is_the_same_path() {
        let mut path = quarter();
        path.push(Element::Cubic {
            c1: Point::new(-1.0, 1.0),
            c2: Point::new(-2.0, 0.0),
            to: Point::new(-2.0, -1.0),
        });
        path.line_to(Point::new(0.0, -3.0));
        let back = path.reversed();
        assert!(back.end().distance(path.start()) < 1e-12);
        assert!((back.length(1e-9) - path.length(1e-9)).abs() < 1e-8);
        let again = back.reversed();
        assert!(again.end().distance(path.end()) < 1e-12);
    }

    #[test]
    fn a_mirrored_arc_turns_the_other_way() {
        let path = quarter().transformed(Affine::FLIP_Y);
        assert!(path.end().distance(Point::new(0.0, -1.0)) < 1e-12);
    }

    #[test]
    fn a_closed_path_may_start_anywhere() {
        let square = [(0., 0.), (1., 0.), (1., 1.), (0., 1.)].map(|(x, y)| Point::new(x, y));
        let path = Path::polyline(&square, true).unwrap();
        let moved = path.started_at(2);
        assert_eq!(moved.start(), Point::new(1.0, 1.0));
        assert_eq!(moved.end(), moved.start());
        assert!((moved.length(1e-9) - 4.0).abs() < 1e-12);
    }

    #[test]
    fn what_is_left_of_a_path_has_the_length_that_is_left() {
        let mut path = Path::new(Point::new(0.0, 0.0));
        path.line_to(Point::new(3.0, 0.0));
        path.push(Element::Arc { centre: Point::new(3.0, 1.0), sweep: PI });
        path.close();
        let whole = path.length(1e-9);
        for from in [0.0, 1.0, 3.0, 4.5, whole - 0.5] {
            let left = path.after(from, 1e-9).unwrap();
            assert!((left.length(1e-9) - (whole - from)).abs() < 1e-6, "{from}");
            assert!(!left.is_closed() && left.pieces().last().unwrap().end().distance(path.start()) < 1e-9);
        }
        assert!(path.after(whole, 1e-9).is_none());
    }
}
