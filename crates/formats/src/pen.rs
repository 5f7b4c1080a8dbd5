use tracelight_stroke::{Element, Path, Piece, Point};

use crate::circular::{arc_of_cubic, joined};

/// Builds a path step by step and knows where it is, so that a path of a million lines takes a million steps.
pub(crate) struct Pen {
    start: Point,
    elements: Vec<Element>,
    /// Start of the last element.
    before: Point,
    at: Point,
}

impl Pen {
    pub(crate) fn new(start: Point) -> Self {
        Self { start, elements: Vec::new(), before: start, at: start }
    }

    /// Any element that has a length.
    pub(crate) fn push(&mut self, element: Element) {
        let to = Piece { from: self.at, element }.end();
        let moves = match element {
            Element::Line { to } => to != self.at,
            Element::Arc { centre, sweep } => sweep != 0.0 && centre != self.at,
            Element::Cubic { c1, c2, to } => [c1, c2, to].iter().any(|&p| p != self.at),
        };
        if moves {
            self.elements.push(element);
            self.before = self.at;
            self.at = to;
        }
    }

    /// A line, unless it has no length.
    pub(crate) fn line_to(&mut self, to: Point) {
        self.push(Element::Line { to });
    }

    /// A quadratic curve raised to a cubic: its inner points lie two thirds of the way to the control point.
    pub(crate) fn quadratic_to(&mut self, c: Point, to: Point) {
        self.cubic_to([self.at.lerp(c, 2.0 / 3.0), to.lerp(c, 2.0 / 3.0), to]);
    }

    /// A cubic, unless all its points are one.
    pub(crate) fn cubic_to(&mut self, [c1, c2, to]: [Point; 3]) {
        self.push(Element::Cubic { c1, c2, to });
    }

    /// A cubic; an arc where it stands for one to `noise`, joined to the arc before it where both are of one circle.
    pub(crate) fn cubic_or_arc_to(&mut self, [c1, c2, to]: [Point; 3], noise: f64) {
        let piece = Piece { from: self.at, element: Element::Cubic { c1, c2, to } };
        let Some(arc) = arc_of_cubic(&piece, noise) else { return self.push(piece.element) };
        let last = self.elements.last().map(|&element| Piece { from: self.before, element });
        match last.and_then(|last| joined(&last, &arc, 4.0 * noise)) {
            Some(one) => {
                self.elements.pop();
                self.at = self.before;
                self.push(one);
            }
            None => self.push(arc),
        }
    }

    /// The path, closed if wished; `None` if it has no length.
    pub(crate) fn finish(self, closed: bool) -> Option<Path> {
        let mut path = Path::new(self.start);
        self.elements.into_iter().for_each(|e| path.push(e));
        if path.elements().is_empty() {
            return None;
        }
        if closed {
            path.close();
        }
        Some(path)
    }
}

/// Straight lines through points; `None` for fewer than two different ones.
pub(crate) fn polyline(points: &[Point], closed: bool) -> Option<Path> {
    let (&first, rest) = points.split_first()?;
    let mut pen = Pen::new(first);
    rest.iter().for_each(|&to| pen.line_to(to));
    pen.finish(closed)
}
