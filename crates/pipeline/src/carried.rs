//! Strokes under a map that is not affine: from a camera's image to the wall, from a sheet seen at a slant to one seen
//! from straight ahead.

use std::f64::consts::PI;

use tracelight_stroke::{Drawing, FitOptions, Path, Piece, Point, Stroke, fit, turn_rad};

/// Spacing of the points that carry a stroke, px.
const SPACING_PX: f64 = 1.5;
/// How far from those points a stroke may be, px: what tracing leaves to chance.
const OFF_PX: f64 = 0.15;

/// Change of direction from which on a stroke has a corner that stays sharp, rad.
const CORNER_RAD: f64 = 0.35;

/// Strokes in pixels by a map that bends them a little, and under which a pixel is about so long; without those of which
/// some comes to lie nowhere.
#[must_use]
pub fn carried(drawing: &Drawing, scale: f64, map: &dyn Fn(Point) -> Option<Point>) -> Drawing {
    let options = FitOptions { corner_rad: PI, reach: 0.0, ..FitOptions::new(OFF_PX * scale) };
    let moved = |stroke: &Stroke| {
        let path = path(&stroke.path, map, &options)?;
        Some(Stroke { pen: stroke.pen.map(|pen| pen * scale), ..stroke.along(path) })
    };
    Drawing { strokes: drawing.strokes.iter().filter_map(moved).collect() }
}

/// A path, every stretch between corners by itself; `None` if some of it comes to lie nowhere.
fn path(path: &Path, map: &dyn Fn(Point) -> Option<Point>, options: &FitOptions) -> Option<Path> {
    let mut stretches = stretches(path);
    let all = |points: &[Point]| points.iter().map(|point| map(*point)).collect::<Option<Vec<Point>>>();
    let is_smooth = path.is_closed() && !has_corner(path.pieces().last()?, path.pieces().next()?);
    if let ([only], true) = (stretches.as_mut_slice(), is_smooth) {
        only.pop();
        return fit(&all(only)?, true, options);
    }
    let mut carried = Path::new(map(path.start())?);
    for stretch in &stretches {
        // one that is too short for a curve is a line
        match fit(&all(stretch)?, false, options) {
            Some(part) => part.elements().iter().for_each(|element| carried.push(*element)),
            None => carried.line_to(map(*stretch.last()?)?),
        }
    }
    if path.is_closed() {
        carried.close();
    }
    Some(carried)
}

/// Points of a path, in stretches from corner to corner.
fn stretches(path: &Path) -> Vec<Vec<Point>> {
    let mut all = vec![vec![path.start()]];
    let mut before: Option<Piece> = None;
    for piece in path.pieces() {
        if before.is_some_and(|before| has_corner(before, piece)) {
            all.push(vec![piece.from]);
        }
        let count = (piece.length(0.1) / SPACING_PX).ceil().max(1.0) as usize;
        let points = (1..=count).map(|k| piece.at(k as f64 / count as f64));
        all.iter_mut().last().into_iter().for_each(|stretch| stretch.extend(points.clone()));
        before = Some(piece);
    }
    all
}

/// Whether one piece goes on in another direction than the one before ends in.
#[must_use]
pub fn has_corner(before: Piece, after: Piece) -> bool {
    turn_rad(before.end_tangent(), after.start_tangent()) > CORNER_RAD
}
