//! Lines that are drawn twice: in light they would be twice as bright.

use std::f64::consts::TAU;

use kurbo::Rect;
use tracelight_maths::{atan2, hypot};
use tracelight_stroke::{Drawing, Element, Path, Piece, Point, Stroke};

use crate::extent::extent;
use crate::number::length;
use crate::parts::{Span, parts};

/// What was left out because it lies on an earlier line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Doubles {
    /// Strokes of which a part or all was left out.
    pub(crate) strokes: usize,
    /// Length left out, in the drawing's unit.
    pub(crate) length: f64,
}

impl Doubles {
    /// Says what was left out; `None` for nothing. The length is in millimetres where the drawing's unit has a size.
    pub(crate) fn remark(&self, metres_per_unit: Option<f64>) -> Option<String> {
        let length = length(self.length, metres_per_unit);
        let lines = if self.strokes == 1 { "line" } else { "lines" };
        let strokes = self.strokes;
        (strokes > 0)
            .then(|| format!("not drawn again: {strokes} {lines}, {length}, on top of earlier lines"))
    }
}

/// How far apart lines are one line, as a share of the drawing's diagonal.
const WITHIN: f64 = 1e-5;

/// Rests shorter than so many times that distance are none.
const LEAST_REST: f64 = 10.0;

/// Comparisons of pieces at most, a good tenth of a second of them; what comes after stays as it is.
const MAX_WORK: usize = 50_000_000;

/// Leaves out what lies on an earlier line of the drawing, either way round, to 1e-5 of the drawing's diagonal: parts of
/// lines and of arcs, and cubics that are whole cubics drawn again. The rests of a stroke keep its looks; what is not
/// drawn twice stays as it is.
pub(crate) fn without_doubles(drawing: Drawing) -> (Drawing, Doubles) {
    let Some(box_) = extent(&drawing) else { return (drawing, Doubles::default()) };
    let mut known = Known::over(box_, &drawing);
    let mut doubles = Doubles::default();
    let mut strokes = Vec::with_capacity(drawing.strokes.len());
    for stroke in drawing.strokes {
        match known.rest(&stroke.path) {
            None => strokes.push(stroke),
            Some(rests) => {
                let left: f64 = rests.iter().map(|p| p.length(known.within)).sum();
                doubles.strokes += 1;
                doubles.length += (stroke.path.length(known.within) - left).max(0.0);
                strokes.extend(rests.into_iter().map(|path| Stroke { path, ..stroke.clone() }));
            }
        }
    }
    (Drawing { strokes }, doubles)
}

/// The pieces met so far, by the cells of a grid that they pass.
struct Known {
    within: f64,
    corner: Point,
    cell: f64,
    side: usize,
    cells: Vec<Vec<u32>>,
    pieces: Vec<Piece>,
    /// The piece that last asked about each known one, for a pair may meet in many cells.
    asked: Vec<u32>,
    asker: u32,
    work: usize,
}

impl Known {
    fn over(box_: Rect, drawing: &Drawing) -> Self {
        let extent = box_.width().max(box_.height()).max(f64::MIN_POSITIVE);
        let within = WITHIN * hypot(box_.width(), box_.height());
        let pieces = drawing.strokes.iter().flat_map(|s| s.path.pieces());
        let (count, length) = pieces.fold((0.0, 0.0), |(n, sum), p| (n + 1.0, sum + reach(&p) / extent));
        // long lines pass many cells: about six a piece in all
        let side =
            (6.0 * count / f64::max(length, 1e-9)).min(2.0 * f64::sqrt(count)).clamp(4.0, 512.0) as usize;
        let cell = extent / side as f64 * (1.0 + 1e-9);
        let cells = vec![Vec::new(); side * side];
        Self {
            within,
            corner: box_.origin(),
            cell,
            side,
            cells,
            pieces: Vec::new(),
            asked: Vec::new(),
            asker: 0,
            work: 0,
        }
    }

    /// What of a path is not known yet; `None` if all of it. The path is known from then on.
    fn rest(&mut self, path: &Path) -> Option<Vec<Path>> {
        let mut spans = Vec::with_capacity(path.elements().len());
        let mut is_cut = false;
        for (element, piece) in path.pieces().enumerate() {
            let cells = self.cells_of(&piece);
            let covered = self.covered(&piece, &cells);
            is_cut |= !covered.is_empty();
            let least = LEAST_REST * self.within / reach(&piece).max(f64::MIN_POSITIVE);
            let rests = rests(covered, least);
            if !rests.is_empty() {
                self.add(piece, &cells);
            }
            spans.extend(rests.into_iter().map(|(from, to)| Span { element, from, to }));
        }
        is_cut.then(|| parts(path, &spans))
    }

    fn add(&mut self, piece: Piece, cells: &[usize]) {
        let number = self.pieces.len() as u32;
        self.pieces.push(piece);
        self.asked.push(u32::MAX);
        cells.iter().for_each(|&at| self.cells[at].push(number));
    }

    /// Parameters between which a piece lies on known ones.
    fn covered(&mut self, piece: &Piece, cells: &[usize]) -> Vec<(f64, f64)> {
        let mut covered = Vec::new();
        self.asker = self.asker.wrapping_add(1);
        let asking = self.asker;
        for &at in cells {
            for &number in &self.cells[at] {
                self.work += 1;
                if self.work > MAX_WORK {
                    return covered;
                }
                let number = number as usize;
                if std::mem::replace(&mut self.asked[number], asking) != asking {
                    covered.extend(on(piece, &self.pieces[number], self.within));
                }
            }
        }
        covered
    }

    /// The cells that a piece passes, and those beside them where it runs along their edge.
    fn cells_of(&self, piece: &Piece) -> Vec<usize> {
        let steps = (2.0 * reach(piece) / self.cell).ceil().clamp(1.0, 4096.0) as usize;
        let mut cells = Vec::new();
        let mut from = piece.from;
        for i in 1..=steps {
            let to = piece.at(i as f64 / steps as f64);
            // the curve between two points this close stays about as close to their box
            let slack = self.within
                + if matches!(piece.element, Element::Line { .. }) { 0.0 } else { 0.2 * self.cell };
            let box_ = Rect::from_points(from, to).inflate(slack, slack);
            let [x0, x1] = [box_.x0, box_.x1].map(|x| self.index(x - self.corner.x));
            let [y0, y1] = [box_.y0, box_.y1].map(|y| self.index(y - self.corner.y));
            for y in y0..=y1 {
                cells.extend((x0..=x1).map(|x| y * self.side + x));
            }
            from = to;
        }
        cells.sort_unstable();
        cells.dedup();
        cells
    }

    fn index(&self, offset: f64) -> usize {
        ((offset / self.cell).max(0.0) as usize).min(self.side - 1)
    }
}

/// About how long a piece is; never shorter.
fn reach(piece: &Piece) -> f64 {
    match piece.element {
        Element::Line { to } => piece.from.distance(to),
        Element::Arc { centre, sweep } => piece.from.distance(centre) * sweep.abs(),
        Element::Cubic { c1, c2, to } => piece.from.distance(c1) + c1.distance(c2) + c2.distance(to),
    }
}

/// Parameters of a piece between which it lies on another.
fn on(piece: &Piece, other: &Piece, within: f64) -> Vec<(f64, f64)> {
    match (piece.element, other.element) {
        (Element::Line { to }, Element::Line { to: end }) => {
            line_on([piece.from, to], [other.from, end], within).into_iter().collect()
        }
        (Element::Arc { .. }, Element::Arc { .. }) => arc_on(piece, other, within),
        (Element::Cubic { c1, c2, to }, Element::Cubic { c1: d1, c2: d2, to: end }) => {
            let mine = [piece.from, c1, c2, to];
            let same = |theirs: [Point; 4]| mine.iter().zip(theirs).all(|(a, b)| a.distance(b) <= within);
            let is_double = same([other.from, d1, d2, end]) || same([end, d2, d1, other.from]);
            is_double.then_some((0.0, 1.0)).into_iter().collect()
        }
        _ => Vec::new(),
    }
}

fn line_on([from, to]: [Point; 2], [start, end]: [Point; 2], within: f64) -> Option<(f64, f64)> {
    let along = to - from;
    let length2 = along.hypot2();
    let place = |p: Point| (p - from).dot(along) / length2;
    let (a, b) = (place(start), place(end));
    let (first, last) = (a.min(b).max(0.0), a.max(b).min(1.0));
    if first.is_nan()
        || last.is_nan()
        || last <= first
        || (last - first) * length2.sqrt() <= LEAST_REST * within
    {
        return None;
    }
    // where the other one is at these places
    let beside = |t: f64| {
        let p = start.lerp(end, (t - a) / (b - a));
        ((p - from).cross(along)).abs() <= within * length2.sqrt()
    };
    (beside(first) && beside(last)).then_some((first, last))
}

fn arc_on(piece: &Piece, other: &Piece, within: f64) -> Vec<(f64, f64)> {
    let (Element::Arc { centre, sweep }, Element::Arc { centre: c, sweep: s }) =
        (piece.element, other.element)
    else {
        return Vec::new();
    };
    let (arm, other_arm) = (piece.from - centre, other.from - c);
    if centre.distance(c) > within || (arm.hypot() - other_arm.hypot()).abs() > within {
        return Vec::new();
    }
    // the other's stretch in my direction of turning, as an angle ahead of my start
    let begin = if s * sweep > 0.0 { other_arm } else { other.end() - c };
    let ahead = (atan2(arm.cross(begin), arm.dot(begin)) * sweep.signum()).rem_euclid(TAU);
    let whole = sweep.abs();
    let slack = within / arm.hypot();
    let ahead = if ahead > TAU - slack { 0.0 } else { ahead };
    let stretch = |turn: f64| {
        let (first, last) = ((ahead - turn).max(0.0), (ahead - turn + s.abs() + slack).min(whole));
        ((last - first) * arm.hypot() > LEAST_REST * within).then_some((first / whole, last / whole))
    };
    [0.0, TAU].into_iter().filter_map(stretch).collect()
}

/// What is left of 0 to 1 without the covered stretches; rests shorter than the least are none.
fn rests(mut covered: Vec<(f64, f64)>, least: f64) -> Vec<(f64, f64)> {
    covered.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut left = Vec::new();
    let mut at = 0.0;
    let had_none = covered.is_empty();
    for (from, to) in covered {
        if from - at > least {
            left.push((at, from));
        }
        at = f64::max(at, to);
    }
    if had_none || 1.0 - at > least {
        left.push((at, 1.0));
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn line(points: &[(f64, f64)]) -> Stroke {
        let points: Vec<Point> = points.iter().map(|&p| p.into()).collect();
        Stroke::new(Path::polyline(&points, false).unwrap())
    }

    fn check(strokes: Vec<Stroke>, lengths: &[f64], doubled: f64) {
        let (found, doubles) = without_doubles(Drawing { strokes });
        let got: Vec<f64> = found.strokes.iter().map(|s| s.path.length(1e-9)).collect();
        assert!(
            got.len() == lengths.len() && got.iter().zip(lengths).all(|(a, b)| (a - b).abs() < 1e-3),
            "{got:?}"
        );
        assert!((doubles.length - doubled).abs() < 1e-3, "{doubles:?}");
    }

    #[test]
    fn a_line_drawn_again_is_left_out_either_way_round() {
        check(vec![line(&[(0., 0.), (9., 3.)]), line(&[(9., 3.), (0., 0.)])], &[90f64.sqrt()], 90f64.sqrt());
        check(vec![line(&[(0., 0.), (9., 0.)]), line(&[(0., 1e-3), (9., 1e-3)])], &[9., 9.], 0.);
        check(vec![line(&[(0., 0.), (9., 0.)]), line(&[(0., 1e-6), (9., 1e-6)])], &[9.], 9.);
    }

    #[test]
    fn only_the_part_that_lies_on_another_is_left_out() {
        check(vec![line(&[(2., 0.), (4., 0.)]), line(&[(0., 0.), (9., 0.)])], &[2., 2., 5.], 2.);
        let squares = [
            line(&[(0., 0.), (4., 0.), (4., 4.), (0., 4.), (0., 0.)]),
            line(&[(4., 4.), (4., 0.), (8., 0.)]),
        ];
        check(squares.to_vec(), &[16., 4.], 4.);
    }

    #[test]
    fn crossing_and_following_lines_stay() {
        check(vec![line(&[(0., 0.), (4., 4.)]), line(&[(0., 4.), (4., 0.)])], &[32f64.sqrt(); 2], 0.);
        check(vec![line(&[(0., 0.), (4., 0.), (9., 0.)]), line(&[(9., 0.), (12., 0.)])], &[9., 3.], 0.);
    }

    #[test]
    fn arcs_of_one_circle_are_one_line() {
        let arc = |from: f64, sweep: f64| {
            let mut path = Path::new(Point::new(from.cos(), from.sin()));
            path.push(Element::Arc { centre: Point::ORIGIN, sweep });
            Stroke::new(path)
        };
        check(vec![arc(0.0, TAU), arc(1.0, -TAU)], &[TAU], TAU);
        check(vec![arc(0.0, PI), arc(2.0, 2.0)], &[PI, 4.0 - PI], PI - 2.0);
        check(vec![arc(0.0, PI), arc(PI, PI)], &[PI, PI], 0.0);
        check(vec![arc(0.0, PI), arc(0.0, -PI)], &[PI, PI], 0.0);
    }

    #[test]
    fn a_closed_path_stays_closed_unless_it_is_cut() {
        let square = [(0., 0.), (4., 0.), (4., 4.), (0., 4.)].map(Point::from);
        let closed = Stroke::new(Path::polyline(&square, true).unwrap());
        let (found, doubles) = without_doubles(Drawing { strokes: vec![closed.clone(), closed] });
        assert_eq!((found.strokes.len(), doubles.strokes, doubles.length), (1, 1, 16.0));
        assert!(found.strokes[0].path.is_closed());
    }
}
