use std::f64::consts::{PI, TAU};

use tracelight_maths::{planar, sin};
use tracelight_stroke::{Drawing, Element, Path, Point, Stroke, Vec2};

use super::spline::{points, through};

/// Width of the pen in all line drawings but the house, pixels.
pub(crate) const PEN_PX: f64 = 5.0;

/// A five-pointed star, standing on two tips.
pub(crate) fn star() -> Drawing {
    let centre = Point::new(320.0, 258.0);
    // inner over outer radius of the pentagram: its sides continue across the middle
    let inner = sin(PI / 10.0) / sin(3.0 * PI / 10.0);
    let tip = |k: usize| {
        let radius = if k.is_multiple_of(2) { 212.0 } else { 212.0 * inner };
        centre + planar::direction(PI * k as f64 / 5.0 - PI / 2.0) * radius
    };
    let ring: Vec<_> = (0..10).map(tip).collect();
    let pairs: Vec<_> = ring.iter().map(|p| (p.x, p.y)).collect();
    Drawing { strokes: pen(PEN_PX, [polygon(&pairs)]) }
}

/// A circle, a square and a triangle, side by side.
pub(crate) fn shapes() -> Drawing {
    let square = polygon(&[(245.0, 165.0), (395.0, 165.0), (395.0, 315.0), (245.0, 315.0)]);
    let triangle = polygon(&[(515.0, 162.0), (605.0, 315.0), (425.0, 315.0)]);
    Drawing { strokes: pen(PEN_PX, [circle((125.0, 240.0), 78.0), square, triangle]) }
}

/// Paths drawn with a pen of one width.
pub(crate) fn pen(width: f64, paths: impl IntoIterator<Item = Path>) -> Vec<Stroke> {
    paths.into_iter().map(|path| Stroke { pen: Some(width), ..Stroke::new(path) }).collect()
}

/// A closed polygon.
pub(crate) fn polygon(corners: &[(f64, f64)]) -> Path {
    let mut path = line(corners);
    path.close();
    path
}

/// An open polyline.
pub(crate) fn line(corners: &[(f64, f64)]) -> Path {
    let mut path = Path::new(Point::from(corners[0]));
    for &corner in &corners[1..] {
        path.line_to(Point::from(corner));
    }
    path
}

/// A smooth open curve through points.
pub(crate) fn curve(pairs: &[(f64, f64)]) -> Path {
    through(&points(pairs), false)
}

/// A smooth closed curve through points.
pub(crate) fn ring(pairs: &[(f64, f64)]) -> Path {
    through(&points(pairs), true)
}

/// A full circle, begun on the right.
pub(crate) fn circle(centre: (f64, f64), radius: f64) -> Path {
    let centre = Point::from(centre);
    let mut path = Path::new(centre + Vec2::new(radius, 0.0));
    path.push(Element::Arc { centre, sweep: TAU });
    path.close();
    path
}
