//! A drawing with everything in it.

use std::f64::consts::TAU;

use tracelight_stroke::{Colour, Drawing, Element, Path, Point, Stroke};

/// Lines, an arc, a cubic, a circle; two layers.
pub(crate) fn plate() -> Drawing {
    let mut mixed = Path::new(Point::new(-0.1, -0.05));
    mixed.line_to(Point::new(0.0, -0.05));
    mixed.push(Element::Arc { centre: Point::ORIGIN, sweep: 2.0 });
    let (c1, c2, to) = (Point::new(0.0, 0.02), Point::new(-0.1, 0.08), Point::new(-0.09, 0.03));
    mixed.push(Element::Cubic { c1, c2, to });
    let mut circle = Path::new(Point::new(0.03, 0.02));
    circle.push(Element::Arc { centre: Point::new(0.02, 0.02), sweep: TAU });
    circle.close();
    let look = |path, layer: &str| Stroke {
        layer: Some(layer.into()),
        colour: Some(Colour::new(1, 2, 3)),
        ..Stroke::new(path)
    };
    Drawing { strokes: vec![look(mixed, "one"), look(circle, "two")] }
}
