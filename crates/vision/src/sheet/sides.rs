//! Steps in a row, on a straight line through the rows: a side.

use super::steps::Step;

/// The steepest side of those that go down the rows: a little more than half a right angle, so that none falls between
/// those of rows and those of columns.
const STEEPEST: f64 = 1.05;
/// A step belongs to a line that passes so near, px.
const NEAR: f64 = 1.6;
/// A side is seen in at least this share of the rows.
const LEAST_SEEN: f64 = 0.15;
/// Sides of one kind that are looked at.
const MOST: usize = 6;

/// A straight side through rows: at row y it is at `at` + `slope`·y.
#[derive(Clone, Debug)]
pub(super) struct Side {
    pub(super) at: f64,
    pub(super) slope: f64,
    /// How many of the rows before each have a step of it; one more than there are rows.
    seen: Vec<u32>,
}

impl Side {
    /// In how many of some rows a step of it is seen.
    pub(super) fn seen(&self, rows: std::ops::Range<usize>) -> usize {
        let last = self.seen.len() - 1;
        (self.seen[rows.end.min(last)] - self.seen[rows.start.min(last)]) as usize
    }

    /// Whether a step of it is seen near a row.
    pub(super) fn is_seen_near(&self, row: usize) -> bool {
        self.seen(row.saturating_sub(2)..row + 3) > 1
    }
}

/// The sides along steps of one kind, the longest first; rows are `width` px long.
pub(super) fn of(rows: &[Vec<Step>], width: usize, rises: bool) -> Vec<Side> {
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
        let (mut n, mut sx, mut sy, mut sxy, mut syy) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for (x, y) in on {
            (n, sx, sy, sxy, syy) = (n + 1.0, sx + x, sy + y, sxy + x * y, syy + y * y);
        }
        let spread = n * syy - sy * sy;
        if spread > 1e-6 {
            slope = (n * sxy - sx * sy) / spread;
            at = (sx - slope * sy) / n;
        }
    }
    let is_on = |point: &Voter| (point.at.0 - at - slope * point.at.1).abs() < NEAR;
    let (on, rest): (Vec<Voter>, Vec<Voter>) = points.iter().partition(|point| is_on(point));
    let mut has = vec![0_u32; rows + 1];
    on.iter().for_each(|point| has[point.at.1 as usize + 1] = 1);
    (1..=rows).for_each(|y| has[y] += has[y - 1]);
    (Side { at, slope, seen: has }, on, rest)
}
