use tracelight_stroke::{Affine, Path, Point, Rect, Vec2, doubles};

/// A letter as paths: in units of the em, the baseline at y = 0, y up, the pen's start at x = 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Glyph {
    /// Lines and cubics.
    pub(crate) paths: Vec<Path>,
    /// From this pen position to the next.
    pub(crate) advance: f64,
}

/// How exactly curves are measured, em.
const TOLERANCE: f64 = 1e-3;

impl Glyph {
    /// The points that the box and the ends of its strokes are found by.
    pub(crate) fn points(&self) -> impl Iterator<Item = Point> + '_ {
        self.paths.iter().flat_map(|path| path.flatten(TOLERANCE))
    }

    /// The box of its ink; `None` for a blank.
    pub(crate) fn bounds(&self) -> Option<Rect> {
        bounds_of(self.points())
    }

    /// The box of the ink above a height.
    pub(crate) fn above(&self, y: f64) -> Option<Rect> {
        bounds_of(self.points().filter(|point| point.y >= y))
    }

    /// The box of the ink below a height.
    pub(crate) fn below(&self, y: f64) -> Option<Rect> {
        bounds_of(self.points().filter(|point| point.y <= y))
    }

    /// Without the lines that its pen goes back over.
    pub(crate) fn once(mut self) -> Self {
        let paths: Vec<&Path> = self.paths.iter().collect();
        let (splits, _) = doubles(&paths);
        if splits.iter().any(Option::is_some) {
            let parts = splits.into_iter().zip(self.paths);
            self.paths =
                parts.flat_map(|(split, path)| split.map_or(vec![path], |split| split.once)).collect();
        }
        self
    }

    pub(crate) fn mapped(mut self, by: Affine) -> Self {
        self.paths = self.paths.iter().map(|path| path.transformed(by)).collect();
        self
    }

    pub(crate) fn shifted(self, x: f64, y: f64) -> Self {
        self.mapped(Affine::translate(Vec2::new(x, y)))
    }

    /// With more ink, which does not move the pen.
    pub(crate) fn with(mut self, paths: impl IntoIterator<Item = Path>) -> Self {
        self.paths.extend(paths);
        self
    }
}

fn bounds_of(mut points: impl Iterator<Item = Point>) -> Option<Rect> {
    let first = points.next()?;
    Some(points.fold(Rect::from_points(first, first), |bounds, point| bounds.union_pt(point)))
}

/// Straight lines through points given as pairs.
pub(crate) fn line(points: &[(f64, f64)]) -> Path {
    let mut points = points.iter().map(|&(x, y)| Point::new(x, y));
    let mut path = Path::new(points.next().unwrap_or_default());
    points.for_each(|to| path.line_to(to));
    path
}

/// A cubic through its four control points.
pub(crate) fn curve([from, c1, c2, to]: [(f64, f64); 4]) -> Path {
    let mut path = Path::new(from.into());
    path.push(tracelight_stroke::Element::Cubic { c1: c1.into(), c2: c2.into(), to: to.into() });
    path
}

/// One glyph and another after it.
pub(crate) fn beside(first: Glyph, second: Glyph) -> Glyph {
    let advance = first.advance + second.advance;
    let moved = second.shifted(first.advance, 0.0);
    Glyph { advance, ..first }.with(moved.paths)
}
