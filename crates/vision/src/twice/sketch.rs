//! The rows of a sketch with their neighbours, and which of them are a second pass of others.

use tracelight_image::Plane;

use super::place::{Place, is_beside, places, ways};
use crate::near::Near;
use crate::row::Row;

/// The middles of two passes are no further apart than this, pens; those that touch no further than that.
pub(super) const APART_PENS: f64 = 2.6;
const TOUCH_PENS: f64 = 1.0;
/// The slit between passes that are one all along is at least as dark as this share of the paler one.
const SLIT: f64 = 0.15;
/// They run beside each other for at least so many pens; a shorter one is a pass if all of it does.
const LONG_PENS: f64 = 5.0;
/// And one begins or ends there, to so many times as far as both are apart.
pub(super) const ENDS: f64 = 2.0;
/// Over more than this share of the way there is no third row that does not lie between both.
const THIRD: f64 = 0.3;
/// Places that are not beside the other row between two that are, px: a dark spot, a kink.
const SKIPPED_PX: f64 = 4.0;

/// What lies beside a place of a row.
#[derive(Clone, Debug, Default)]
struct Beside {
    /// The nearest place of each other row.
    nearest: Vec<Place>,
    /// Whether all that is beside it, itself too, reaches further than two passes are apart.
    is_wide: bool,
}

/// The rows of a sketch, by what lies beside them.
pub(super) struct Sketch<'a> {
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
pub(super) struct Run {
    /// The longer row, which stays.
    pub(super) kept: usize,
    /// The other one, and from which to which of its points it runs beside the first.
    pub(super) other: usize,
    pub(super) from: usize,
    pub(super) to: usize,
    /// For each of those points the one of the first row.
    pub(super) beside: Vec<usize>,
    pub(super) length: f64,
    /// Whether this is all of the other row.
    is_all: bool,
    /// Whether the row that stays is left where it lies: the other one is too short to tell of the line.
    pub(super) stays: bool,
}

/// A place of one row beside one of another one.
#[derive(Clone, Copy, Debug)]
struct Pair {
    number: usize,
    /// Whether there is no paper between them.
    is_one: bool,
    /// Whether they are so close that they touch.
    touches: bool,
}

impl<'a> Sketch<'a> {
    pub(super) fn of(dark: &'a Plane<u8>, rows: &'a [Row], pen: f64) -> Self {
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
    pub(super) fn runs(&self) -> Vec<Run> {
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
