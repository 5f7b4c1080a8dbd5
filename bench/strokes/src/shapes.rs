//! Paths that figures are made of.

use std::f64::consts::{PI, TAU};

use tracelight_maths::planar;
use tracelight_stroke::{Element, Path, Point};

/// The point at an angle and a distance from another.
pub(crate) fn polar(from: Point, angle: f64, distance: f64) -> Point {
    from + planar::direction(angle) * distance
}

/// A straight line.
pub(crate) fn line(from: Point, to: Point) -> Path {
    let mut path = Path::new(from);
    path.push(Element::Line { to });
    path
}

/// A straight line through a point, to both sides.
pub(crate) fn line_through(middle: Point, angle: f64, before: f64, after: f64) -> Path {
    line(polar(middle, angle + PI, before), polar(middle, angle, after))
}

/// Straight lines from point to point.
pub(crate) fn polyline(points: &[Point], closed: bool) -> Path {
    let mut path = Path::new(points[0]);
    points[1..].iter().for_each(|&p| path.line_to(p));
    if closed {
        path.close();
    }
    path
}

/// A circular arc.
pub(crate) fn arc(centre: Point, radius: f64, from: f64, sweep: f64) -> Path {
    let mut path = Path::new(polar(centre, from, radius));
    path.push(Element::Arc { centre, sweep });
    path
}

/// A whole circle.
pub(crate) fn circle(centre: Point, radius: f64) -> Path {
    let mut path = arc(centre, radius, 0.0, TAU);
    path.close();
    path
}

/// Cubics through `at(t)` at `pieces` + 1 even places from `t0` to `t1`, with its tangents there. Closed if it returns.
pub(crate) fn curve(at: impl Fn(f64) -> Point, t0: f64, t1: f64, pieces: usize) -> Path {
    let step = (t1 - t0) / pieces as f64;
    let tiny = 1e-4 * step;
    let slope = |t: f64| (at(t + tiny) - at(t - tiny)) * (step / (2.0 * tiny) / 3.0);
    let mut path = Path::new(at(t0));
    for i in 0..pieces {
        let (a, b) = (t0 + step * i as f64, t0 + step * (i + 1) as f64);
        path.push(Element::Cubic { c1: at(a) + slope(a), c2: at(b) - slope(b), to: at(b) });
    }
    if at(t0).distance(at(t1)) < 1e-6 {
        path.close();
    }
    path
}

/// An ellipse about the origin.
pub(crate) fn ellipse(a: f64, b: f64) -> Path {
    curve(|t| Point::new(a * t.cos(), b * t.sin()), 0.0, TAU, 16)
}

/// A smooth curve through points: Catmull and Rom, *A class of local interpolating splines*, 1974.
pub(crate) fn spline(points: &[Point], closed: bool) -> Path {
    let n = points.len();
    let point = |i: isize| match closed {
        true => points[i.rem_euclid(n as isize) as usize],
        false => points[i.clamp(0, n as isize - 1) as usize],
    };
    let slope = |i: isize| (point(i + 1) - point(i - 1)) / 6.0;
    let mut path = Path::new(points[0]);
    for i in 0..(if closed { n } else { n - 1 }) as isize {
        path.push(Element::Cubic {
            c1: point(i) + slope(i),
            c2: point(i + 1) - slope(i + 1),
            to: point(i + 1),
        });
    }
    if closed {
        path.close();
    }
    path
}

/// A path that goes on from its own end: straight ahead and along arcs, always tangent.
pub(crate) struct Turtle {
    path: Path,
    heading: f64,
}

impl Turtle {
    pub(crate) fn new(start: Point, heading: f64) -> Self {
        Self { path: Path::new(start), heading }
    }

    pub(crate) fn ahead(mut self, length: f64) -> Self {
        self.path.line_to(polar(self.path.end(), self.heading, length));
        self
    }

    /// Along an arc; a positive sweep turns x towards y.
    pub(crate) fn turn(mut self, radius: f64, sweep: f64) -> Self {
        let centre = polar(self.path.end(), self.heading + sweep.signum() * PI / 2.0, radius);
        self.path.push(Element::Arc { centre, sweep });
        self.heading += sweep;
        self
    }

    /// Changes direction at a corner.
    pub(crate) fn corner(mut self, turn: f64) -> Self {
        self.heading += turn;
        self
    }

    pub(crate) fn path(self) -> Path {
        self.path
    }

    pub(crate) fn closed(mut self) -> Path {
        self.path.close();
        self.path
    }
}

/// The corners of a regular polygon or, with an `inner` radius, of a star.
pub(crate) fn star(points: usize, outer: f64, inner: Option<f64>, from: f64) -> Vec<Point> {
    let radii = [Some(outer), inner];
    let radii: Vec<f64> = radii.into_iter().flatten().collect();
    let corners = points * radii.len();
    let at = |i: usize| polar(Point::ORIGIN, from + TAU * i as f64 / corners as f64, radii[i % radii.len()]);
    (0..corners).map(at).collect()
}
