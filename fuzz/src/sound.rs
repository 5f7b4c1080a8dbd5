use tracelight_formats::{MAX_COORDINATE, Sheet};
use tracelight_stroke::{Element, Path, Point};

/// Points that say where a path goes: ends of elements, control points, middles of arcs.
fn landmarks(path: &Path) -> impl Iterator<Item = Point> + '_ {
    path.pieces().flat_map(|piece| match piece.element {
        Element::Cubic { c1, c2, to } => [piece.from, c1, c2, to],
        Element::Line { to } => [piece.from, to, to, to],
        Element::Arc { .. } => [piece.from, piece.at(1.0 / 3.0), piece.at(2.0 / 3.0), piece.end()],
    })
}

/// What every drawing that a reader hands on has.
pub(crate) fn check_sheet(sheet: &Sheet) {
    assert!(sheet.width > 0.0 && sheet.height > 0.0, "a sheet of {} × {}", sheet.width, sheet.height);
    assert!(sheet.metres_per_unit.is_none_or(|m| m > 0.0 && m.is_finite()), "{:?}", sheet.metres_per_unit);
    assert!(!sheet.drawing.strokes.is_empty(), "a sheet without strokes is an error");
    for stroke in &sheet.drawing.strokes {
        check_path(&stroke.path);
        assert!(stroke.pen.is_none_or(|w| w >= 0.0 && w.is_finite()), "a pen of {:?}", stroke.pen);
        for p in landmarks(&stroke.path) {
            // an arc about a centre that is just within the bound reaches as far again
            let most = 4.0 * MAX_COORDINATE;
            assert!(p.x.abs() <= most && p.y.abs() <= most, "a point at {p:?}");
        }
    }
}

/// What every path has: a piece at least, finite, and back at its start where it says so.
pub(crate) fn check_path(path: &Path) {
    assert!(!path.elements().is_empty(), "a path without elements");
    let mut size = path.start().to_vec2().hypot();
    for p in landmarks(path) {
        assert!(p.is_finite(), "a path through {p:?}");
        size = size.max(p.to_vec2().hypot());
    }
    let end = path.pieces().last().map(|p| p.end());
    if path.is_closed() {
        let gap = end.map_or(f64::INFINITY, |end| end.distance(path.start()));
        assert!(gap <= 1e-6 * size.max(1e-3), "a closed path that misses its start by {gap}");
    }
}
