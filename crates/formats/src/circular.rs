//! Circles hidden in other descriptions: in bulges, and in cubics that drawing programs put in their place.

use std::f64::consts::{PI, TAU};

use tracelight_maths::{atan, atan2, tan};
use tracelight_stroke::{Element, Piece, Point, Vec2};

/// The way from one point to another along a circle by `sweep` radians; a line where that is straight.
pub(crate) fn arc_between(from: Point, to: Point, sweep: f64) -> Element {
    let chord = to - from;
    // the centre lies on the bisector, ½·chord·cot(½·sweep) to the left of the chord
    let height = 0.5 / tan(0.5 * sweep);
    let centre = from.midpoint(to) + Vec2::new(-chord.y, chord.x) * height;
    match height.abs() < STRAIGHT && sweep != 0.0 && chord != Vec2::ZERO {
        true => Element::Arc { centre, sweep },
        false => Element::Line { to },
    }
}

/// Chords this far from their centre, in chords, are straight to a ten-millionth of their length.
const STRAIGHT: f64 = 1e6;

/// The sweep of a DXF bulge: the tangent of a quarter of it, positive anticlockwise.
pub(crate) fn sweep_of_bulge(bulge: f64) -> f64 {
    4.0 * atan(bulge)
}

/// The circular arc that a cubic stands for, if it is one to `noise`.
///
/// Whoever turns arcs into cubics puts the control points on the end tangents, 4/3·tan(θ/4) radii from the ends
/// (Goldapp, "Approximation of circular arcs by cubic polynomials", 1991). So these two points are computed from the
/// ends and the turn between the tangents, and must be where they are found.
pub(crate) fn arc_of_cubic(piece: &Piece, noise: f64) -> Option<Element> {
    const LEAST_RAD: f64 = 0.05; // what turns less is as good as straight, and its centre as good as anywhere
    const MOST_RAD: f64 = 0.55 * PI; // a quarter with some slack: longer ones are no good circles
    let Element::Cubic { c1, c2, to } = piece.element else { return None };
    let (out, back) = (c1 - piece.from, to - c2);
    let sweep = atan2(out.cross(back), out.dot(back));
    let arc = arc_between(piece.from, to, sweep);
    let Element::Arc { centre, .. } = arc else { return None };
    let arm = piece.from - centre;
    // beyond a thousandth of the radius, noise would find circles in anything
    let noise = noise.max(FIT * arm.hypot()).min(1e-3 * arm.hypot());
    let handle = 4.0 / 3.0 * tan(0.25 * sweep);
    let wanted_c1 = piece.from + quarter_turn(arm) * handle;
    let wanted_c2 = to - quarter_turn(to - centre) * handle;
    let fits = wanted_c1.distance(c1) <= noise && wanted_c2.distance(c2) <= noise;
    (fits && (LEAST_RAD..=MOST_RAD).contains(&sweep.abs())).then_some(arc)
}

/// How close a cubic's control points are to those of an arc, as a share of the radius.
const FIT: f64 = 1e-6;

fn quarter_turn(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}

/// Two arcs that follow each other as one, if they are of one circle to `noise` and no more than one turn together.
pub(crate) fn joined(first: &Piece, second: &Element, noise: f64) -> Option<Element> {
    let (Element::Arc { centre: a, sweep: s }, Element::Arc { centre: b, sweep: t }) =
        (first.element, *second)
    else {
        return None;
    };
    let sweep = s + t;
    let one = a.distance(b) <= noise && s * t > 0.0 && sweep.abs() <= TAU + WHOLE_TURN;
    let nearly_whole = (sweep.abs() - TAU).abs() <= WHOLE_TURN;
    let sweep = if nearly_whole { TAU.copysign(sweep) } else { sweep };
    let centre = a.lerp(b, t / (s + t));
    one.then_some(Element::Arc { centre, sweep })
}

/// What four quarters from single precision may miss a whole turn by, rad.
const WHOLE_TURN: f64 = 1e-4;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bulge_of_one_is_half_a_circle() {
        let (from, to) = (Point::new(0.0, 0.0), Point::new(2.0, 0.0));
        let Element::Arc { centre, sweep } = arc_between(from, to, sweep_of_bulge(1.0)) else { panic!() };
        assert!(centre.distance(Point::new(1.0, 0.0)) < 1e-15 && (sweep - PI).abs() < 1e-15);
        let piece = Piece { from, element: arc_between(from, to, sweep_of_bulge(-0.2)) };
        assert!(piece.end().distance(to) < 1e-12);
        assert!(piece.at(0.5).y > 0.0, "a negative bulge turns clockwise, over the chord");
        assert_eq!(arc_between(from, to, 0.0), Element::Line { to });
    }

    #[test]
    fn a_quarter_circle_is_found_in_its_cubic_and_nothing_else() {
        let k = 4.0 / 3.0 * (PI / 8.0).tan();
        let cubic = |k: f64| Piece {
            from: Point::new(5.0, 0.0),
            element: Element::Cubic {
                c1: Point::new(5.0, 5.0 * k),
                c2: Point::new(5.0 * k, 5.0),
                to: Point::new(0.0, 5.0),
            },
        };
        let Some(Element::Arc { centre, sweep }) = arc_of_cubic(&cubic(k), 0.0) else { panic!() };
        assert!(centre.to_vec2().hypot() < 1e-12 && (sweep - PI / 2.0).abs() < 1e-12);
        assert_eq!(arc_of_cubic(&cubic(k + 1e-3), 0.0), None);
        assert_eq!(arc_of_cubic(&cubic(0.0), 0.0), None);
    }
}
