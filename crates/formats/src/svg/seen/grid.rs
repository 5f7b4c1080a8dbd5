//! Segments by the cells of a grid that they pass.

use tracelight_stroke::{Point, Rect};

/// A grid of square cells over a rectangle; what lies outside counts to the cells at its edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    corner: Point,
    cell: f64,
    columns: usize,
    rows: usize,
}

impl Grid {
    /// Cells over a rectangle, `side` of them along its longer side.
    pub(crate) fn new(bounds: Rect, side: usize) -> Self {
        let longer = bounds.width().max(bounds.height()).max(1e-9);
        let side = side.max(1);
        let cell = longer / side as f64;
        let count = |length: f64| ((length / cell).ceil() as usize).clamp(1, side);
        Self { corner: bounds.origin(), cell, columns: count(bounds.width()), rows: count(bounds.height()) }
    }

    pub(crate) const fn rows(&self) -> usize {
        self.rows
    }

    pub(crate) const fn columns(&self) -> usize {
        self.columns
    }

    /// Number of cells.
    pub(crate) const fn len(&self) -> usize {
        self.rows * self.columns
    }

    pub(crate) fn column(&self, x: f64) -> usize {
        (((x - self.corner.x) / self.cell).max(0.0) as usize).min(self.columns - 1)
    }

    pub(crate) fn row(&self, y: f64) -> usize {
        (((y - self.corner.y) / self.cell).max(0.0) as usize).min(self.rows - 1)
    }

    /// Middle of a cell.
    pub(crate) fn middle(&self, row: usize, column: usize) -> Point {
        self.corner + tracelight_stroke::Vec2::new(column as f64 + 0.5, row as f64 + 0.5) * self.cell
    }

    /// Each cell that a segment passes, or comes closer to than `slack`, in a row: the row, its first and last column.
    pub(crate) fn passed(&self, [a, b]: [Point; 2], slack: f64, mut visit: impl FnMut(usize, usize, usize)) {
        let (low, high) = if a.y <= b.y { (a, b) } else { (b, a) };
        let (first, last) = (self.row(low.y - slack), self.row(high.y + slack));
        if first == last {
            return visit(first, self.column(a.x.min(b.x) - slack), self.column(a.x.max(b.x) + slack));
        }
        let slope = (high.x - low.x) / (high.y - low.y).max(f64::MIN_POSITIVE);
        let x_at = |y: f64| {
            let (left, right) = (low.x.min(high.x), low.x.max(high.x));
            (low.x + (y.clamp(low.y, high.y) - low.y) * slope).clamp(left, right)
        };
        for row in first..=last {
            let top = self.corner.y + row as f64 * self.cell;
            // beyond the grid the rows at its edge go on
            let from = if row == first { low.y } else { top - slack };
            let to = if row == last { high.y } else { top + self.cell + slack };
            let (x0, x1) = (x_at(from), x_at(to));
            visit(row, self.column(x0.min(x1) - slack), self.column(x0.max(x1) + slack));
        }
    }
}

/// Numbers of segments by cells: those of a cell are `listed[begins[cell]..begins[cell + 1]]`.
pub(crate) struct Listing {
    pub(crate) grid: Grid,
    begins: Vec<u32>,
    listed: Vec<u32>,
}

/// Cells that a segment passes on average, at most about.
const PASSED: f64 = 4.0;

/// Cells for each segment, about, and along a side at most: a long narrow drawing has many columns and few rows.
const CELLS: f64 = 4.0;
const MOST_ALONG: f64 = 32_768.0;

impl Listing {
    /// Lists segments by the cells of a grid as fine as their number allows.
    pub(crate) fn new(bounds: Rect, segments: &[[Point; 2]], slack: f64) -> Self {
        let count = segments.len() as f64;
        let longer = bounds.width().max(bounds.height()).max(1e-9);
        let shorter = bounds.width().min(bounds.height()).max(1e-4 * longer);
        let length: f64 = segments.iter().map(|&[a, b]| a.distance(b).min(2.0 * longer)).sum();
        let enough = (CELLS * count.min(250_000.0) * longer / shorter).sqrt();
        let side = enough.min(PASSED * count * longer / length.max(1e-9)).clamp(8.0, MOST_ALONG);
        let grid = Grid::new(bounds, side as usize);
        let mut begins = vec![0_u32; grid.len() + 1];
        let each = |segment: [Point; 2], visit: &mut dyn FnMut(usize)| {
            grid.passed(segment, slack, |row, first, last| {
                (first..=last).for_each(|column| visit(row * grid.columns() + column));
            });
        };
        for &segment in segments {
            each(segment, &mut |cell| begins[cell + 1] += 1);
        }
        for cell in 0..grid.len() {
            begins[cell + 1] += begins[cell];
        }
        let mut listed = vec![0; begins[grid.len()] as usize];
        let mut at = begins.clone();
        for (number, &segment) in segments.iter().enumerate() {
            each(segment, &mut |cell| {
                listed[at[cell] as usize] = number as u32;
                at[cell] += 1;
            });
        }
        Self { grid, begins, listed }
    }

    /// Segments in the cells that a segment passes; one in several cells comes up in each.
    pub(crate) fn near(&self, segment: [Point; 2], mut visit: impl FnMut(u32)) {
        self.grid.passed(segment, 0.0, |row, first, last| {
            let cell = row * self.grid.columns();
            let listed =
                &self.listed[self.begins[cell + first] as usize..self.begins[cell + last + 1] as usize];
            listed.iter().for_each(|&number| visit(number));
        });
    }
}
