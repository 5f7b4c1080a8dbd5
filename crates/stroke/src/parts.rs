//! Parts of paths between parameters of their own elements, or between lengths from their start, so that arcs stay arcs
//! and lines lines.

use kurbo::{CubicBez, ParamCurve};

use crate::path::{Element, Path, Piece};

/// A stretch of one element of a path, by that element's parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Number of the element.
    pub element: usize,
    /// Where it begins, 0 to 1.
    pub from: f64,
    /// Where it ends, `from` to 1.
    pub to: f64,
}

/// Part of a piece between two of its parameters.
fn between(piece: &Piece, from: f64, to: f64) -> Piece {
    if from <= 0.0 && to >= 1.0 {
        return *piece;
    }
    let start = if from <= 0.0 { piece.from } else { piece.at(from) };
    let element = match piece.element {
        Element::Line { to: end } => Element::Line { to: if to >= 1.0 { end } else { piece.at(to) } },
        Element::Arc { centre, sweep } => Element::Arc { centre, sweep: sweep * (to - from) },
        Element::Cubic { c1, c2, to: end } => {
            let part = CubicBez::new(piece.from, c1, c2, end).subsegment(from..to);
            Element::Cubic { c1: part.p1, c2: part.p2, to: part.p3 }
        }
    };
    Piece { from: start, element }
}

/// The parts of a path that the spans name, which are in the path's order. Spans that follow each other without a gap
/// make one part; on a closed path the last and the first do too. The whole of a closed path stays closed.
#[must_use]
pub fn parts(path: &Path, spans: &[Span]) -> Vec<Path> {
    let elements = path.elements().len();
    let is_whole = spans.len() == elements
        && spans.iter().enumerate().all(|(i, s)| (s.element, s.from, s.to) == (i, 0.0, 1.0));
    if is_whole {
        return vec![path.clone()];
    }
    let pieces: Vec<Piece> = path.pieces().collect();
    let mut done: Vec<Path> = Vec::new();
    let mut before: Option<Span> = None;
    let first_is_begun = spans.first().is_some_and(|s| (s.element, s.from) == (0, 0.0));
    for &span in rotated(path, spans).iter() {
        let part = between(&pieces[span.element], span.from, span.to);
        let follows =
            before.is_some_and(|b| follows(&b, &span, elements, path.is_closed() && first_is_begun));
        match done.last_mut().filter(|_| follows) {
            Some(open) => open.push(part.element),
            None => {
                let mut new = Path::new(part.from);
                new.push(part.element);
                done.push(new);
            }
        }
        before = Some(span);
    }
    done
}

/// The spans of a closed path begun after a gap, so that no part is cut at the path's start.
fn rotated(path: &Path, spans: &[Span]) -> Vec<Span> {
    let elements = path.elements().len();
    let starts_late = |i: usize| i > 0 && !follows(&spans[i - 1], &spans[i], elements, false);
    let mut turned = spans.to_vec();
    let gap = (0..spans.len()).find(|&i| starts_late(i)).filter(|_| path.is_closed());
    turned.rotate_left(gap.unwrap_or(0));
    turned
}

fn follows(before: &Span, span: &Span, elements: usize, round: bool) -> bool {
    let next = before.element + 1;
    let is_next = next == span.element || (round && next == elements && span.element == 0);
    (is_next && before.to >= 1.0 && span.from <= 0.0)
        || (before.element == span.element && before.to == span.from)
}

/// A path with the lengths of its pieces.
pub struct Measured {
    pieces: Vec<(Piece, f64)>,
    tolerance: f64,
}

impl Measured {
    /// The path, its lengths to a tolerance.
    #[must_use]
    pub fn of(path: &Path, tolerance: f64) -> Self {
        Self { pieces: path.pieces().map(|piece| (piece, piece.length(tolerance))).collect(), tolerance }
    }

    /// Length of all of it.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.pieces.iter().map(|(_, length)| length).sum()
    }

    /// The parts of the path between lengths from its start, which rise.
    #[must_use]
    pub fn stretches(&self, spans: &[[f64; 2]]) -> Vec<Path> {
        let mut rest = self.pieces.as_slice();
        let mut before = 0.0;
        let mut parts = Vec::new();
        for &[from, to] in spans {
            while let Some((&(_, length), after)) =
                rest.split_first().filter(|(own, _)| before + own.1 <= from)
            {
                before += length;
                rest = after;
            }
            let mut path: Option<Path> = None;
            let mut passed = before;
            for &(piece, length) in rest {
                let [start, end] = [from, to].map(|s| (s - passed).clamp(0.0, length));
                if start < end {
                    let is_whole = start == 0.0 && end == length;
                    let own = if is_whole { piece } else { piece.part(start, end, self.tolerance) };
                    path.get_or_insert_with(|| Path::new(own.from)).push(own.element);
                }
                passed += length;
                if passed >= to {
                    break;
                }
            }
            parts.extend(path);
        }
        parts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::Point;

    #[test]
    fn a_closed_path_is_not_cut_where_it_starts() {
        let square = [(0., 0.), (1., 0.), (1., 1.), (0., 1.)].map(Point::from);
        let path = Path::polyline(&square, true).unwrap();
        let span = |element, from, to| Span { element, from, to };
        let spans = [span(0, 0.0, 1.0), span(1, 0.0, 0.5), span(2, 0.5, 1.0), span(3, 0.0, 1.0)];
        let found = parts(&path, &spans);
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].start(), found[0].end()), (Point::new(0.5, 1.0), Point::new(1.0, 0.5)));
        assert_eq!(found[0].elements().len(), 4);
        let whole = [0, 1, 2, 3].map(|i| span(i, 0.0, 1.0));
        assert!(parts(&path, &whole)[0].is_closed());
        assert_eq!(parts(&path, &whole[..1]).len(), 1);
        assert_eq!(parts(&path, &[]).len(), 0);
    }
}
