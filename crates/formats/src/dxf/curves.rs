//! Paths under the transforms that DXF knows, and the curves that come from them.

use std::f64::consts::{FRAC_PI_4, TAU};

use tracelight_maths::{cos, hypot, planar, sin, tan};
use tracelight_stroke::{Affine, Element, Path, Piece, Point};

use super::groups::Record;
use crate::FormatError;

/// A path moved by any affine map. A similarity keeps arcs; another one makes cubics of them, within 5e-6 of their
/// radius.
pub(super) fn moved(path: &Path, by: Affine) -> Path {
    if is_similarity(by) {
        return path.transformed(by);
    }
    let mut out = Path::new(by * path.start());
    for piece in path.pieces() {
        match piece.element {
            Element::Line { to } => out.push(Element::Line { to: by * to }),
            Element::Cubic { c1, c2, to } => {
                out.push(Element::Cubic { c1: by * c1, c2: by * c2, to: by * to })
            }
            Element::Arc { centre, sweep } => {
                for [c1, c2, to] in cubics(&piece, centre, sweep) {
                    out.push(Element::Cubic { c1: by * c1, c2: by * c2, to: by * to });
                }
            }
        }
    }
    if path.is_closed() {
        out.close();
    }
    out
}

/// Whether a map keeps circles round, to a millionth.
fn is_similarity(map: Affine) -> bool {
    let [a, b, c, d, ..] = map.as_coeffs();
    let size = hypot(a, b).max(hypot(c, d));
    let (like, unlike) = (hypot(a - d, b + c), hypot(a + d, b - c));
    size > 0.0 && like.min(unlike) <= 1e-6 * size
}

/// An arc as cubics of an eighth of a turn at most. Their error falls with the sixth power of the angle: 2.7e-4 radii
/// for a quarter of a turn, 4.3e-6 for an eighth (Goldapp, "Approximation of circular arcs by cubic polynomials", 1991).
fn cubics(arc: &Piece, centre: Point, sweep: f64) -> impl Iterator<Item = [Point; 3]> {
    let parts = (sweep.abs() / FRAC_PI_4).ceil().clamp(1.0, 16.0) as usize;
    let handle = 4.0 / 3.0 * tan(0.25 * sweep / parts as f64);
    let arc = *arc;
    (0..parts).map(move |i| {
        let at = |i: usize| arc.at(i as f64 / parts as f64);
        let tangent = |p: Point| planar::rotation(std::f64::consts::FRAC_PI_2) * (p - centre).to_point();
        let (from, to) = (at(i), at(i + 1));
        [from + tangent(from).to_vec2() * handle, to - tangent(to).to_vec2() * handle, to]
    })
}

/// From an entity's own plane to the world seen from above: Autodesk's "arbitrary axis algorithm". A plane that looks
/// down mirrors; one that leans is foreshortened.
///
/// # Errors
/// A direction that is no number.
pub(super) fn world_from_plane(record: &Record, elevation: f64) -> Result<Affine, FormatError> {
    let normal = [record.number_or(210, 0.0)?, record.number_or(220, 0.0)?, record.number_or(230, 1.0)?];
    let Some(n) = unit(normal) else { return Ok(Affine::IDENTITY) };
    if n == [0.0, 0.0, 1.0] {
        return Ok(Affine::IDENTITY);
    }
    let near_z = n[0].abs() < 1.0 / 64.0 && n[1].abs() < 1.0 / 64.0;
    let reference = if near_z { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] };
    let x = unit(cross(reference, n)).unwrap_or([1.0, 0.0, 0.0]);
    let y = cross(n, x);
    Ok(Affine::new([x[0], x[1], y[0], y[1], n[0] * elevation, n[1] * elevation]))
}

fn unit(v: [f64; 3]) -> Option<[f64; 3]> {
    let length = hypot(hypot(v[0], v[1]), v[2]);
    (length > 0.0).then(|| v.map(|c| c / length))
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Part of the unit circle from one angle to another, anticlockwise; the whole of it where they are the same.
pub(super) fn unit_arc(from_rad: f64, to_rad: f64) -> Path {
    let sweep = (to_rad - from_rad).rem_euclid(TAU);
    // what is a rounding error off a whole turn is one: nobody draws an arc of a billionth
    let is_whole = !(1e-9..=TAU - 1e-9).contains(&sweep);
    let sweep = if is_whole { TAU } else { sweep };
    let mut path = Path::new(Point::new(cos(from_rad), sin(from_rad)));
    path.push(Element::Arc { centre: Point::ORIGIN, sweep });
    if is_whole {
        path.close();
    }
    path
}

/// Whether a path is longer than nothing.
pub(super) fn has_length(path: &Path) -> bool {
    path.pieces().any(|p| match p.element {
        Element::Line { to } => to != p.from,
        Element::Arc { centre, sweep } => centre != p.from && sweep != 0.0,
        Element::Cubic { c1, c2, to } => [c1, c2, to].iter().any(|&c| c != p.from),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ellipse_is_as_exact_as_it_says() {
        let squeezed = Affine::new([3.0, 0.0, 0.5, 0.7, 9.0, -4.0]);
        for (from, to) in [(0.0, 0.0), (0.3, 5.9), (-2.0, 1.0)] {
            let path = moved(&unit_arc(from, to), squeezed);
            assert!(path.pieces().all(|p| matches!(p.element, Element::Cubic { .. })));
            let back = squeezed.inverse();
            for (piece, i) in path.pieces().flat_map(|p| (0..=20).map(move |i| (p, i))) {
                let off = (back * piece.at(f64::from(i) / 20.0)).to_vec2().hypot() - 1.0;
                assert!(off.abs() < 5e-6, "{off}");
            }
        }
    }

    #[test]
    fn a_plane_that_leans_is_foreshortened() {
        let text = b"0\nCIRCLE\n210\n0\n220\n0.6\n230\n0.8\n0\nEOF\n";
        let mut record = Record::default();
        crate::dxf::records::Records::new(text).read(&mut record).unwrap();
        let place = world_from_plane(&record, 0.0).unwrap();
        assert!((place.determinant().abs() - 0.8).abs() < 1e-12, "{place:?}");
    }
}
