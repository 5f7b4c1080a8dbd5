//! Closes unintended gaps where a pen skipped.

use tracelight_image::Plane;
use tracelight_image::median::median;
use tracelight_stroke::{Point, Vec2, polyline_length};

use crate::bridge::{Tip, angle, drop_beyond};
use crate::near::Near;
use crate::row::Row;

/// Widest gap, from where the pen was lifted to where it was put down, pen widths: one of paper and the pen's two
/// halves, and some more for what blur and threshold took.
const WIDEST_PENS: f64 = 2.3;
/// Allowance added to the widest gap, px, for hair lines.
const LEAST_PX: f64 = 1.5;
/// Lines that go on into each other bend less than this over the gap, rad (32°): 2 pens of a curve of the smallest
/// radius, 2 pens, would be 57°, but then its two sides lean as much.
const BEND: f64 = 0.56;
/// Largest bend across pale ink, rad. Directions of ends are less exact where ink fades.
const BEND_OF_PALE: f64 = 1.2;
/// And over what is no longer than this share of both widths: a small ring's halves bend much at their ends.
const BEND_OF_NEAR: f64 = 1.8;
const NEAR: f64 = 0.25;
/// The ink of a line that fades keeps this share of the ends' darkness.
const PALE: f64 = 0.6;
/// And that of one that was too pale for the mask this one.
const FAINT: f64 = 0.35;
/// Two ends of one line differ less than this in the width of their pen, as a ratio.
const LIKE: f64 = 1.6;

/// A line that the pen skipped is longer on both sides than so many times the paper between.
const LEAST_LENGTHS: f64 = 2.5;

/// The most paper that a line may cross, from a pixel beside ink to the next one: what is bridged, less the pen's two halves, px.
pub(crate) fn widest_paper(width: f64) -> f64 {
    (WIDEST_PENS - 1.0) * width + LEAST_PX
}

/// A free end of a row.
pub(crate) struct End {
    pub(crate) row: usize,
    end: usize,
    pub(crate) tip: Tip,
    pub(crate) width: f64,
    /// Of its row, px.
    pub(crate) length: f64,
}

/// The rows with those joined that go on into each other over a gap, the straightest first.
pub(crate) fn bridged(dark: &Plane<u8>, mut rows: Vec<Row>) -> Vec<Row> {
    draw_back(&mut rows);
    let mut rows = cornered(rows);
    orient_dots(&mut rows);
    let mut pairs = pairs(dark, &rows);
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut chains = Chains::new(rows);
    for (_, a, b) in pairs {
        chains.join(a, b, over);
    }
    chains.rows()
}

/// A line ends on another's very end if it is this near, pens.
const CORNER_PENS: f64 = 0.75;

/// The rows with those joined that end in one place, with nothing else: a corner, however sharp. One of them may have been ended
/// on the other, as on a bar.
fn cornered(rows: Vec<Row>) -> Vec<Row> {
    let all = rows.iter().enumerate().filter(|(_, row)| !row.closed && !row.dot && row.points.len() > 1);
    let ends: Vec<(Point, Place)> =
        all.flat_map(|(k, row)| [0, 1].map(|end| (row.end(end), (k, end)))).collect();
    let widest = rows.iter().map(|row| row.width).fold(0.0, f64::max);
    let near = Near::of(ends.iter().copied(), (CORNER_PENS * widest).max(0.1));
    let partner = |at: Point, (row, end): Place| {
        let beside = |&(p, &(other, other_end)): &(Point, &Place)| {
            let width = rows[row].width.min(rows[other].width);
            (other, other_end) != (row, end) && p.distance(at) <= CORNER_PENS * width
        };
        let mut others = near.around(at).filter(beside);
        others.next().map(|(_, place)| *place).filter(|_| others.next().is_none())
    };
    let pairs: Vec<(Place, Place)> = ends
        .iter()
        .filter_map(|&(at, a)| {
            let b = partner(at, a)?;
            let back = partner(rows[b.0].end(b.1), b)?;
            let is_open = rows[a.0].free[a.1] || rows[b.0].free[b.1];
            (a < b && back == a && is_open && a.0 != b.0).then_some((a, b))
        })
        .collect();
    let mut chains = Chains::new(rows);
    for (a, b) in pairs {
        chains.join(a, b, |_, _| Vec::new());
    }
    chains.rows()
}

/// A row as it was given, and which of its ends.
type Place = (usize, usize);

/// Pairs of ends that may be one line, with how much it would bend there, rad.
fn pairs(dark: &Plane<u8>, rows: &[Row]) -> Vec<(f64, Place, Place)> {
    let ends = ends(rows);
    let usual = median(&rows.iter().map(|row| row.width).collect::<Vec<_>>());
    let widest = |width: f64| WIDEST_PENS * width.max(0.8 * usual) + LEAST_PX;
    let is_near = |a: &End, b: &End| a.tip.at.distance(b.tip.at) <= widest(a.width.min(b.width));
    let near = near_pairs(&ends, |end| widest(end.width)).into_iter().filter(|(a, b)| is_near(a, b));
    near.filter_map(|(a, b)| fit(dark, a, b).map(|bend| (bend, (a.row, a.end), (b.row, b.end)))).collect()
}

/// More pairs of ends are not compared, which takes some milliseconds: so many near each other are a texture.
const MOST_PAIRS: usize = 4_000_000;

/// Pairs of ends that are near each other, the left one first: `reach` is how far from one its partners are at most, px.
pub(crate) fn near_pairs(ends: &[End], reach: impl Fn(&End) -> f64) -> Vec<(&End, &End)> {
    let mut order: Vec<&End> = ends.iter().collect();
    order.sort_by(|a, b| a.tip.at.x.total_cmp(&b.tip.at.x));
    let mut left = MOST_PAIRS;
    let mut found = Vec::new();
    for (k, a) in order.iter().enumerate() {
        let reach = reach(a);
        let right = order[k + 1..].iter().take_while(|b| b.tip.at.x - a.tip.at.x <= reach).take(left);
        left -= right.clone().count();
        found.extend(right.filter(|b| a.tip.at.distance(b.tip.at) <= reach).map(|b| (*a, *b)));
    }
    found
}

/// Largest lateral offset of two ends that overlap, pens.
const BESIDE: f64 = 0.6;
/// Largest overlap of two ends, pens.
const PASSED: f64 = 3.0;
/// Of a row that is drawn back this many pens stay at least.
const STAYS: f64 = 1.5;

/// Draws ends that have passed each other back to where they meet: where a line pales, either side of it was carried on to where
/// its ink ends.
fn draw_back(rows: &mut [Row]) {
    let ends = ends(rows);
    let have_passed = |a: &End, b: &End| {
        let (over, width) = (b.tip.at - a.tip.at, a.width.min(b.width));
        let is_beside = over.cross(a.tip.along).abs().max(over.cross(b.tip.along).abs()) < BESIDE * width;
        a.row != b.row
            && over.hypot() < PASSED * width
            && over.dot(a.tip.along) < 0.0
            && over.dot(b.tip.along) > 0.0
            && is_beside
            && angle(a.tip.along, -b.tip.along).abs() < BEND
    };
    let near = near_pairs(&ends, |end| PASSED * end.width).into_iter();
    let passed: Vec<(&End, &End)> = near.filter(|(a, b)| have_passed(a, b)).collect();
    let mut partners = vec![[0; 2]; rows.len()];
    let both = || passed.iter().flat_map(|&(a, b)| [(a, b), (b, a)]);
    both().for_each(|(end, _)| partners[end.row][end.end] += 1);
    // which of several lines it is, nothing tells
    for (end, other) in both().filter(|(end, _)| partners[end.row][end.end] == 1) {
        let middle = end.tip.at.midpoint(other.tip.at);
        rows[end.row].draw_back(end.end, middle, end.tip.along, STAYS * end.width);
    }
}

impl Row {
    /// Takes away an end's points that lie beyond a place, seen along the end's direction, as long as `stays` px are left.
    fn draw_back(&mut self, end: usize, at: Point, along: Vec2, stays: f64) {
        if end == 0 {
            self.points.reverse();
        }
        drop_beyond(&mut self.points, at, along, stays);
        if end == 0 {
            self.points.reverse();
        }
    }
}

/// More dots times rows than this are not compared, which takes some milliseconds.
const MOST_COMPARED: usize = 1_000_000;

/// Gives a dot between two ends the direction from one to the other: a dash of a broken line. Others stay dots.
fn orient_dots(rows: &mut [Row]) {
    let dots: Vec<usize> = (0..rows.len()).filter(|&i| rows[i].dot).collect();
    // so many dots are a texture
    if dots.len() * rows.len() > MOST_COMPARED {
        return;
    }
    for i in dots {
        let at = rows[i].points[0].midpoint(rows[i].points[1]);
        let reach = WIDEST_PENS * rows[i].width + LEAST_PX;
        let near: Vec<End> =
            ends_where(rows, |k, row| k != i && (0..2).any(|end| row.end(end).distance(at) < reach));
        let near: Vec<&End> = near.iter().filter(|end| end.tip.at.distance(at) < reach).collect();
        if let Some(along) = through(at, &near) {
            let half = along * (0.25 * rows[i].width);
            rows[i].points = vec![at - half, at + half];
            rows[i].dot = false;
        }
    }
}

/// The direction of the straightest way from one of these ends through a place to another, if it is straight.
fn through(at: Point, ends: &[&End]) -> Option<Vec2> {
    let middle = Tip::single(at);
    let pairs = (0..ends.len()).flat_map(|i| (i + 1..ends.len()).map(move |k| (ends[i], ends[k])));
    let bend = |(a, b): (&End, &End)| {
        let (to, on) = (at - a.tip.at, b.tip.at - at);
        let turned = angle(to, on).abs();
        (a.tip.bend(&middle) + turned + b.tip.bend(&middle), b.tip.at - a.tip.at)
    };
    let (least, along) = pairs.map(bend).min_by(|a, b| a.0.total_cmp(&b.0))?;
    (least < BEND).then(|| along.normalize())
}

fn ends(rows: &[Row]) -> Vec<End> {
    ends_where(rows, |_, row| !row.dot)
}

/// The free ends of some rows.
pub(crate) fn ends_where(rows: &[Row], wanted: impl Fn(usize, &Row) -> bool) -> Vec<End> {
    let all = rows
        .iter()
        .enumerate()
        .filter(|(i, row)| wanted(*i, row))
        .flat_map(|(row, r)| (0..2).map(move |end| (row, end, r)));
    let free = all.filter(|(_, end, r)| r.free[*end] && !r.closed);
    free.filter_map(|(row, end, r)| {
        let tip = Tip::of(&r.points, end)?;
        Some(End { row, end, tip, width: r.width, length: polyline_length(&r.points) })
    })
    .collect()
}

/// How much the line would bend from one end to the other, rad; `None` if it is not one line.
fn fit(dark: &Plane<u8>, a: &End, b: &End) -> Option<f64> {
    let like = a.width.max(b.width) <= LIKE * a.width.min(b.width) + 1.0;
    let bend = a.tip.bend(&b.tip);
    // the bars of two letters beside each other are no broken line
    let paper = a.tip.at.distance(b.tip.at) - 0.5 * (a.width + b.width);
    let is_near = paper < NEAR * (a.width + b.width);
    let is_long = || a.length.min(b.length) > LEAST_LENGTHS * paper;
    let is_one = (bend < BEND && (is_long() || is_darker(dark, a, b, FAINT)))
        || (bend < if is_near { BEND_OF_NEAR } else { BEND_OF_PALE } && is_darker(dark, a, b, PALE));
    (like && is_one).then_some(bend)
}

/// Whether between two ends it is everywhere darker than this share of them: the line fades there, and goes on.
fn is_darker(dark: &Plane<u8>, a: &End, b: &End, share: f64) -> bool {
    let (from, to) = (a.tip.at, b.tip.at);
    let steps = (2.0 * from.distance(to)).ceil().max(2.0);
    let along = |k: f64| dark.at(from.lerp(to, k / steps));
    let ends = along(0.0).min(along(steps));
    (1..steps as usize).all(|k| along(k as f64) > share * ends)
}

/// Rows strung together end to end.
struct Chains {
    rows: Vec<Option<Row>>,
    /// For each row's either end as it was given: the row it is now part of, and which end of it.
    now: Vec<[Option<Place>; 2]>,
}

impl Chains {
    fn new(rows: Vec<Row>) -> Self {
        let now = (0..rows.len()).map(|i| [Some((i, 0)), Some((i, 1))]).collect();
        Self { rows: rows.into_iter().map(Some).collect(), now }
    }

    /// Joins two ends, with points `over` the gap between them, unless one of them has been joined before.
    fn join(&mut self, a: Place, b: Place, over: impl Fn(&[Point], &[Point]) -> Vec<Point>) {
        let (Some((first, end)), Some((second, other))) = (self.now[a.0][a.1], self.now[b.0][b.1]) else {
            return;
        };
        (self.now[a.0][a.1], self.now[b.0][b.1]) = (None, None);
        if first == second {
            if let Some(row) = &mut self.rows[first] {
                let between = over(&row.points, &row.points);
                row.points.extend(between);
                row.closed = true;
            }
            return;
        }
        let (Some(mut head), Some(mut tail)) = (self.rows[first].take(), self.rows[second].take()) else {
            return;
        };
        if end == 0 {
            turn(&mut head);
        }
        if other == 1 {
            turn(&mut tail);
        }
        // the far ends now are the joined row's
        self.move_end((first, 1 - end), (first, 0));
        self.move_end((second, 1 - other), (first, 1));
        let between = over(&head.points, &tail.points);
        let share = head.points.len() as f64 / (head.points.len() + tail.points.len()) as f64;
        let width = head.width * share + tail.width * (1.0 - share);
        head.points.extend(between);
        head.points.extend(tail.points);
        self.rows[first] = Some(Row { width, free: [head.free[0], tail.free[1]], ..head });
    }

    /// The end that was at `from` is at `to` from now on.
    fn move_end(&mut self, from: Place, to: Place) {
        self.now.iter_mut().flatten().filter(|end| **end == Some(from)).for_each(|end| *end = Some(to));
    }

    fn rows(self) -> Vec<Row> {
        self.rows.into_iter().flatten().collect()
    }
}

fn turn(row: &mut Row) {
    row.points.reverse();
    row.free.reverse();
}

/// Points over the gap from the end of one row to the start of another.
fn over(head: &[Point], tail: &[Point]) -> Vec<Point> {
    match (Tip::of(head, 1), Tip::of(tail, 0)) {
        (Some(from), Some(to)) => from.smoothly_to(&to),
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A level row, free at both ends.
    fn row(from: i32, to: i32, y: f64) -> Row {
        let points = (from..=to).map(|x| Point::new(f64::from(x), y)).collect();
        Row { points, closed: false, width: 4.0, free: [true; 2], dot: false }
    }

    #[test]
    fn ends_that_passed_each_other_are_one_line_and_lines_beside_each_other_are_two() {
        let dark = Plane::filled(120, 60, 200);
        let joined = |beside: f64, passed: i32| {
            bridged(&dark, vec![row(10, 60, 30.0), row(60 - passed, 110, 30.0 + beside)])
        };
        for passed in [2, 5, 9] {
            let rows = joined(0.5, passed);
            assert_eq!(rows.len(), 1, "{passed} px");
            let columns: Vec<f64> = rows[0].points.iter().map(|p| p.x).collect();
            assert!(
                columns.windows(2).all(|pair| pair[0] < pair[1]),
                "{passed} px: it turns back: {columns:?}"
            );
        }
        assert_eq!(joined(6.0, 5).len(), 2, "beside");
        assert_eq!(joined(0.5, 40).len(), 2, "gone over");
    }
}
