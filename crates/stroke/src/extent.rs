use kurbo::{CubicBez, ParamCurveExtrema, Rect, Vec2};
use tracelight_maths::atan2;

use crate::path::{Element, Path, Piece};
use crate::stroke::Drawing;

/// The smallest upright rectangle round a drawing, exact for lines, arcs and cubics; `None` for an empty one.
#[must_use]
pub fn extent(drawing: &Drawing) -> Option<Rect> {
    extent_of(drawing.strokes.iter().map(|stroke| &stroke.path))
}

/// The smallest upright rectangle round paths; `None` for none.
#[must_use]
pub fn extent_of<'a>(paths: impl IntoIterator<Item = &'a Path>) -> Option<Rect> {
    paths.into_iter().flat_map(Path::pieces).map(|piece| of_piece(&piece)).reduce(|a, b| a.union(b))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stroke::Stroke;
    use kurbo::Point;
    use std::f64::consts::PI;

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
