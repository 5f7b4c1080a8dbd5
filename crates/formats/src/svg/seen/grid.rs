//! Segments by the cells of a grid that they pass.

use std::ops::Range;

use tracelight_stroke::{Point, Rect};

/// Cells along a side at most: a long narrow drawing has many columns and few rows.
const MOST_ALONG: f64 = 32_768.0;

/// A grid of square cells over a rectangle; what lies outside counts to the cells at its edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    corner: Point,
    cell: f64,
    columns: usize,
    rows: usize,
}

impl Grid {
    /// Square cells over a rectangle, about so many of them.
    pub(crate) fn new(bounds: Rect, cells: usize) -> Self {
        let [shorter, longer] = [bounds.width().min(bounds.height()), bounds.width().max(bounds.height())];
        let longer = longer.max(1e-9);
        let side = (cells as f64 * longer / shorter.max(1e-4 * longer)).sqrt().clamp(1.0, MOST_ALONG);
        let cell = longer / side.floor();
        let count = |length: f64| ((length / cell).ceil() as usize).clamp(1, side as usize);
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

    /// Adds each cell that a segment passes, or comes closer to than `slack`, with the segment's number: what [`Listing::new`] takes.
    pub(crate) fn list(&self, segment: [Point; 2], slack: f64, number: u32, pairs: &mut Vec<(u32, u32)>) {
        self.passed(segment, slack, |row, first, last| {
            let row = row * self.columns;
            pairs.extend((row + first..=row + last).map(|cell| (cell as u32, number)));
        });
    }

    /// Each cell that a segment passes, or comes closer to than `slack`, in a row: the row, its first and last column.
    pub(crate) fn passed(&self, [a, b]: [Point; 2], slack: f64, mut visit: impl FnMut(usize, usize, usize)) {
        let (low, high) = if a.y <= b.y { (a, b) } else { (b, a) };
        let (first, last) = (self.row(low.y - slack), self.row(high.y + slack));
        if first == last {
            return visit(first, self.column(a.x.min(b.x) - slack), self.column(a.x.max(b.x) + slack));
        }
        let (left, right) = (low.x.min(high.x), low.x.max(high.x));
        if high.y <= low.y {
            // as close to the rows on both sides all along
            let (from, to) = (self.column(left - slack), self.column(right + slack));
            return (first..=last).for_each(|row| visit(row, from, to));
        }
        let slope = (high.x - low.x) / (high.y - low.y);
        let x_at = |y: f64| (low.x + (y.clamp(low.y, high.y) - low.y) * slope).clamp(left, right);
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

/// Numbers of segments by the cells of a grid: those of a cell are `listed[begins[cell]..begins[cell + 1]]`.
pub(crate) struct Listing {
    grid: Grid,
    begins: Vec<u32>,
    listed: Vec<u32>,
}

impl Listing {
    /// Sorts pairs of a cell and a segment's number, which rises, by cells.
    pub(crate) fn new(grid: Grid, pairs: &[(u32, u32)]) -> Self {
        let mut begins = vec![0_u32; grid.len() + 1];
        for &(cell, _) in pairs {
            begins[cell as usize + 1] += 1;
        }
        for cell in 0..grid.len() {
            begins[cell + 1] += begins[cell];
        }
        let mut listed = vec![0; pairs.len()];
        let mut at = begins.clone();
        for &(cell, segment) in pairs {
            let place = &mut at[cell as usize];
            listed[*place as usize] = segment;
            *place += 1;
        }
        Self { grid, begins, listed }
    }

    /// Whether one of some segments, of numbers that follow each other, is in the cells that a segment passes and holds.
    pub(crate) fn any_near(&self, segment: [Point; 2], of: Range<u32>, holds: impl Fn(u32) -> bool) -> bool {
        let mut found = false;
        self.grid.passed(segment, 0.0, |row, first, last| {
            for cell in row * self.grid.columns() + first..=row * self.grid.columns() + last {
                let listed = &self.listed[self.begins[cell] as usize..self.begins[cell + 1] as usize];
                let own = &listed[listed.partition_point(|&number| number < of.start)..];
                found =
                    found || own.iter().take_while(|&&number| number < of.end).any(|&number| holds(number));
            }
        });
        found
    }

    /// Segments in the cells closer to a point than `reach`, and some further ones; one in several cells comes up in each.
    pub(crate) fn around(&self, p: Point, reach: f64, mut visit: impl FnMut(u32)) {
        let grid = &self.grid;
        let (first, last) = (grid.column(p.x - reach), grid.column(p.x + reach));
        for row in grid.row(p.y - reach)..=grid.row(p.y + reach) {
            let cell = row * grid.columns();
            let listed = self.begins[cell + first] as usize..self.begins[cell + last + 1] as usize;
            self.listed[listed].iter().for_each(|&number| visit(number));
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_segment_on_the_border_of_two_rows_passes_both_from_end_to_end() {
        let grid = Grid::new(Rect::new(0.0, 0.0, 8.0, 8.0), 64);
        for y in [3.995, 4.0, 4.005] {
            let mut passed = Vec::new();
            let segment = [Point::new(1.5, y), Point::new(6.5, y)];
            grid.passed(segment, 0.01, |row, first, last| passed.push((row, first, last)));
            assert_eq!(passed, [(3, 1, 6), (4, 1, 6)], "at {y}");
        }
    }
}
