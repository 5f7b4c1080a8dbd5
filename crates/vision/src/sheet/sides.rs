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
    let mut points = in_chains(rows, rises);
    let least = (LEAST_SEEN * rows.len() as f64).max(8.0);
    if (points.len() as f64) < least {
        return Vec::new();
    }
    let mut votes = Votes::new(width, rows.len());
    points.iter().for_each(|point| votes.add(*point, 1));
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
        on.iter().for_each(|point| votes.add(*point, -1));
        sides.push(side);
        points = rest;
    }
    sides
}

/// Steps of one kind that go on from row to row, as places; what is shorter is no side.
fn in_chains(rows: &[Vec<Step>], rises: bool) -> Vec<(f64, f64)> {
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
    chains.into_iter().filter(|chain| chain.len() >= LEAST).flatten().collect()
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

    fn add(&mut self, (x, y): (f64, f64), vote: i16) {
        let from_middle = ((y - self.middle) / Self::CELL) as f32;
        let (first, last) = (self.slope(0) as f32, self.slope(self.slopes - 1) as f32);
        let step = -(last - first) / (self.slopes - 1) as f32 * from_middle;
        let mut at = (x / Self::CELL) as f32 - first * from_middle;
        for counts in self.counts.chunks_exact_mut(self.cells) {
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

/// Steps, as places.
type Places = Vec<(f64, f64)>;

/// The side on a line, moved on to its steps, these, and the others.
fn taken(points: &[(f64, f64)], line: (f64, f64), rows: usize) -> (Side, Places, Places) {
    let (mut at, mut slope) = line;
    for near in [2.0 * NEAR, NEAR] {
        let on = points.iter().filter(|(x, y)| (x - at - slope * y).abs() < near);
        let (mut n, mut sx, mut sy, mut sxy, mut syy) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for &(x, y) in on {
            (n, sx, sy, sxy, syy) = (n + 1.0, sx + x, sy + y, sxy + x * y, syy + y * y);
        }
        let spread = n * syy - sy * sy;
        if spread > 1e-6 {
            slope = (n * sxy - sx * sy) / spread;
            at = (sx - slope * sy) / n;
        }
    }
    let (on, rest): (Places, Places) = points.iter().partition(|(x, y)| (x - at - slope * y).abs() < NEAR);
    let mut has = vec![0_u32; rows + 1];
    on.iter().for_each(|&(_, y)| has[y as usize + 1] = 1);
    (1..=rows).for_each(|y| has[y] += has[y - 1]);
    (Side { at, slope, seen: has }, on, rest)
}
