//! Clips strokes to the image.

use std::f64::consts::PI;

use tracelight_maths::tan;
use tracelight_stroke::{Element, Path, Piece, Point};

/// The path with whatever lies outside `[0, width] × [0, height]` moved to the border. Lines and cubics lie within the
/// hull of their points, so it is these that are moved; arcs that leave the image become cubics first.
pub(crate) fn inside(path: &Path, width: f64, height: f64) -> Path {
    let clamp = |p: Point| Point::new(p.x.clamp(0.0, width), p.y.clamp(0.0, height));
    let mut kept = Path::new(clamp(path.start()));
    for piece in path.pieces() {
        match piece.element {
            Element::Line { to } => kept.line_to(clamp(to)),
            Element::Cubic { c1, c2, to } => {
                kept.push(Element::Cubic { c1: clamp(c1), c2: clamp(c2), to: clamp(to) });
            }
            Element::Arc { .. } if is_within(&piece, width, height) => kept.push(piece.element),
            Element::Arc { centre, sweep } => {
                cubics(&piece, centre, sweep).into_iter().for_each(|[c1, c2, to]| {
                    kept.push(Element::Cubic { c1: clamp(c1), c2: clamp(c2), to: clamp(to) })
                })
            }
        }
    }
    if path.is_closed() {
        kept.close();
    }
    kept
}

/// Chords of an arc keep this near to it, px, when it is asked whether it leaves the image.
const CHORD_PX: f64 = 0.01;

fn is_within(arc: &Piece, width: f64, height: f64) -> bool {
    let mut path = Path::new(arc.from);
    path.push(arc.element);
    let within = |v: f64, side: f64| (CHORD_PX..=side - CHORD_PX).contains(&v);
    path.flatten(CHORD_PX).iter().all(|p| within(p.x, width) && within(p.y, height))
}

/// An arc as cubics whose inner points lie no more than 0.1 px outside it: r·(θ/3)²/2 for parts that turn by θ.
fn cubics(arc: &Piece, centre: Point, sweep: f64) -> Vec<[Point; 3]> {
    let radius = arc.from.distance(centre).max(1e-9);
    let most = (3.0 * (0.2 / radius).sqrt()).min(0.25 * PI);
    let parts = (sweep.abs() / most).ceil().clamp(1.0, 1e4);
    let handle = 4.0 / 3.0 * tan(0.25 * sweep / parts);
    let at = |i: f64| arc.at(i / parts);
    let ahead = |p: Point| (p - centre).turn_90() * handle;
    let part = |i: usize| {
        let (from, to) = (at(i as f64), at(i as f64 + 1.0));
        [from + ahead(from), to - ahead(to), to]
    };
    (0..parts as usize).map(part).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_that_leaves_the_image_is_brought_back_and_stays_closed() {
        let mut path = Path::new(Point::new(25.0, 10.0));
        path.push(Element::Arc { centre: Point::new(15.0, 10.0), sweep: PI });
        path.push(Element::Cubic {
            c1: Point::new(-4.0, 9.0),
            c2: Point::new(9.0, -3.0),
            to: Point::new(25.0, 10.0),
        });
        path.close();
        let kept = inside(&path, 30.0, 19.0);
        assert!(kept.is_closed());
        assert!(
            kept.flatten(0.01).iter().all(|p| (0.0..=30.0).contains(&p.x) && (0.0..=19.0).contains(&p.y))
        );
        let off = |p: &Point| (p.distance(Point::new(15.0, 10.0)) - 10.0).abs();
        let lower: Vec<Point> =
            kept.flatten(0.01).into_iter().filter(|p| (10.0..18.0).contains(&p.y) && p.x > 6.0).collect();
        assert!(lower.iter().all(|p| off(p) < 0.2 || p.y < 11.0), "the rest of the arc moved");
    }

    #[test]
    fn a_path_inside_is_left_as_it_is() {
        let mut path = Path::new(Point::new(25.0, 12.0));
        path.push(Element::Arc { centre: Point::new(15.0, 12.0), sweep: 2.0 * PI });
        path.close();
        assert_eq!(inside(&path, 30.0, 30.0), path);
    }
}
