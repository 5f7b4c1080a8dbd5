//! What could be seen at each place of a page, so that few items are asked.

use tracelight_stroke::{Point, Rect};

use super::grid::Grid;
use super::scene::{Item, Number};

/// For each tile of a grid what touches it, the topmost first, down to what covers it all.
pub(crate) struct Tiles {
    grid: Grid,
    /// Number of the item and whether it fills the tile.
    lists: Vec<Vec<(Number, bool)>>,
}

/// Entries in all tiles at most, for the memory they take.
const MAX_ENTRIES: usize = 3_000_000;

/// Segments looked at, at most.
const MAX_WORK: usize = 30_000_000;

/// Tiles along the page's longer side, by the number of segments.
const SIDES: std::ops::RangeInclusive<f64> = 8.0..=256.0;

impl Tiles {
    /// Tiles over a rectangle. The function says of an item which rectangle shows of it and whether it hides all below.
    /// `None` if that takes more work than it may.
    pub(crate) fn new(items: &[Item], within: Rect, about: impl Fn(&Item) -> (Rect, bool)) -> Option<Self> {
        let segments: usize = items.iter().map(|item| item.region.segments().len()).sum();
        let wanted = (segments as f64).sqrt().clamp(*SIDES.start(), *SIDES.end());
        let mut side = wanted as usize;
        let mut work = 0;
        while work < MAX_WORK {
            let is_last = side as f64 <= *SIDES.start();
            let most = if is_last { usize::MAX } else { MAX_ENTRIES };
            if let Some(tiles) = Self::fill(items, Grid::new(within, side), &about, most, &mut work) {
                return Some(tiles);
            }
            if is_last {
                return None;
            }
            side /= 2;
        }
        None
    }

    /// `None` if there are more entries than allowed, or more work.
    fn fill(
        items: &[Item],
        grid: Grid,
        about: &impl Fn(&Item) -> (Rect, bool),
        most: usize,
        work: &mut usize,
    ) -> Option<Self> {
        let mut lists = vec![Vec::new(); grid.len()];
        let mut open = Open::new(&grid);
        let mut entries = 0;
        for (number, item) in items.iter().enumerate().rev() {
            let (shown, is_cover) = about(item);
            let bounds = item.region.bounds().intersect(shown);
            if item.region.segments().is_empty() || bounds.x1 < bounds.x0 || bounds.y1 < bounds.y0 {
                continue;
            }
            for run in runs(item, &grid, work) {
                let mut at = open.next(run.row, run.first);
                while at <= run.last {
                    let cell = run.row * grid.columns() + at;
                    lists[cell].push((number as Number, run.is_full));
                    entries += 1;
                    if run.is_full && is_cover {
                        open.close(run.row, at);
                    }
                    at = open.next(run.row, at + 1);
                }
            }
            if entries > most || *work > MAX_WORK {
                return None;
            }
        }
        Some(Self { grid, lists })
    }

    /// What may be seen at a point, the topmost first, and whether it is sure to be there.
    pub(crate) fn at(&self, p: Point) -> impl Iterator<Item = (Number, bool)> + '_ {
        let cell = self.grid.row(p.y) * self.grid.columns() + self.grid.column(p.x);
        self.lists[cell].iter().copied()
    }
}

/// Tiles of a row that an item fills or touches alike.
struct Run {
    row: usize,
    first: usize,
    last: usize,
    is_full: bool,
}

fn runs(item: &Item, grid: &Grid, work: &mut usize) -> Vec<Run> {
    let mut touched: Vec<(usize, usize, usize)> = Vec::new();
    for &segment in item.region.segments() {
        // a hair of slack: rounding must not leave out a tile that the edge passes
        grid.passed(segment, 1e-9, |row, first, last| touched.push((row, first, last)));
    }
    touched.sort_unstable();
    *work += touched.len();
    let mut runs: Vec<Run> = Vec::new();
    for (row, first, last) in touched {
        let before = runs.last_mut().filter(|run| run.row == row);
        let Some(before) = before else {
            runs.push(Run { row, first, last, is_full: false });
            continue;
        };
        if first <= before.last + 1 {
            before.last = before.last.max(last);
            continue;
        }
        let between = (before.last + 1, first - 1);
        let (is_inside, looked) = item.region.contains(grid.middle(row, between.0));
        *work += looked;
        if is_inside {
            runs.push(Run { row, first: between.0, last: between.1, is_full: true });
        }
        runs.push(Run { row, first, last, is_full: false });
    }
    runs
}

/// The tiles of which more is to be seen, each pointing to the next of its row.
struct Open {
    next: Vec<u32>,
    row: usize,
}

impl Open {
    fn new(grid: &Grid) -> Self {
        let row = grid.columns() + 1;
        Self { next: (0..grid.rows() * row).map(|i| (i % row) as u32).collect(), row }
    }

    /// The first open column from one on; that past the last if there is none.
    fn next(&mut self, row: usize, column: usize) -> usize {
        let base = row * self.row;
        let mut at = column.min(self.row - 1);
        while self.next[base + at] as usize != at {
            let next = self.next[base + at] as usize;
            self.next[base + at] = self.next[base + next];
            at = next;
        }
        at
    }

    fn close(&mut self, row: usize, column: usize) {
        self.next[row * self.row + column] = column as u32 + 1;
    }
}
