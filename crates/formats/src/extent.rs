use kurbo::{CubicBez, ParamCurveExtrema, Rect};
use tracelight_maths::atan2;
use tracelight_stroke::{Drawing, Element, Piece, Point, Vec2};

/// The smallest upright rectangle round a drawing, exact for lines, arcs and cubics; `None` for an empty one.
pub fn extent(drawing: &Drawing) -> Option<Rect> {
    let pieces = drawing.strokes.iter().flat_map(|s| s.path.pieces());
    pieces.map(|p| of_piece(&p)).reduce(|a, b| a.union(b))
}

fn of_piece(piece: &Piece) -> Rect {
    let ends = Rect::from_points(piece.from, piece.end());
    match piece.element {
        Element::Line { .. } => ends,
        Element::Cubic { c1, c2, to } => CubicBez::new(piece.from, c1, c2, to).bounding_box(),
        Element::Arc { centre, sweep } => {
            let radius = piece.from.distance(centre);
            let axes = [Vec2::new(1., 0.), Vec2::new(0., 1.), Vec2::new(-1., 0.), Vec2::new(0., -1.)];
            let passed = axes.into_iter().filter(|&axis| is_passed(piece.from - centre, axis, sweep));
            passed.fold(ends, |rect, axis| rect.union_pt(centre + axis * radius))
        }
    }
}

/// Whether an arm that sweeps by an angle passes a direction.
fn is_passed(arm: Vec2, direction: Vec2, sweep: f64) -> bool {
    let ahead = atan2(arm.cross(direction), arm.dot(direction)) * sweep.signum();
    ahead.rem_euclid(std::f64::consts::TAU) <= sweep.abs()
}

/// Every point that says where a path's elements go, its start first.
pub(crate) fn controls(path: &tracelight_stroke::Path) -> impl Iterator<Item = Point> + '_ {
    let of = |element: &Element| match *element {
        Element::Line { to } => [to; 3],
        Element::Arc { centre, .. } => [centre; 3],
        Element::Cubic { c1, c2, to } => [c1, c2, to],
    };
    std::iter::once(path.start()).chain(path.elements().iter().flat_map(of))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;
    use tracelight_stroke::{Path, Stroke};

    #[test]
    fn an_arc_reaches_as_far_as_its_circle_does() {
        let mut path = Path::new(Point::new(1.0, 0.0));
        path.push(Element::Arc { centre: Point::ORIGIN, sweep: -PI });
        let rect = extent(&Drawing { strokes: vec![Stroke::new(path)] }).unwrap();
        let wanted = Rect::new(-1.0, -1.0, 1.0, 0.0);
        assert!(
            (rect.x0 - wanted.x0).abs() + (rect.y0 - wanted.y0).abs() + (rect.y1 - wanted.y1).abs() < 1e-12
        );
        assert_eq!(extent(&Drawing::default()), None);
    }
}
