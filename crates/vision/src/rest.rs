//! Traces the ink that no row follows after junctions and pruning.
//!
//! A stub beside a junction's ink, a line that two others were taken for, the end of a hairpin: whatever the reason, ink
//! further from every row than its pen reaches was drawn by somebody. What is left of a patch without the ink of its rows
//! is thinned and followed as a patch of its own, and its ends are carried on to the rows that they touch.

use tracelight_image::distance::to_paper;
use tracelight_image::median::median;
use tracelight_image::{Mask, Plane, Region, regions};
use tracelight_stroke::{Point, polyline_length};

use crate::bridge::inked_towards;
use crate::centreline;
use crate::graph::WIDEST_RADIUS;
use crate::missed;
use crate::near::Near;
use crate::parts::graphs;
use crate::row::Row;

/// A row's own ink reaches so far from it, in half widths of its ink there, or of its pen, and px of blur.
const OWN_RADII: f64 = 1.2;
const OWN_PX: f64 = 0.5;
/// What is thinner than this share of the pen is the edge of a row's ink.
const SLIVER_PENS: f64 = 0.5;
/// What covers less of what no row follows than this share of the pen squared is a blot's.
const LEAST_PENS: f64 = 0.5;
/// What is shorter than this, in its own pens, from the row that it touches to its end, is a blot's.
const SHORT_PENS: f64 = 1.5;
/// A row is painted from point to point as far apart as this share of the reach at least: round the tightest bend that moves
/// its edge by a hundredth of it.
const STRIDE: f64 = 0.3;
/// From further off, pens, nothing is carried on to a row, however wide its ink is there.
const TIED_PENS: f64 = 5.0;

/// The rows with those of the ink that none of them follows, in these patches. A patch that they hardly follow at all is left
/// as it is: it is none of lines.
pub(crate) fn with_rest(dark: &Plane<u8>, patches: &[&Region], mut rows: Vec<Row>) -> Vec<Row> {
    let pen = median(&rows.iter().map(|row| row.width).collect::<Vec<_>>());
    let near = painted(dark, &rows, |row, _| missed::reach(row.width, pen));
    let mut ink = Mask::empty(dark.width, dark.height);
    for patch in patches {
        let bare = patch.area() - patch.cells(&near).count();
        if bare > 0 && !missed::is_none_of_lines(bare, patch.area()) {
            patch.fill_into(&mut ink);
        }
    }
    let seeds = ink.clone().without(&near);
    let least = LEAST_PENS * pen * pen;
    if (seeds.count() as f64) < least.max(1.0) {
        return rows;
    }
    let own = painted(dark, &rows, |row, at| own_reach(&ink, row, at));
    let lost = seeds.without(&own);
    let rest = ink.clone().without(&own).opened(((SLIVER_PENS * pen) as usize).max(2));
    let is_left = |region: &Region| region.cells(&lost).count() as f64 >= least;
    let left: Vec<Region> = regions(&rest).into_iter().filter(is_left).collect();
    if left.is_empty() {
        return rows;
    }
    let mut bare = dark.clone();
    bare.clear(&own);
    let none = Mask::empty(dark.width, dark.height);
    let found = graphs(dark, &rest, left);
    let found = found.iter().flat_map(|(region, graph)| centreline::rows(&bare, &none, region, graph));
    let leads_away = |row: &Row| {
        let is_lost = |p: &Point| lost.get(p.x.floor() as isize, p.y.floor() as isize);
        row.points.iter().any(is_lost) && polyline_length(&row.points) >= SHORT_PENS * row.width
    };
    let others = Others::of(&ink, &rows);
    let found: Vec<Row> = found.map(|row| tied(dark, row, &others)).filter(leads_away).collect();
    rows.extend(found);
    rows
}

/// How far a row's own ink reaches from one of its points, px: a line that swells is followed as far as it is wide.
fn own_reach(ink: &Mask, row: &Row, at: Point) -> f64 {
    OWN_RADII * radius(ink, at).max(0.5 * row.width) + OWN_PX
}

/// Half the width of the ink at a place, px; 0 on paper.
fn radius(ink: &Mask, at: Point) -> f64 {
    let (x, y) = (at.x.floor(), at.y.floor());
    match ink.get(x as isize, y as isize) {
        true => to_paper(ink, ink.cell(x as usize, y as usize), WIDEST_RADIUS),
        false => 0.0,
    }
}

/// The points of some rows, by place.
struct Others<'a> {
    ink: &'a Mask,
    rows: &'a [Row],
    /// Which row each is of, and whether that ends free there.
    points: Near<(usize, bool)>,
}

impl<'a> Others<'a> {
    fn of(ink: &'a Mask, rows: &'a [Row]) -> Self {
        let widest = rows.iter().map(|row| row.width).fold(1.0, f64::max);
        let points = rows.iter().enumerate().flat_map(|(number, row)| {
            let last = row.points.len() - 1;
            let ends = move |k: usize| !row.closed && (k == 0 && row.free[0] || k == last && row.free[1]);
            row.points.iter().enumerate().map(move |(k, &p)| (p, (number, ends(k))))
        });
        Self { ink, rows, points: Near::of(points, TIED_PENS * widest) }
    }

    /// The point nearest to the end of a row of some width whose ink that end touches, and whether it is a free end.
    fn nearest(&self, at: Point, width: f64) -> Option<(Point, bool)> {
        let touches = |&(p, &(number, _)): &(Point, &(usize, bool))| {
            let (away, other) = (p.distance(at), &self.rows[number]);
            away <= TIED_PENS * other.width.max(width) && away <= own_reach(self.ink, other, p) + width
        };
        let touched = self.points.around(at).filter(touches);
        let nearest = touched.min_by(|a, b| a.0.distance_squared(at).total_cmp(&b.0.distance_squared(at)));
        nearest.map(|(p, &(_, is_end))| (p, is_end))
    }
}

/// A row whose free ends are carried on to the others beside it, if there is ink all the way. Where another ends as well, both
/// may go on into each other.
fn tied(dark: &Plane<u8>, mut row: Row, others: &Others<'_>) -> Row {
    if row.closed {
        return row;
    }
    let place = |end: usize| row.end(end);
    let tie = |end: usize| {
        let nearest = others.nearest(place(end), row.width);
        nearest.filter(|&(stop, _)| inked_towards(dark, place(end), stop, row.width) == stop)
    };
    let mut ties = [tie(0), tie(1)];
    // a stub leads away from one place, not there and back
    if let [Some((first, _)), Some((last, _))] = ties
        && first.distance(last) < SHORT_PENS * row.width
    {
        let is_first = place(0).distance(first) < place(1).distance(last);
        ties[usize::from(is_first)] = None;
    }
    for (end, tie) in ties.into_iter().enumerate() {
        if let Some((stop, is_end)) = tie {
            row.points.insert(end * row.points.len(), stop);
            row.free[end] = is_end;
            row.dot = false;
        }
    }
    row
}

/// All pixels within a reach of these rows, which may differ from point to point.
fn painted(like: &Plane<u8>, rows: &[Row], reach: impl Fn(&Row, Point) -> f64) -> Mask {
    let mut mask = Mask::empty(like.width, like.height);
    for row in rows {
        let first: Option<&Point> = row.points.first().filter(|_| row.closed || row.points.len() == 1);
        let mut points = row.points.iter().chain(first).map(|&at| (at, reach(row, at))).peekable();
        let Some(mut from) = points.next() else { continue };
        while let Some(at) = points.next() {
            // of points that are close for their reach some are enough
            let is_close = at.1 == from.1 && at.0.distance(from.0) < STRIDE * at.1;
            if is_close && points.peek().is_some_and(|next| next.1 == at.1) {
                continue;
            }
            missed::paint(&mut mask, from.0, at.0, from.1.max(at.1));
            from = at;
        }
    }
    mask
}

#[cfg(test)]
mod tests {
    use tracelight_image::threshold::over;

    use super::*;

    /// A line 6 px wide along y = 50, with a stub so long and wide below it at x = 80, and what is made of the line alone.
    fn beside(length: usize, width: usize) -> Vec<Row> {
        let inked = |x: usize, y: usize| {
            let line = (20..140).contains(&x) && (47..53).contains(&y);
            let stub =
                (80 - width / 2..80 + width.div_ceil(2)).contains(&x) && (50..50 + length).contains(&y);
            line || stub
        };
        let values = (0..160 * 120).map(|i| 200 * u8::from(inked(i % 160, i / 160))).collect();
        let dark = Plane { width: 160, height: 120, values };
        let points = (23..=137).map(|x| Point::new(f64::from(x), 50.0)).collect();
        let line = Row { points, closed: false, width: 6.0, free: [true; 2], dot: false };
        with_rest(&dark, &regions(&over(&dark, 100)).iter().collect::<Vec<_>>(), vec![line])
    }

    #[test]
    fn a_stub_that_no_row_follows_is_drawn_from_the_row_that_it_touches() {
        for length in [18, 30, 60] {
            let rows = beside(length, 6);
            assert_eq!(rows.len(), 2, "{length} px long");
            let (first, last) = (rows[1].points[0], rows[1].points[rows[1].points.len() - 1]);
            let (joined, tip) = if first.y < last.y { (first, last) } else { (last, first) };
            assert!(joined.distance(Point::new(80.0, 50.0)) < 1.1, "{length} px long: from {joined}");
            let end = Point::new(80.0, 50.0 + length as f64 - 3.0);
            assert!(tip.distance(end) < 1.5, "{length} px long: to {tip}");
        }
    }

    #[test]
    fn a_bump_and_a_blot_are_the_rows_own() {
        assert_eq!(beside(8, 6).len(), 1);
        assert_eq!(beside(8, 12).len(), 1);
    }
}
