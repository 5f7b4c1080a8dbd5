//! Paths of the resolved tree as lines on the sheet, and the regions that they paint.

use kurbo::Affine;
use tracelight_stroke::{Path, Point};
use usvg::tiny_skia_path::{self, PathSegment, PathStroker};

use super::seen::{Region, chords};
use crate::pen::Pen;

/// The transform as doubles.
pub(super) fn affine(t: usvg::Transform) -> Affine {
    Affine::new([t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from))
}

/// How much larger things are after a transform.
pub(super) fn scale(at: Affine) -> f64 {
    at.determinant().abs().sqrt()
}

/// What single precision, in which paths are resolved, leaves uncertain of a path's points on the sheet.
fn noise(bounds: usvg::Rect, at: Affine) -> f64 {
    let sides = [bounds.left(), bounds.top(), bounds.right(), bounds.bottom()];
    let largest = sides.into_iter().map(|v| f64::from(v.abs())).fold(0.0, f64::max);
    8.0 * f64::from(f32::EPSILON) * largest * scale(at)
}

/// The connected parts of a path on the sheet.
pub(super) struct Lines {
    /// Those that have a length.
    pub(super) paths: Vec<Path>,
    /// Where the others are: a dot, if the pen's ends are round or square.
    pub(super) dots: Vec<Point>,
}

/// The connected parts of a path, moved to the sheet.
pub(super) fn lines(path: &usvg::Path, at: Affine, close_all: bool) -> Lines {
    split(path.data(), at, close_all, Some(noise(path.bounding_box(), at)))
}

/// The connected parts of a path in its own numbers, without arcs, so that any transform may move them.
pub(super) fn own_lines(path: &usvg::Path) -> Vec<Path> {
    split(path.data(), Affine::IDENTITY, false, None).paths
}

/// Cubics become arcs where they stand for one to the noise, if there is any.
fn split(path: &tiny_skia_path::Path, at: Affine, close_all: bool, noise: Option<f64>) -> Lines {
    let point = |p: tiny_skia_path::Point| at * Point::new(f64::from(p.x), f64::from(p.y));
    let mut lines = Lines { paths: Vec::new(), dots: Vec::new() };
    let mut open: Option<(Pen, Point, bool)> = None;
    let mut end = |open: Option<(Pen, Point, bool)>, closed: bool| {
        let Some((pen, start, is_drawn)) = open else { return };
        match pen.finish(closed) {
            Some(path) => lines.paths.push(path),
            None => lines.dots.extend(is_drawn.then_some(start)),
        }
    };
    for segment in path.segments() {
        if let PathSegment::MoveTo(p) = segment {
            end(open.replace((Pen::new(point(p)), point(p), false)), close_all);
            continue;
        }
        let Some((mut pen, start, _)) = open.take() else { continue };
        match segment {
            PathSegment::MoveTo(_) => {}
            PathSegment::LineTo(p) => pen.line_to(point(p)),
            PathSegment::QuadTo(c, p) => pen.quadratic_to(point(c), point(p)),
            PathSegment::CubicTo(c1, c2, p) => {
                let points = [c1, c2, p].map(point);
                match noise {
                    Some(noise) => pen.cubic_or_arc_to(points, noise),
                    None => pen.cubic_to(points),
                }
            }
            PathSegment::Close => {
                end(Some((pen, start, true)), true);
                continue;
            }
        }
        open = Some((pen, start, true));
    }
    end(open, close_all);
    lines
}

/// What a fill covers.
pub(super) fn filled(outlines: &[Path], rule: usvg::FillRule, tolerance: f64) -> Region {
    let polygon = |path: &Path| chords(path, tolerance).into_iter().map(|corner| corner.point).collect();
    let polygons: Vec<Vec<Point>> = outlines.iter().map(polygon).collect();
    Region::new(&polygons, rule == usvg::FillRule::EvenOdd)
}

/// The edge of what a pen covers along a path, its ends and corners included.
pub(super) fn sides(
    path: &usvg::Path,
    stroke: &usvg::Stroke,
    at: Affine,
    tolerance: f64,
    dashed: bool,
) -> Vec<Path> {
    let mut pen = stroke.to_tiny_skia();
    let dash = pen.dash.take().filter(|_| dashed);
    // the stroker's own tolerance is a quarter of a pixel of this resolution
    let resolution = (scale(at) * (0.25 / tolerance)).clamp(1e-3, 1e6) as f32;
    let dashes = dash.and_then(|dash| path.data().dash(&dash, resolution));
    let line = dashes.as_ref().unwrap_or(path.data());
    let Some(outline) = PathStroker::new().stroke(line, &pen, resolution) else { return Vec::new() };
    split(&outline, at, true, None).paths
}
