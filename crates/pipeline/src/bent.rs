//! Strokes from their sheet to the target under a map that keeps lines straight, but neither angles nor lengths.

use tracelight_aim::SheetMap;
use tracelight_stroke::{Drawing, Element, Path, Piece, Point, Stroke, Vec2};

/// Furthest that a bent arc or curve may be from where it belongs, m: a hundredth of a millimetre.
pub(crate) const BENT_TOLERANCE_M: f64 = 1e-5;

/// A curve is halved so often at most; each time its error falls to a sixteenth.
const MOST_HALVINGS: u32 = 16;

/// Places of a curve at which its error is looked at, as shares of it: between its ends an error of the fourth order is largest in the middle.
const LOOKED_AT: [f64; 7] = [0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875];

/// A drawing by a map; lines stay lines, arcs and cubics become cubics within a tolerance. `None` if some of it lies beyond the horizon.
pub(crate) fn bent(drawing: &Drawing, map: &SheetMap, unit_m: f64) -> Option<Drawing> {
    let moved = |stroke: &Stroke| {
        let path = path(&stroke.path, map)?;
        Some(Stroke { pen: stroke.pen.map(|pen| pen * unit_m), ..stroke.along(path) })
    };
    Some(Drawing { strokes: drawing.strokes.iter().map(moved).collect::<Option<_>>()? })
}

fn path(path: &Path, map: &SheetMap) -> Option<Path> {
    let mut bent = Path::new(map.apply(path.start())?);
    for piece in path.pieces() {
        match piece.element {
            Element::Line { to } => bent.push(Element::Line { to: map.apply(to)? }),
            _ => curve(&mut bent, &piece, map, (0.0, 1.0), MOST_HALVINGS)?,
        }
    }
    if path.is_closed() {
        bent.close();
    }
    Some(bent)
}

/// Appends a part of a piece, between two of its parameters.
fn curve(
    bent: &mut Path,
    piece: &Piece,
    map: &SheetMap,
    (from, to): (f64, f64),
    halvings: u32,
) -> Option<()> {
    let third = (to - from) / 3.0;
    let [(a, along_a), (b, along_b)] = [motion(piece, map, from)?, motion(piece, map, to)?];
    let cubic = Element::Cubic { c1: a + along_a * third, c2: b - along_b * third, to: b };
    let fitted = Piece { from: a, element: cubic };
    let off = |share: &f64| {
        let truly = map.apply(piece.at(from + share * (to - from)))?;
        Some(truly.distance(fitted.at(*share)))
    };
    let offs = LOOKED_AT.iter().map(off).collect::<Option<Vec<f64>>>()?;
    if halvings == 0 || offs.iter().all(|off| *off <= BENT_TOLERANCE_M) {
        bent.push(cubic);
        return Some(());
    }
    let middle = 0.5 * (from + to);
    curve(bent, piece, map, (from, middle), halvings - 1)?;
    curve(bent, piece, map, (middle, to), halvings - 1)
}

/// Where a place of a piece comes to lie, and its derivative there by the piece's parameter.
fn motion(piece: &Piece, map: &SheetMap, t: f64) -> Option<(Point, Vec2)> {
    let at = piece.at(t);
    let along = match piece.element {
        Element::Line { to } => to - piece.from,
        Element::Arc { centre, sweep } => {
            let arm = at - centre;
            Vec2::new(-arm.y, arm.x) * sweep
        }
        Element::Cubic { c1, c2, to } => {
            let u = 1.0 - t;
            ((c1 - piece.from) * (u * u) + (c2 - c1) * (2.0 * u * t) + (to - c2) * (t * t)) * 3.0
        }
    };
    Some((map.apply(at)?, map.carry(at, along)?))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use tracelight_aim::{Mark, MarkedSheet, marked};
    use tracelight_stroke::distance_to_segment;

    use super::*;

    /// A wall hit at a slant: one side of a sheet of 1000 units is drawn 1.5 times as large as the other.
    fn keystone() -> SheetMap {
        let corners = [(0.0, 0.0), (1000.0, 0.0), (1000.0, 700.0), (0.0, 700.0)].map(Point::from);
        let wall = [(-0.5, 0.4), (0.6, 0.6), (0.6, -0.5), (-0.5, -0.33)].map(Point::from);
        let marks: Vec<Mark> =
            corners.into_iter().zip(wall).map(|(sheet, wall)| Mark { sheet, wall }).collect();
        let sheet = MarkedSheet { unit_m: None, rotation_rad: 0.0, flip: false, corners };
        marked(&marks, &sheet).unwrap().map
    }

    #[test]
    fn bent_curves_keep_to_where_each_of_their_points_belongs() {
        let map = keystone();
        let mut path = Path::new(Point::new(900.0, 350.0));
        path.push(Element::Arc { centre: Point::new(500.0, 350.0), sweep: TAU });
        path.close();
        let mut wave = Path::new(Point::new(10.0, 20.0));
        wave.push(Element::Cubic {
            c1: (800.0, 0.0).into(),
            c2: (0.0, 700.0).into(),
            to: (990.0, 690.0).into(),
        });
        wave.line_to(Point::new(20.0, 650.0));
        let drawing = Drawing { strokes: vec![Stroke::new(path), Stroke::new(wave)] };
        let bent = bent(&drawing, &map, 1e-3).unwrap();
        for (stroke, moved) in drawing.strokes.iter().zip(&bent.strokes) {
            let lines = moved.path.flatten(1e-7);
            assert_eq!(moved.path.is_closed(), stroke.path.is_closed());
            for piece in stroke.path.pieces() {
                for k in 0..=200 {
                    let p = map.apply(piece.at(f64::from(k) / 200.0)).unwrap();
                    let off = lines
                        .windows(2)
                        .map(|w| distance_to_segment(p, w[0], w[1]))
                        .fold(f64::INFINITY, f64::min);
                    assert!(off <= 1.1 * BENT_TOLERANCE_M, "{off:e} m");
                }
            }
        }
        assert!(bent.strokes[0].path.elements().len() <= 64, "{}", bent.strokes[0].path.elements().len());
        assert!(matches!(bent.strokes[1].path.elements().last(), Some(Element::Line { .. })));
    }
}
