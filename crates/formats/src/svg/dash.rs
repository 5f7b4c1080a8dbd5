//! Dashed lines as their dashes.

use kurbo::Affine;
use tracelight_stroke::{Element, Measured, Path, Piece, Point};

/// Dashes of a drawing at most; what has more is drawn as whole lines.
pub(super) const MAX_DASHES: usize = 100_000;

/// Accuracy of lengths along curves, as a share of the pattern's length.
const ACCURACY: f64 = 1e-4;

/// A pattern of dashes and gaps, in turn, in the unit of the paths.
pub(super) struct Dashes {
    lengths: Vec<f64>,
    offset: f64,
}

impl Dashes {
    /// Of a stroke, times a scale; `None` if it is not dashed.
    pub(super) fn of(stroke: &usvg::Stroke, scale: f64) -> Option<Self> {
        let mut lengths: Vec<f64> = stroke.dasharray()?.iter().map(|&l| f64::from(l) * scale).collect();
        if lengths.len() % 2 == 1 {
            lengths.extend_from_within(..);
        }
        let mut offset = f64::from(stroke.dashoffset()) * scale;
        if stroke.linecap() != usvg::LineCap::Butt {
            offset += dots_as_lines(&mut lengths, f64::from(stroke.width().get()) * scale);
        }
        let is_sound = lengths.iter().all(|l| l.is_finite() && *l >= 0.0) && offset.is_finite();
        let dashes = Self { lengths, offset };
        (is_sound && dashes.period() > 0.0).then_some(dashes)
    }

    fn period(&self) -> f64 {
        self.lengths.iter().sum()
    }

    /// How many dashes a path has at most.
    pub(super) fn count(&self, path: &Path) -> usize {
        let period = self.period();
        let periods = path.length(ACCURACY * period) / period;
        ((periods + 2.0) * self.lengths.len() as f64 * 0.5).min(1e15) as usize
    }

    /// The dashes of a path. On a closed one, the first goes on from the last where both are drawn.
    pub(super) fn along(&self, path: &Path) -> Vec<Path> {
        let mut pattern = Pattern::at(self);
        let starts_lit = pattern.is_lit();
        let measured = Measured::of(path, ACCURACY * self.period());
        let whole = measured.length();
        let (mut at, mut ends_lit, mut spans) = (0.0, false, Vec::new());
        while at < whole {
            let to = (at + pattern.left).min(whole);
            let is_drawn = pattern.is_lit() && to > at;
            if is_drawn {
                spans.push([at, to]);
            }
            ends_lit = !pattern.go(to - at) && is_drawn;
            at = to;
        }
        let done = measured.stretches(&spans);
        match done.len() {
            1 if ends_lit && starts_lit && path.is_closed() => vec![path.clone()],
            2.. if ends_lit && starts_lit && path.is_closed() => joined(done),
            _ => done,
        }
    }
}

/// Makes dashes without length, which round and square ends show as dots, as long as the pen is wide, if there is room.
/// Returns how far ahead of a first one its line begins.
fn dots_as_lines(lengths: &mut [f64], pen: f64) -> f64 {
    let mut ahead = 0.0;
    for i in (0..lengths.len()).step_by(2) {
        if lengths[i] == 0.0 {
            let long = pen.min(0.5 * lengths[i + 1]);
            lengths[i] = long;
            lengths[i + 1] -= long;
            ahead = 0.5 * long;
        }
    }
    ahead
}

/// The last dash and the first as one.
fn joined(mut dashes: Vec<Path>) -> Vec<Path> {
    let Some(mut last) = dashes.pop() else { return dashes };
    if let Some(first) = dashes.first_mut() {
        first.elements().iter().for_each(|&element| last.push(element));
        *first = last;
    }
    dashes
}

/// Where in a pattern a pen is.
struct Pattern<'a> {
    dashes: &'a Dashes,
    index: usize,
    /// Length left of this dash or gap.
    left: f64,
}

impl<'a> Pattern<'a> {
    fn at(dashes: &'a Dashes) -> Self {
        let mut pattern = Self { dashes, index: 0, left: dashes.lengths[0] };
        let mut offset = dashes.offset.rem_euclid(dashes.period());
        for (index, &length) in dashes.lengths.iter().enumerate() {
            pattern = Self { dashes, index, left: length - offset };
            if offset < length {
                break;
            }
            offset -= length;
        }
        pattern.left = pattern.left.max(0.0);
        pattern
    }

    const fn is_lit(&self) -> bool {
        self.index.is_multiple_of(2)
    }

    /// Goes on by a length no longer than what is left; whether a dash or gap ended.
    fn go(&mut self, length: f64) -> bool {
        self.left -= length;
        // less than rounding leaves is nothing: it would never be walked
        let nothing = 1e-9 * self.dashes.period();
        let ended = self.left <= nothing;
        // a dash or gap of no length is none, but for the end that it makes
        while self.left <= nothing {
            self.index = (self.index + 1) % self.dashes.lengths.len();
            self.left = self.dashes.lengths[self.index];
        }
        ended
    }
}

/// Moves a path of lines and cubics by any affine transform.
pub(super) fn moved(path: &Path, by: Affine) -> Path {
    let mut pieces = Path::new(by * path.start());
    for element in path.elements() {
        pieces.push(match *element {
            Element::Line { to } => Element::Line { to: by * to },
            Element::Cubic { c1, c2, to } => Element::Cubic { c1: by * c1, c2: by * c2, to: by * to },
            Element::Arc { .. } => *element,
        });
    }
    pieces
}

/// A dot as a line of the pen's width.
pub(super) fn dot(at: Point, pen: f64) -> Path {
    let half = kurbo::Vec2::new(0.5 * pen, 0.0);
    let mut path = Path::new(at - half);
    path.push(Piece { from: at - half, element: Element::Line { to: at + half } }.element);
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dashes(lengths: &[f64], offset: f64) -> Dashes {
        Dashes { lengths: lengths.to_vec(), offset }
    }

    fn check(found: &[Path], wanted: &[(f64, f64)]) {
        let ends: Vec<_> = found.iter().map(|p| (p.start().x, p.end().x)).collect();
        let same = ends.len() == wanted.len()
            && ends.iter().zip(wanted).all(|(a, b)| (a.0 - b.0).abs() < 1e-9 && (a.1 - b.1).abs() < 1e-9);
        assert!(same, "{ends:?}");
    }

    #[test]
    fn dashes_follow_their_pattern_and_offset() {
        let line =
            Path::polyline(&[Point::new(0., 0.), Point::new(4., 0.), Point::new(10., 0.)], false).unwrap();
        check(&dashes(&[2., 1.], 0.).along(&line), &[(0., 2.), (3., 5.), (6., 8.), (9., 10.)]);
        check(&dashes(&[2., 1.], 1.).along(&line), &[(0., 1.), (2., 4.), (5., 7.), (8., 10.)]);
        check(&dashes(&[2., 1.], -1.).along(&line), &[(1., 3.), (4., 6.), (7., 9.)]);
        check(&dashes(&[2., 1.], 2.).along(&line), &[(1., 3.), (4., 6.), (7., 9.)]);
        check(&dashes(&[20., 1.], 0.).along(&line), &[(0., 10.)]);
    }

    #[test]
    fn a_dash_goes_on_round_a_closed_line_and_along_arcs() {
        let mut circle = Path::new(Point::new(1.0, 0.0));
        circle.push(Element::Arc { centre: Point::ORIGIN, sweep: std::f64::consts::TAU });
        circle.close();
        let quarter = 0.5 * std::f64::consts::PI;
        let found = dashes(&[quarter, quarter], 0.5 * quarter).along(&circle);
        assert_eq!(found.len(), 2);
        assert!(found.iter().all(|p| (p.length(1e-9) - quarter).abs() < 1e-9));
        assert!(found[0].elements().iter().all(|e| matches!(e, Element::Arc { .. })));
    }
}
