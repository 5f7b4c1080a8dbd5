//! Which tiles a region touches, and which it fills.

use tracelight_stroke::{Point, Rect};

use super::grid::Grid;
use super::region::Region;
use super::scene::{Gate, GateKind};

/// Tiles of a row that a region fills or touches alike.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    pub(crate) row: usize,
    pub(crate) first: usize,
    pub(crate) last: usize,
    pub(crate) is_full: bool,
}

/// The tiles of a region by rows, from left to right; a tile counts as touched if an edge comes as close as `slack`, which
/// is not 0, for rounding must not leave one out. The function is told each segment, a row, and the first and last
/// column in it that the segment passes. Segments looked at are added to the work.
pub(crate) fn runs(
    region: &Region,
    grid: &Grid,
    slack: f64,
    work: &mut usize,
    mut visit: impl FnMut([Point; 2], usize, usize, usize),
) -> Vec<Run> {
    let mut touched: Vec<(usize, usize, usize)> = Vec::new();
    for &segment in region.segments() {
        grid.passed(segment, slack, |row, first, last| {
            visit(segment, row, first, last);
            if touched.last() != Some(&(row, first, last)) {
                touched.push((row, first, last));
            }
        });
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
        let (is_inside, looked) = region.contains(grid.middle(row, between.0));
        *work += looked;
        if is_inside {
            runs.push(Run { row, first: between.0, last: between.1, is_full: true });
        }
        runs.push(Run { row, first, last, is_full: false });
    }
    runs
}

/// Where a gate lets pass, tile by tile.
pub(crate) enum Coverage {
    /// Somewhere in the tiles of a rectangle.
    Within([usize; 2], [usize; 2]),
    /// As the runs of its region say.
    Runs(Vec<Run>),
}

impl Coverage {
    /// Of a gate alone, those around it aside.
    pub(crate) fn of(gate: &Gate, grid: &Grid, slack: f64, work: &mut usize) -> Self {
        if let GateKind::Clip(regions) = &gate.kind
            && let [(region, None)] = regions.as_slice()
        {
            return Self::Runs(runs(region, grid, slack, work, |_, _, _, _| ()));
        }
        Self::within(gate.bounds, grid)
    }

    fn within(bounds: Rect, grid: &Grid) -> Self {
        if bounds.x1 < bounds.x0 || bounds.y1 < bounds.y0 {
            return Self::Runs(Vec::new());
        }
        Self::Within(
            [grid.row(bounds.y0), grid.row(bounds.y1)],
            [grid.column(bounds.x0), grid.column(bounds.x1)],
        )
    }

    /// Whether it may let pass in a tile, and whether it lets pass in all of it.
    pub(crate) fn at(&self, row: usize, column: usize) -> [bool; 2] {
        match self {
            Self::Within([top, bottom], [left, right]) => {
                [(*top..=*bottom).contains(&row) && (*left..=*right).contains(&column), false]
            }
            Self::Runs(runs) => {
                let after = runs.partition_point(|run| (run.row, run.first) <= (row, column));
                let run = after.checked_sub(1).map(|before| runs[before]);
                let run = run.filter(|run| run.row == row && run.last >= column);
                [run.is_some(), run.is_some_and(|run| run.is_full)]
            }
        }
    }
}
