//! Steps in a row, on a straight line through the rows: a side.

use tracelight_image::{Plane, solve};
use tracelight_stroke::Point;

use crate::steps::Step;

/// The steepest side of those that go down the rows: a little more than half a right angle, so that none falls between
/// those of rows and those of columns.
const STEEPEST: f64 = 1.05;
/// A step belongs to a line that passes so near, px.
const NEAR: f64 = 1.6;
/// A side is seen in at least this share of the rows.
const LEAST_SEEN: f64 = 0.15;
/// Sides of one kind that are looked at.
const MOST: usize = 6;

/// What is not seen of a side counts so many times as much as what is.
const UNSEEN: f64 = 1.5;
/// A sheet's shadow on another one leaves less than this share of the light.
const VALLEY: f64 = 0.96;
/// It is narrower than this to either side, px, and seen along so many rows to either way.
const VALLEY_PX: usize = 6;
const VALLEY_ROWS: usize = 3;

/// A straight side through rows: at row y it is at `at` + `slope`·y.
#[derive(Clone, Debug)]
pub(crate) struct Side {
    pub(crate) at: f64,
    pub(crate) slope: f64,
    /// How many of the rows before each have a step of it; one more than there are rows.
    seen: Vec<u32>,
    /// Whether it is a dark line at each row, and before how many of them it is one without a step.
    is_line: Vec<bool>,
    lines: Vec<u32>,
}

impl Side {
    /// In how many of some rows a step of it is seen.
    pub(crate) fn seen(&self, rows: std::ops::Range<usize>) -> usize {
        within(&self.seen, rows)
    }

    /// Where it is at a row, or at a column of those that go across.
    pub(crate) const fn place(&self, is_upright: bool, row: f64) -> Point {
        let at = self.at + self.slope * row;
        if is_upright { Point::new(at, row) } else { Point::new(row, at) }
    }

    /// Looks where it is a dark line: where a sheet lies on another one as bright, its edge is seen by its shadow.
    pub(crate) fn look_for_lines(&mut self, plane: &Plane<u8>) {
        let rows = self.seen.len() - 1;
        self.is_line = (0..rows).map(|y| self.is_valley(plane, y)).collect();
        self.lines = vec![0; rows + 1];
        for y in 0..rows {
            let is_line = self.is_line[y] && self.seen[y + 1] == self.seen[y];
            self.lines[y + 1] = self.lines[y] + u32::from(is_line);
        }
    }

    /// Whether at a row, and some rows to either way, it is darker on it than on both sides of it.
    fn is_valley(&self, plane: &Plane<u8>, row: usize) -> bool {
        let rows = row.saturating_sub(VALLEY_ROWS)..(row + VALLEY_ROWS + 1).min(plane.height);
        let count = rows.len() as f64;
        let mut sums = [0.0; 2 * VALLEY_PX + 1];
        for y in rows {
            let middle = (self.at + self.slope * (y as f64 + 0.5)).floor();
            if middle < VALLEY_PX as f64 || middle >= (plane.width - VALLEY_PX) as f64 {
                return false;
            }
            let first = middle as usize - VALLEY_PX;
            let levels = &plane.row(y)[first..=first + 2 * VALLEY_PX];
            sums.iter_mut().zip(levels).for_each(|(sum, level)| *sum += f64::from(*level) / count);
        }
        let beside = |of: std::ops::Range<usize>| sums[of].iter().sum::<f64>() / 3.0;
        let (before, behind) = (beside(0..3), beside(2 * VALLEY_PX - 2..2 * VALLEY_PX + 1));
        let least = sums[VALLEY_PX - 2..=VALLEY_PX + 2].iter().copied().fold(f64::INFINITY, f64::min);
        least < VALLEY * before.min(behind)
    }

    /// Whether it is a dark line at a row.
    pub(crate) fn is_line_at(&self, row: usize) -> bool {
        self.is_line.get(row).copied().unwrap_or(false)
    }

    /// In how many of some rows there is no step of it, but a dark line.
    pub(crate) fn lines(&self, rows: std::ops::Range<usize>) -> usize {
        within(&self.lines, rows)
    }

    /// How much more of it is seen than not, px; a dark line is neither.
    pub(crate) fn score(&self, rows: std::ops::Range<usize>) -> f64 {
        let (all, seen, lines) = (rows.len(), self.seen(rows.clone()), self.lines(rows));
        seen as f64 - UNSEEN * (all - seen - lines) as f64
    }

    /// Whether a step of it is seen near a row.
    pub(crate) fn is_seen_near(&self, row: usize) -> bool {
        self.seen(row.saturating_sub(2)..row + 3) > 1
    }
}

/// How many there are in some rows, by how many there are before each row.
fn within(before: &[u32], rows: std::ops::Range<usize>) -> usize {
    let last = before.len() - 1;
    (before[rows.end.min(last)] - before[rows.start.min(last)]) as usize
}

/// The sides along steps of one kind, the longest first; rows are `width` px long.
pub(crate) fn of(rows: &[Vec<Step>], width: usize, rises: bool) -> Vec<Side> {
    let mut points: Vec<Voter> = in_chains(rows, rises).iter().flat_map(|chain| voters(chain)).collect();
    let least = (LEAST_SEEN * rows.len() as f64).max(8.0);
    if (points.len() as f64) < least {
        return Vec::new();
    }
    let mut votes = Votes::new(width, rows.len());
    points.iter().for_each(|point| votes.add(point, 1));
    let mut sides = Vec::new();
    while sides.len() < MOST && points.len() as f64 >= least {
        let (count, line) = votes.strongest();
        if f64::from(count) < 0.8 * least {
            break;
        }
        let (side, on, rest) = taken(&points, line, rows.len());
        if (side.seen(0..rows.len()) as f64) < least {
            break;
        }
        on.iter().for_each(|point| votes.add(point, -1));
        sides.push(side);
        points = rest;
    }
    sides
}

/// Steps of one kind that go on from row to row, as places; what is shorter is no side.
fn in_chains(rows: &[Vec<Step>], rises: bool) -> Vec<Vec<(f64, f64)>> {
    /// From row to row a step moves by less, px.
    const NEXT: f32 = 2.2;
    /// Rows in a chain.
    const LEAST: usize = 7;
    let mut chains: Vec<Vec<(f64, f64)>> = Vec::new();
    // chains that ended in each of the last two rows: where, and which
    let mut open: [Vec<(f32, usize)>; 2] = Default::default();
    for (y, steps) in rows.iter().enumerate() {
        let mut here = Vec::new();
        for step in steps.iter().filter(|step| step.rises == rises) {
            let reach = |(rows, ends): (usize, &Vec<(f32, usize)>)| {
                let near = |end: &&(f32, usize)| (end.0 - step.at).abs() < NEXT * (rows + 1) as f32;
                ends.iter().find(near).map(|end| end.1)
            };
            let chain = open.iter().enumerate().find_map(reach).unwrap_or_else(|| {
                chains.push(Vec::new());
                chains.len() - 1
            });
            chains[chain].push((f64::from(step.at), y as f64 + 0.5));
            here.push((step.at, chain));
        }
        open = [here, std::mem::take(&mut open[0])];
    }
    chains.retain(|chain| chain.len() >= LEAST);
    chains
}

/// A step, and between which slopes the lines are that it may lie on.
#[derive(Clone, Copy, Debug)]
struct Voter {
    at: (f64, f64),
    slopes: (f64, f64),
}

/// The steps of a chain: with those before and behind it each lies on lines about as steep as they are.
fn voters(chain: &[(f64, f64)]) -> impl Iterator<Item = Voter> {
    /// Steps that are taken together.
    const TOGETHER: usize = 16;
    let pieces = chain.len().div_ceil(TOGETHER);
    let piece = move |k: usize| &chain[k * chain.len() / pieces..(k + 1) * chain.len() / pieces];
    (0..pieces).map(piece).flat_map(|piece| {
        let (first, last) = (piece[0], piece[piece.len() - 1]);
        let rows = (last.1 - first.1).max(1.0);
        let (slope, reach) = ((last.0 - first.0) / rows, 4.0 * NEAR / rows);
        piece.iter().map(move |&at| Voter { at, slopes: (slope - reach, slope + reach) })
    })
}

/// How many steps lie on each line (Hough, "Method and means for recognizing complex patterns", 1962).
struct Votes {
    /// By slope, then by place in the middle row: a line that begins or ends outside has its middle inside.
    counts: Vec<i16>,
    cells: usize,
    slopes: usize,
    middle: f64,
}

impl Votes {
    /// Px.
    const CELL: f64 = 2.0;

    fn new(width: usize, height: usize) -> Self {
        // from slope to slope a line's end moves by a cell
        let slopes = (STEEPEST * height as f64 / Self::CELL).ceil() as usize + 1;
        let cells = (width as f64 / Self::CELL).ceil() as usize + 2;
        Self { counts: vec![0; slopes * cells], cells, slopes, middle: 0.5 * height as f64 }
    }

    fn slope(&self, number: usize) -> f64 {
        STEEPEST * (2.0 * number as f64 / (self.slopes - 1) as f64 - 1.0)
    }

    fn add(&mut self, voter: &Voter, vote: i16) {
        let (x, y) = voter.at;
        let number = |slope: f64| 0.5 * (slope / STEEPEST + 1.0) * (self.slopes - 1) as f64;
        let first = number(voter.slopes.0).floor().max(0.0) as usize;
        let last = (number(voter.slopes.1).ceil().max(0.0) as usize).min(self.slopes - 1);
        let from_middle = ((y - self.middle) / Self::CELL) as f32;
        let step = -(self.slope(1) - self.slope(0)) as f32 * from_middle;
        let mut at = (x / Self::CELL) as f32 - self.slope(first) as f32 * from_middle;
        for counts in self.counts.chunks_exact_mut(self.cells).take(last + 1).skip(first) {
            // what lies before the first cell is cut to −0, and must not count as in it
            if let Some(count) = counts.get_mut(at as usize).filter(|_| at >= 0.0) {
                *count += vote;
            }
            at += step;
        }
    }

    /// The line with most steps, which may lie between two cells, and how many: its place in the first row, and its slope.
    fn strongest(&self) -> (i16, (f64, f64)) {
        let mut best = (0, 0, 0);
        for number in 0..self.slopes {
            let counts = &self.counts[number * self.cells..][..self.cells];
            for (cell, pair) in counts.windows(2).enumerate() {
                if pair[0] + pair[1] > best.0 {
                    best = (pair[0] + pair[1], number, cell);
                }
            }
        }
        let (count, number, cell) = best;
        let slope = self.slope(number);
        (count, (Self::CELL * (cell + 1) as f64 - slope * self.middle, slope))
    }
}

/// The side on a line, moved on to its steps, these, and the others.
fn taken(points: &[Voter], line: (f64, f64), rows: usize) -> (Side, Vec<Voter>, Vec<Voter>) {
    let (mut at, mut slope) = line;
    for near in [2.0 * NEAR, NEAR] {
        let on = points.iter().map(|point| point.at).filter(|(x, y)| (x - at - slope * y).abs() < near);
        (at, slope) = solve::line(on.map(|(x, y)| (y, x, 1.0))).unwrap_or((at, slope));
    }
    let is_on = |point: &Voter| (point.at.0 - at - slope * point.at.1).abs() < NEAR;
    let (on, rest): (Vec<Voter>, Vec<Voter>) = points.iter().partition(|point| is_on(point));
    let mut has = vec![0_u32; rows + 1];
    on.iter().for_each(|point| has[point.at.1 as usize + 1] = 1);
    (1..=rows).for_each(|y| has[y] += has[y - 1]);
    (Side { at, slope, seen: has, is_line: Vec::new(), lines: Vec::new() }, on, rest)
}
