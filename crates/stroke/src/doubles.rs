//! Lines that are drawn twice: in light they would be twice as bright.

use std::f64::consts::{PI, TAU};

use kurbo::{Point, Rect};
use tracelight_maths::{atan2, hypot};

use crate::extent::extent_of;
use crate::parts::{Span, parts};
use crate::path::{Element, Path, Piece};
use crate::stroke::Drawing;

/// What was left out because it lies on an earlier line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Doubles {
    /// Strokes of which a part or all was left out.
    pub strokes: usize,
    /// Length left out, in the drawing's unit.
    pub length: f64,
    /// Strokes that were not looked at: too many lines lie close together.
    pub unsearched: usize,
}

/// A path of which a part lies on earlier ones, or on itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Split {
    /// Parts that are drawn for the first time.
    pub once: Vec<Path>,
    /// Parts that lie on earlier lines.
    pub again: Vec<Path>,
}

/// How far apart lines are one line, as a share of the drawing's diagonal.
const WITHIN: f64 = 1e-5;

/// Rests shorter than so many times that distance are none.
const LEAST_REST: f64 = 10.0;

/// Comparisons of pieces at most, less than a tenth of a second of them; what comes after stays as it is.
const MAX_WORK: usize = 20_000_000;

/// Leaves out what lies on an earlier line of the drawing, either way round, to 1e-5 of the drawing's diagonal: parts of
/// lines and of arcs, and cubics that are whole cubics drawn again. The rests of a stroke keep its looks; what is not
/// drawn twice stays as it is.
#[must_use]
pub fn without_doubles(drawing: Drawing) -> (Drawing, Doubles) {
    let paths: Vec<&Path> = drawing.strokes.iter().map(|stroke| &stroke.path).collect();
    let (splits, unsearched) = doubles(&paths);
    let mut doubles = Doubles { unsearched, ..Doubles::default() };
    let mut strokes = Vec::with_capacity(drawing.strokes.len());
    for (stroke, split) in drawing.strokes.into_iter().zip(splits) {
        match split {
            None => strokes.push(stroke),
            Some(Split { once, again }) => {
                let tolerance = 1e-6 * again.iter().map(Path::rough_length).sum::<f64>();
                doubles.strokes += 1;
                doubles.length += again.iter().map(|path| path.length(tolerance)).sum::<f64>();
                strokes.extend(once.into_iter().map(|path| stroke.along(path)));
            }
        }
    }
    (Drawing { strokes }, doubles)
}

/// For each path its parts, where any of it lies on earlier ones or on itself, to 1e-5 of the diagonal of them all; and how many
/// paths were not looked at.
#[must_use]
pub fn doubles(paths: &[&Path]) -> (Vec<Option<Split>>, usize) {
    let Some(bounds) = extent_of(paths.iter().copied()) else { return (vec![None; paths.len()], 0) };
    let mut known = Known::over(bounds, paths);
    let mut unsearched = 0;
    let mut split = |path: &&Path| {
        let split = known.split(path);
        unsearched += usize::from(known.work > MAX_WORK);
        split
    };
    let splits = paths.iter().map(&mut split).collect();
    (splits, unsearched)
}

/// A piece in a cell: its heading, if it is a line, and its number.
type Entry = (f32, u32);

/// The pieces met so far, by the cells of a grid that they pass.
struct Known {
    within: f64,
    corner: Point,
    cell: f64,
    columns: usize,
    rows: usize,
    cells: Vec<Vec<Entry>>,
    pieces: Vec<Piece>,
    /// The piece that last asked about each known one, for a pair may meet in many cells.
    asked: Vec<u32>,
    asker: u32,
    work: usize,
}

impl Known {
    fn over(bounds: Rect, paths: &[&Path]) -> Self {
        let (width, height) = (bounds.width(), bounds.height());
        let extent = width.max(height).max(f64::MIN_POSITIVE);
        let within = WITHIN * hypot(width, height);
        let count = paths.iter().map(|path| path.elements().len()).sum::<usize>().max(1) as f64;
        let length: f64 = paths.iter().map(|path| path.rough_length()).sum();
        // about six cells a piece, and no more cells than four a piece, however long and narrow the drawing is
        let side = (length / (6.0 * count)).max((width * height).sqrt() / (2.0 * count.sqrt()).min(512.0));
        let cell = side.clamp(extent / (16.0 * count).min(20_000.0), extent / 4.0) * (1.0 + 1e-9);
        let [columns, rows] = [width, height].map(|length| (length / cell) as usize + 1);
        let cells = vec![Vec::new(); columns * rows];
        Self {
            within,
            corner: bounds.origin(),
            cell,
            columns,
            rows,
            cells,
            pieces: Vec::new(),
            asked: Vec::new(),
            asker: 0,
            work: 0,
        }
    }

    /// The parts of a path, where any of it is known. All of it is known from then on.
    fn split(&mut self, path: &Path) -> Option<Split> {
        let mut once = Vec::with_capacity(path.elements().len());
        let mut again = Vec::new();
        for (element, piece) in path.pieces().enumerate() {
            let span = |(from, to)| Span { element, from, to };
            let cells = self.cells_of(&piece);
            let covered = self.covered(&piece, &cells);
            let least = LEAST_REST * self.within / piece.rough_length().max(f64::MIN_POSITIVE);
            let (rests, gaps) = rests(covered, least);
            if !rests.is_empty() {
                self.add(piece, &cells);
            }
            once.extend(rests.into_iter().map(span));
            again.extend(gaps.into_iter().map(span));
        }
        (!again.is_empty()).then(|| Split { once: parts(path, &once), again: parts(path, &again) })
    }

    fn add(&mut self, piece: Piece, cells: &[usize]) {
        let number = self.pieces.len() as u32;
        self.pieces.push(piece);
        self.asked.push(u32::MAX);
        let heading = heading(&piece);
        cells.iter().for_each(|&at| self.cells[at].push((heading, number)));
    }

    /// Parameters between which a piece lies on known ones.
    fn covered(&mut self, piece: &Piece, cells: &[usize]) -> Vec<(f64, f64)> {
        let mut covered = Vec::new();
        self.asker = self.asker.wrapping_add(1);
        let (asking, own) = (self.asker, heading(piece));
        for &at in cells {
            for &(heading, number) in &self.cells[at] {
                self.work += 1;
                if self.work > MAX_WORK {
                    return covered;
                }
                if are_apart(own, heading) {
                    continue;
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
        let steps = (2.0 * piece.rough_length() / self.cell).ceil().clamp(1.0, 4096.0) as usize;
        let mut cells = Vec::new();
        let mut from = piece.from;
        for i in 1..=steps {
            let to = piece.at(i as f64 / steps as f64);
            // the curve between two points this close stays about as close to their box
            let slack = self.within
                + if matches!(piece.element, Element::Line { .. }) { 0.0 } else { 0.2 * self.cell };
            let box_ = Rect::from_points(from, to).inflate(slack, slack);
            let [x0, x1] = [box_.x0, box_.x1].map(|x| self.index(x - self.corner.x, self.columns));
            let [y0, y1] = [box_.y0, box_.y1].map(|y| self.index(y - self.corner.y, self.rows));
            for y in y0..=y1 {
                cells.extend((x0..=x1).map(|x| y * self.columns + x));
            }
            from = to;
        }
        cells.sort_unstable();
        cells.dedup();
        cells
    }

    fn index(&self, offset: f64, count: usize) -> usize {
        ((offset / self.cell).max(0.0) as usize).min(count - 1)
    }
}

/// The heading of a line either way, 0 to π rad; not a number for what bends.
fn heading(piece: &Piece) -> f32 {
    match piece.element {
        Element::Line { to } => atan2(to.y - piece.from.y, to.x - piece.from.x).rem_euclid(PI) as f32,
        _ => f32::NAN,
    }
}

/// Whether lines of two headings can lie on each other nowhere: not even for [`LEAST_REST`] times the distance within which they
/// would be one line.
fn are_apart(a: f32, b: f32) -> bool {
    const APART_RAD: f32 = 2.5 / LEAST_REST as f32;
    let turn = (a - b).abs();
    turn > APART_RAD && turn < PI as f32 - APART_RAD
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
    // the very same line counts however short it is
    let near = within.min(1e-3 * length2.sqrt());
    let is_same = |a: Point, b: Point| from.distance(a) <= near && to.distance(b) <= near;
    if is_same(start, end) || is_same(end, start) {
        return Some((0.0, 1.0));
    }
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

/// Stretches of a piece's parameter.
type Stretches = Vec<(f64, f64)>;

/// What is left of 0 to 1 without the covered stretches, and what lies between; rests shorter than the least are none.
fn rests(mut covered: Stretches, least: f64) -> (Stretches, Stretches) {
    covered.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut left, mut gaps) = (Vec::new(), Stretches::new());
    let mut at = 0.0;
    for (from, to) in covered {
        let is_rest = from - at > least;
        if is_rest {
            left.push((at, from));
        }
        match gaps.last_mut().filter(|_| !is_rest) {
            Some(gap) => gap.1 = f64::max(gap.1, to),
            None => gaps.push((if is_rest { from } else { 0.0 }, to)),
        }
        at = f64::max(at, to);
    }
    match gaps.last_mut().filter(|_| 1.0 - at <= least) {
        Some(gap) => gap.1 = 1.0,
        None => left.push((at, 1.0)),
    }
    (left, gaps)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stroke::Stroke;

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
    fn a_long_and_narrow_drawing_is_looked_through_too() {
        let step = |i: i32| {
            let at = |i: i32| (f64::from(i) * 0.1, f64::from(i % 20) * 0.1);
            line(&[at(i), at(i + 1)])
        };
        let strokes: Vec<Stroke> = (0..40_000).chain(0..40_000).map(step).collect();
        let (found, doubles) = without_doubles(Drawing { strokes });
        assert_eq!((doubles.strokes, doubles.unsearched), (40_000, 0));
        assert_eq!(found.strokes.len(), 40_000);
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
