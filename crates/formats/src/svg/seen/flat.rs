//! Curves as chords that know where on the curve they lie.

use tracelight_stroke::{Element, Path, Piece, Point};

/// A corner of a path's chords.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner {
    pub(crate) point: Point,
    /// Number of the path's element that the chord to this corner stands for.
    pub(crate) element: u32,
    /// The element's parameter here.
    pub(crate) t: f64,
}

/// Chords no finer than this share of a curve's length: a hostile curve must not become a million of them.
const FINEST: f64 = 5e-6;

/// Chords within `tolerance` of a path, from its start to its end; a closed one ends where it starts.
pub(crate) fn chords(path: &Path, tolerance: f64) -> Vec<Corner> {
    let mut corners = vec![Corner { point: path.start(), element: 0, t: 0.0 }];
    for (number, piece) in path.pieces().enumerate() {
        let element = number as u32;
        if let Element::Line { to } = piece.element {
            corners.push(Corner { point: to, element, t: 1.0 });
        } else {
            let points = points(&piece, tolerance);
            let steps = points.len().saturating_sub(1).max(1) as f64;
            let corner = |(i, &point): (usize, &Point)| Corner { point, element, t: i as f64 / steps };
            corners.extend(points.iter().enumerate().skip(1).map(corner));
        }
    }
    if let (true, Some(last)) = (path.is_closed(), corners.last_mut()) {
        last.point = path.start();
    }
    corners
}

fn points(piece: &Piece, tolerance: f64) -> Vec<Point> {
    let reach = match piece.element {
        Element::Line { to } => piece.from.distance(to),
        Element::Arc { centre, sweep } => piece.from.distance(centre) * sweep.abs(),
        Element::Cubic { c1, c2, to } => piece.from.distance(c1) + c1.distance(c2) + c2.distance(to),
    };
    let mut alone = Path::new(piece.from);
    alone.push(piece.element);
    alone.flatten(tolerance.max(FINEST * reach))
}
