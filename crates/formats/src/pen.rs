use tracelight_stroke::{Element, Path, Point};

/// Builds a path step by step and knows where it is, so that a path of a million lines takes a million steps.
pub(crate) struct Pen {
    path: Path,
    at: Point,
}

impl Pen {
    pub(crate) fn new(start: Point) -> Self {
        Self { path: Path::new(start), at: start }
    }

    /// A line, unless it has no length.
    pub(crate) fn line_to(&mut self, to: Point) {
        if to != self.at {
            self.path.push(Element::Line { to });
            self.at = to;
        }
    }

    /// A cubic, unless all its points are one.
    pub(crate) fn cubic_to(&mut self, c1: Point, c2: Point, to: Point) {
        if [c1, c2, to].iter().any(|&p| p != self.at) {
            self.path.push(Element::Cubic { c1, c2, to });
            self.at = to;
        }
    }

    /// A quadratic curve raised to a cubic: its inner points lie two thirds of the way to the control point.
    pub(crate) fn quadratic_to(&mut self, c: Point, to: Point) {
        self.cubic_to(self.at.lerp(c, 2.0 / 3.0), to.lerp(c, 2.0 / 3.0), to);
    }

    /// The path, closed if wished; `None` if it has no length.
    pub(crate) fn finish(mut self, closed: bool) -> Option<Path> {
        if self.path.elements().is_empty() {
            return None;
        }
        if closed {
            self.path.close();
        }
        Some(self.path)
    }
}

/// Straight lines through points; `None` for fewer than two different ones.
pub(crate) fn polyline(points: &[Point], closed: bool) -> Option<Path> {
    let (&first, rest) = points.split_first()?;
    let mut pen = Pen::new(first);
    rest.iter().for_each(|&to| pen.line_to(to));
    pen.finish(closed)
}
