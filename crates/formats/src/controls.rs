use tracelight_stroke::{Element, Path, Point};

/// Every point that says where a path's elements go, its start first.
pub(crate) fn controls(path: &Path) -> impl Iterator<Item = Point> + '_ {
    let of = |element: &Element| match *element {
        Element::Line { to } => [to; 3],
        Element::Arc { centre, .. } => [centre; 3],
        Element::Cubic { c1, c2, to } => [c1, c2, to],
    };
    std::iter::once(path.start()).chain(path.elements().iter().flat_map(of))
}
