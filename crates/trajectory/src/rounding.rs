//! Rounds corners.

use tracelight_maths::{sin, tan};
use tracelight_stroke::{Element, Piece, turn_rad};

/// The curve that leads from the end of one piece to the start of the next, touching both: between straight lines cut
/// back equally, a circle's arc but for 3 parts in 10 000 of its radius.
pub(crate) fn rounding(before: &Piece, after: &Piece) -> Piece {
    let (from, to) = (before.end(), after.from);
    let (incoming, outgoing) = (before.end_tangent(), after.start_tangent());
    let turn = turn_rad(incoming, outgoing);
    let radius = 0.5 * from.distance(to) / sin(0.5 * turn).max(1e-12);
    let handle = 4.0 / 3.0 * tan(0.25 * turn) * radius;
    Piece { from, element: Element::Cubic { c1: from + incoming * handle, c2: to - outgoing * handle, to } }
}

#[cfg(test)]
mod tests {
    use tracelight_maths::planar;

    use super::*;
    use tracelight_stroke::{Point, Vec2};

    #[test]
    fn a_rounded_corner_keeps_to_its_distance() {
        const TOLERANCE_M: f64 = 2e-4;
        for degrees in [10.0f64, 45.0, 90.0, 135.0, 170.0] {
            let turn = degrees.to_radians();
            let cut = TOLERANCE_M / (0.25 * turn).tan();
            let (out, corner) = (planar::direction(turn), Point::new(0.1, 0.0));
            let line = |from, to| Piece { from, element: Element::Line { to } };
            let before = line(Point::ORIGIN, corner - Vec2::new(cut, 0.0));
            let after = line(corner + out * cut, corner + out * 0.1);
            let curve = rounding(&before, &after);
            let away = (0..=1000).map(|i| curve.at(f64::from(i) / 1000.0).distance(corner));
            let nearest = away.fold(f64::INFINITY, f64::min);
            assert!((nearest / TOLERANCE_M - 1.0).abs() < 0.03, "{degrees}°: {nearest} m");
        }
    }
}
