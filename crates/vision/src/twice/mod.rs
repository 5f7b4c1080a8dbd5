//! A line that was sketched twice is one line.
//!
//! Who sketches with a pencil goes over a line again, a little beside it. Where two rows run side by side, nearer to each other than two
//! lines would be drawn, both are passes of one line: between them, nearer to the darker one. Either the slit between them is no paper,
//! and one of them begins or ends there; or they touch, and wherever they part again one of them ends. Only in a sketch: with a pen two
//! lines beside each other, at a few degrees too, are two. A sketch shows by its lines, which are darker here and paler there, along
//! their way and one beside the other. Hatches, of which a third one is beside, stay.

use tracelight_image::Plane;
use tracelight_image::median::median;
use tracelight_maths::sin;
use tracelight_stroke::{Point, Vec2, polyline_length};

use crate::line::parted;
use crate::near::Near;
use crate::row::Row;

mod fold;
mod merge;
mod pencil;

/// The middles of two passes are no further apart than this, pens; those that touch no further than that.
const APART_PENS: f64 = 2.6;
const TOUCH_PENS: f64 = 1.0;
/// The slit between passes that are one all along is at least as dark as this share of the paler one.
const SLIT: f64 = 0.15;
/// They lead the same way within this angle, rad.
const ALIKE: f64 = 0.45;
/// They run beside each other for at least so many pens; a shorter one is a pass if all of it does.
const LONG_PENS: f64 = 5.0;
/// And one begins or ends there, to so many times as far as both are apart.
const ENDS: f64 = 2.0;
/// Over more than this share of the way there is no third row that does not lie between both.
const THIRD: f64 = 0.3;
/// Places that are not beside the other row between two that are, px: a dark spot, a kink.
const SKIPPED_PX: f64 = 4.0;
/// From point to point of a row that is looked at, px.
const STEP_PX: f64 = 1.0;
/// So often what was made of two rows is looked at again.
const ROUNDS: usize = 6;

/// A drawing's rows, each line once.
#[derive(Default)]
pub(crate) struct Once {
    pub(crate) rows: Vec<Row>,
    /// How the rows lay before, if it is a sketch; none of other drawings.
    pub(crate) before: Vec<Row>,
    /// Length of what was drawn again, px.
    pub(crate) again_px: f64,
}

/// The rows of which those that were drawn twice are one.
pub(crate) fn once(dark: &Plane<u8>, rows: Vec<Row>) -> Once {
    let pen = median(&rows.iter().filter(|row| !row.dot).map(|row| row.width).collect::<Vec<_>>());
    if pen <= 0.0 || !pencil::is_sketched(dark, &rows) {
        return Once { rows, ..Once::default() };
    }
    let before = rows.clone();
    let mut rows = fold::folded(dark, rows.into_iter().map(evenly).collect(), pen);
    for _ in 0..ROUNDS {
        let mut runs = Sketch::of(dark, &rows, pen).runs();
        if runs.is_empty() {
            break;
        }
        runs.sort_by(|a, b| b.length.total_cmp(&a.length));
        let mut is_taken = vec![false; rows.len()];
        for run in runs {
            if is_taken[run.kept] || is_taken[run.other] {
                continue;
            }
            (is_taken[run.kept], is_taken[run.other]) = (true, true);
            run.merge(dark, &mut rows, APART_PENS * pen);
        }
        rows.retain(|row| row.points.len() > 1);
    }
    Once { again_px: (length(&before) - length(&rows)).max(0.0), rows, before }
}

fn length(rows: &[Row]) -> f64 {
    rows.iter().map(|row| polyline_length(&row.points)).sum()
}

/// A row whose points follow each other as closely as they are looked at.
fn evenly(row: Row) -> Row {
    Row { points: parted(&row.points, row.closed, |far| (far / STEP_PX).ceil() as usize), ..row }
}

/// A place on a row.
#[derive(Clone, Copy, Debug)]
struct Place {
    row: usize,
    /// Its number on that row.
    number: usize,
    way: Vec2,
}

/// The ways from place to place of a row.
fn places(row: usize, r: &Row) -> impl Iterator<Item = Place> + '_ {
    let points = &r.points;
    (0..points.len()).map(move |number| Place { row, number, way: way_at(points, number) })
}

/// The direction at one of some points.
fn way_at(points: &[Point], number: usize) -> Vec2 {
    let (before, behind) = (number.saturating_sub(3), (number + 3).min(points.len() - 1));
    let way = points[behind] - points[before];
    way / way.hypot().max(1e-9)
}

/// Whether two places lie beside each other on ways that are nearly parallel.
fn is_beside(a: (Point, Vec2), b: (Point, Vec2)) -> bool {
    let across = b.0 - a.0;
    a.1.cross(b.1).abs() < sin(ALIKE) && across.dot(a.1).abs() < 0.7 * across.hypot() + 0.5
}

/// What lies beside a place of a row.
#[derive(Clone, Debug, Default)]
struct Beside {
    /// The nearest place of each other row.
    nearest: Vec<Place>,
    /// Whether all that is beside it, itself too, reaches further than two passes are apart.
    is_wide: bool,
}

/// The rows of a sketch, by what lies beside them.
struct Sketch<'a> {
    dark: &'a Plane<u8>,
    rows: &'a [Row],
    /// For each row how long the way is from its first point to each, px.
    ways: Vec<Vec<f64>>,
    /// For each row for each of its places.
    beside: Vec<Vec<Beside>>,
    pen: f64,
    /// Most that two passes are apart, px.
    apart: f64,
}

/// A stretch over which one row runs beside another.
#[derive(Clone, Debug)]
struct Run {
    /// The longer row, which stays.
    kept: usize,
    /// The other one, and from which to which of its points it runs beside the first.
    other: usize,
    from: usize,
    to: usize,
    /// For each of those points the one of the first row.
    beside: Vec<usize>,
    length: f64,
    /// Whether this is all of the other row.
    is_all: bool,
    /// Whether the row that stays is left where it lies: the other one is too short to tell of the line.
    stays: bool,
}

/// A place of one row beside one of another one.
#[derive(Clone, Copy, Debug)]
struct Pair {
    number: usize,
    /// Whether no paper is between them,
    is_one: bool,
    /// and whether they are so near that they touch.
    touches: bool,
}

impl<'a> Sketch<'a> {
    fn of(dark: &'a Plane<u8>, rows: &'a [Row], pen: f64) -> Self {
        let apart = APART_PENS * pen;
        let lines = || rows.iter().enumerate().filter(|(_, row)| !row.dot);
        let all = lines().flat_map(|(number, row)| places(number, row));
        let near = Near::of(all.map(|place| (rows[place.row].points[place.number], place)), apart);
        let mut beside = vec![Vec::new(); rows.len()];
        for (number, row) in lines() {
            beside[number] = places(number, row).map(|place| Beside::of(rows, place, &near, apart)).collect();
        }
        let ways = rows.iter().map(|row| ways(&row.points)).collect();
        Self { dark, rows, ways, beside, pen, apart }
    }

    /// All stretches of rows that are a second pass of others.
    fn runs(&self) -> Vec<Run> {
        let longer = |a: usize, b: usize| (self.length(a), a) > (self.length(b), b);
        let mut found = Vec::new();
        for (other, beside) in self.beside.iter().enumerate() {
            let mut kept: Vec<usize> =
                beside.iter().flat_map(|b| &b.nearest).map(|place| place.row).collect();
            kept.sort_unstable();
            kept.dedup();
            kept.retain(|&kept| longer(kept, other));
            found.extend(kept.into_iter().filter_map(|kept| self.run(kept, other)));
        }
        found
    }

    /// The longest stretch of a row beside a longer one, if both are one line there.
    fn run(&self, kept: usize, other: usize) -> Option<Run> {
        let pairs: Vec<Option<Pair>> =
            (0..self.beside[other].len()).map(|k| self.pair(kept, other, k)).collect();
        let one = || pairs.iter().map(|pair| pair.filter(|p| p.is_one)).collect::<Vec<_>>();
        self.stretch((kept, other), &pairs, |run| self.is_closed(run, &pairs))
            .or_else(|| self.stretch((kept, other), &one(), |run| self.ends_by(run).iter().any(|&ends| ends)))
    }

    fn pair(&self, kept: usize, other: usize, k: usize) -> Option<Pair> {
        let place = self.beside[other][k].nearest.iter().find(|place| place.row == kept)?;
        let (a, b) = (self.rows[other].points[k], self.rows[kept].points[place.number]);
        let slit = [0.35, 0.5, 0.65].map(|t| self.dark.at(a.lerp(b, t))).into_iter().fold(f64::MAX, f64::min);
        let touches = a.distance(b) <= TOUCH_PENS * self.pen;
        let is_one = slit >= SLIT * self.dark.at(a).min(self.dark.at(b));
        Some(Pair { number: place.number, is_one, touches })
    }

    /// The longest stretch of such pairs, if it is one of two passes as `is_pass` has it.
    fn stretch(
        &self,
        (kept, other): (usize, usize),
        pairs: &[Option<Pair>],
        is_pass: impl Fn(&Run) -> bool,
    ) -> Option<Run> {
        let way = &self.ways[other];
        let (mut best, mut start, mut last) = ((0, 0, 0.0), None, 0);
        for k in (0..pairs.len()).filter(|&k| pairs[k].is_some()) {
            let from = start.filter(|_| way[k] - way[last] <= SKIPPED_PX.max(self.apart)).unwrap_or(k);
            (start, last) = (Some(from), k);
            let long = way[k] - way[from];
            if long > best.2 {
                best = (from, k, long);
            }
        }
        let (from, to, length) = best;
        // between those that are seen the nearest that is
        let mut beside = Vec::with_capacity(to - from + 1);
        let mut known = pairs.get(from).copied().flatten()?.number;
        for pair in &pairs[from..=to] {
            known = pair.map_or(known, |pair| pair.number);
            beside.push(known);
        }
        let is_long = length >= LONG_PENS * self.pen;
        let is_all = way[from] < self.apart && self.length(other) - way[to] < self.apart;
        let run = Run { kept, other, from, to, beside, length, is_all, stays: !is_long };
        ((is_long || is_all) && !self.is_hatched(&run) && is_pass(&run)).then_some(run)
    }

    /// Whether there are more rows beside both than two passes or three would be.
    fn is_hatched(&self, run: &Run) -> bool {
        let is_wide = |(&kept, k): (&usize, usize)| {
            self.beside[run.other][k].is_wide || self.beside[run.kept][kept].is_wide
        };
        let wide = run.beside.iter().zip(run.from..).filter(|&pair| is_wide(pair)).count();
        wide as f64 > THIRD * run.beside.len() as f64
    }

    /// Whether one of both begins or ends at the first and at the last place of a stretch. Where both go on at both they are two that
    /// run together for a while.
    fn ends_by(&self, run: &Run) -> [bool; 2] {
        let reaches_end = |row, k| self.to_end(row, k) < ENDS * self.apart;
        let last = run.beside.len() - 1;
        [(run.from, 0), (run.to, last)]
            .map(|(k, i)| reaches_end(run.other, k) || reaches_end(run.kept, run.beside[i]))
    }

    /// How far it is from one of a row's points to its nearer end, px: infinitely far on a closed one.
    fn to_end(&self, row: usize, k: usize) -> f64 {
        let way = self.ways[row][k];
        if self.rows[row].closed { f64::INFINITY } else { way.min(self.length(row) - way) }
    }

    fn length(&self, row: usize) -> f64 {
        self.ways[row].last().copied().unwrap_or(0.0)
    }

    /// Whether both touch somewhere, and one ends, or both touch, wherever they part; or all of the shorter one runs beside the other, which
    /// goes on beyond it.
    fn is_closed(&self, run: &Run, pairs: &[Option<Pair>]) -> bool {
        let touches = |k: usize| pairs[k].is_some_and(|pair| pair.touches);
        let leaves = [run.beside[0], run.beside[run.beside.len() - 1]];
        let goes_on = || leaves.iter().any(|&k| self.to_end(run.kept, k) > ENDS * self.apart);
        let is_pass = (run.from..=run.to).any(touches) || run.is_all && goes_on();
        let ends = self.ends_by(run);
        is_pass && [(run.from, ends[0]), (run.to, ends[1])].into_iter().all(|(k, ends)| ends || touches(k))
    }
}

impl Beside {
    fn of(rows: &[Row], place: Place, near: &Near<Place>, apart: f64) -> Self {
        let at = rows[place.row].points[place.number];
        let mut others: Vec<(f64, f64, Place)> = near
            .around(at)
            .filter(|(p, q)| q.row != place.row && is_beside((at, place.way), (*p, q.way)))
            .map(|(p, q)| (p.distance_squared(at), place.way.cross(p - at), *q))
            .collect();
        others.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut nearest: Vec<(f64, Place)> = Vec::new();
        for (_, across, q) in others {
            if nearest.iter().all(|(_, known)| known.row != q.row) {
                nearest.push((across, q));
            }
        }
        let sides = nearest.iter().map(|(across, _)| *across);
        let (low, high) = sides.fold((0_f64, 0_f64), |(low, high), v| (low.min(v), high.max(v)));
        Self { is_wide: high - low > apart, nearest: nearest.into_iter().map(|(_, place)| place).collect() }
    }
}

/// How long the way is from the first of some points to each of them, px.
fn ways(points: &[Point]) -> Vec<f64> {
    let mut way = 0.0;
    let step = |k: usize| if k > 0 { points[k].distance(points[k - 1]) } else { 0.0 };
    (0..points.len())
        .map(|k| {
            way += step(k);
            way
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How much the sketch is turned, px down a px across: no hand draws along the rows.
    const DOWN: f64 = 0.08;

    fn turned(p: &Point, down: f64) -> Point {
        Point::new(p.x, p.y + down * (p.x - 20.0))
    }

    /// A plane on which these lines are 2 px wide, as dark as the way along them says, and the slit between y = 44 and 48.
    fn sketched(lines: &[Vec<Point>], slit: u8) -> (Plane<u8>, Vec<Row>) {
        let mut plane = Plane::filled(200, 140, 0_u8);
        let lines: Vec<Vec<Point>> =
            lines.iter().map(|line| line.iter().map(|p| turned(p, DOWN)).collect()).collect();
        for (number, line) in lines.iter().enumerate() {
            for (k, p) in line.iter().enumerate() {
                let level = 60.0 + 15.0 * number as f64 + 30.0 * (k as f64 / 9.0).sin();
                for (x, y) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    let (x, y) = ((p.x - 1.0) as usize + x, (p.y - 1.0) as usize + y);
                    plane.row_mut(y)[x] = level as u8;
                }
            }
        }
        for (x, y) in (20..180).flat_map(|x| (44..48).map(move |y| (x, y))) {
            let y = turned(&Point::new(x.into(), y.into()), DOWN).y as usize;
            let level = &mut plane.row_mut(y)[x as usize];
            *level = (*level).max(slit);
        }
        let row = |points: Vec<Point>| Row { points, closed: false, width: 2.5, free: [true; 2], dot: false };
        (plane, lines.into_iter().map(row).collect())
    }

    fn level(from: f64, to: f64, y: f64) -> Vec<Point> {
        (0..=(to - from) as usize).map(|k| Point::new(from + k as f64, y)).collect()
    }

    /// What becomes of these lines, beside four others.
    fn sketched_as(lines: &[Vec<Point>], slit: u8) -> Vec<Row> {
        let others = (0..4).map(|k| level(20.0, 180.0, 70.0 + 12.0 * f64::from(k)));
        let (plane, rows) = sketched(&lines.iter().cloned().chain(others).collect::<Vec<_>>(), slit);
        let mut rows = once(&plane, rows).rows;
        rows.iter_mut().flat_map(|row| &mut row.points).for_each(|p| *p = turned(p, -DOWN));
        rows.retain(|row| row.points[0].y < 65.0);
        rows
    }

    /// A line that bows away from a level one by so much between two places.
    fn bow(from: f64, to: f64, y: f64, by: f64) -> Vec<Point> {
        let aside = |x: f64| by * ((x - from) / (to - from) * std::f64::consts::PI).sin();
        level(from, to, y).into_iter().map(|p| Point::new(p.x, p.y + aside(p.x))).collect()
    }

    #[test]
    fn a_pencils_line_gone_over_again_is_one_line_between_both() {
        let rows = sketched_as(&[level(20.0, 180.0, 44.0), level(40.0, 150.0, 48.0)], 30);
        assert_eq!(rows.len(), 1);
        let at = |x: f64| rows[0].points.iter().find(|p| (p.x - x).abs() < 0.51).map_or(0.0, |p| p.y);
        assert!(
            (at(100.0) - 46.0).abs() < 0.7 && (at(22.0) - 44.0).abs() < 0.1,
            "{} {}",
            at(100.0),
            at(22.0)
        );
    }

    #[test]
    fn passes_with_paper_between_them_are_one_line() {
        // one that leaves the line and comes back to it, one that ends beside it, and one that runs beside it from end to end
        let line = level(20.0, 180.0, 44.0);
        for pass in [bow(50.0, 150.0, 44.0, 5.0), level(20.0, 110.0, 49.0), bow(20.0, 180.0, 44.0, 5.0)] {
            assert_eq!(sketched_as(&[line.clone(), pass], 0).len(), 1);
        }
    }

    #[test]
    fn lines_that_end_side_by_side_and_lines_that_cross_are_two() {
        let slope: Vec<Point> =
            (20..=180).map(|x| Point::new(x.into(), 30.0 + 0.2 * f64::from(x - 20))).collect();
        for other in [level(20.0, 180.0, 49.0), slope, bow(20.0, 180.0, 60.0, -16.0)] {
            assert_eq!(sketched_as(&[level(20.0, 180.0, 44.0), other], 0).len(), 2);
        }
    }

    #[test]
    fn a_line_that_comes_back_beside_itself_ends_where_it_turns() {
        let round = |k: usize| {
            let angle = std::f64::consts::PI * (k as f64 / 8.0 - 0.5);
            Point::new(150.0 + 2.5 * angle.cos(), 46.5 + 2.5 * angle.sin())
        };
        let back: Vec<Point> = level(60.0, 150.0, 49.0).into_iter().rev().collect();
        let there: Vec<Point> = [level(20.0, 149.0, 44.0), (0..8).map(round).collect(), back].concat();
        let rows = sketched_as(&[there], 0);
        assert_eq!(rows.len(), 1);
        let furthest = rows[0].points.iter().map(|p| p.x).fold(0.0, f64::max);
        assert!(rows[0].points[0].x == 20.0 && (150.0..154.0).contains(&furthest), "{furthest}");
        assert!(polyline_length(&rows[0].points) < 140.0);
    }

    #[test]
    fn hatching_stays() {
        let hatches: Vec<_> =
            (0..6).map(|k| level(20.0 + 9.0 * f64::from(k % 2), 180.0, 14.0 + 5.0 * f64::from(k))).collect();
        assert_eq!(sketched_as(&hatches, 0).len(), 6);
    }
}
