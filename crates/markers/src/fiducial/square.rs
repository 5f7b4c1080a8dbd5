//! Maps a marker's cells to the image.

use tracelight_image::Projection;
use tracelight_image::solve::linear;
use tracelight_stroke::{Point, Vec2};

/// Cells of a side with the black border.
pub(super) const SIDE: usize = 8;

/// From cells to pixels: (0, 0) is the first corner of the black border, (8, 0) the second, (8, 8) the third.
#[derive(Clone, Copy, Debug)]
pub(super) struct Square(Projection);

/// A place across a boundary: in cells; how far off it is, px; and the unit vector along which.
pub(super) type Off = (Point, f64, Vec2);

impl Square {
    /// With these corners, in order.
    pub(super) fn of(corners: &[Point; 4]) -> Option<Self> {
        Projection::of((SIDE as f64, SIDE as f64), corners).map(Self)
    }

    /// Where a place in cells is, px; `None` behind the camera.
    pub(super) fn at(&self, x: f64, y: f64) -> Option<Point> {
        self.0.at(x, y)
    }

    /// Maps a position, and gives the steps of one cell across and one cell down there, px.
    pub(super) fn with_slopes(&self, x: f64, y: f64) -> Option<(Point, Vec2, Vec2)> {
        self.0.with_slopes(x, y)
    }

    /// Its corners, px.
    pub(super) fn corners(&self) -> Option<[Point; 4]> {
        const FAR: f64 = SIDE as f64;
        let [a, b, c, d] = [(0.0, 0.0), (FAR, 0.0), (FAR, FAR), (0.0, FAR)].map(|(x, y)| self.at(x, y));
        Some([a?, b?, c?, d?])
    }

    /// Moved for places to be off as little as can be: a step of Gauss and Newton's method.
    pub(super) fn moved(&self, places: &[Off]) -> Option<Self> {
        let mut rows = [[0.0; 9]; 8];
        for &(cell, off, normal) in places {
            let Projection([_, _, _, _, _, _, g, h]) = self.0;
            let w = g * cell.x + h * cell.y + 1.0;
            let at = self.at(cell.x, cell.y)?;
            let (x, y, one) = (cell.x / w, cell.y / w, 1.0 / w);
            let (n, far) = (normal, normal.dot(at.to_vec2()));
            let by = [n.x * x, n.x * y, n.x * one, n.y * x, n.y * y, n.y * one, -far * x, -far * y];
            for (row, factor) in rows.iter_mut().zip(by) {
                row.iter_mut().zip(by.into_iter().chain([off])).for_each(|(sum, term)| *sum += factor * term);
            }
        }
        // the last two are thousands of times as large as the others: in even sizes no pivot looks like nothing
        let sizes: [f64; 8] = std::array::from_fn(|k| rows[k][k].sqrt().max(1e-300));
        for (i, row) in rows.iter_mut().enumerate() {
            row.iter_mut()
                .enumerate()
                .for_each(|(j, v)| *v /= sizes[i] * sizes.get(j).copied().unwrap_or(1.0));
        }
        let step = linear(rows)?;
        let Projection(terms) = self.0;
        Some(Self(Projection(std::array::from_fn(|k| terms[k] + step[k] / sizes[k]))))
    }
}
