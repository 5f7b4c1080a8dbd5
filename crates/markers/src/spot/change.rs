//! Finds what is brighter in one image than in another.

use std::ops::Range;

use tracelight_image::Plane;
use tracelight_stroke::Point;

use super::window::SpotWindow;
use crate::light::{Border, light_of_levels, smooth};

/// Level from which on a pixel may be full.
const FULL: u8 = 250;
/// Fewest pixels of a window.
const FEWEST: usize = 25;
/// What became brighter, in light, in a part of an image.
pub(super) struct Change {
    pub(super) left: usize,
    pub(super) top: usize,
    pub(super) light: Plane<f32>,
    /// Pixels that say nothing: full, in either image.
    pub(super) full: Vec<bool>,
}

impl Change {
    pub(super) fn of(lit: &Plane<u8>, dark: &Plane<u8>, window: &SpotWindow) -> Option<Self> {
        if !(window.centre.x.is_finite() && window.centre.y.is_finite()) {
            return None;
        }
        let range = |at: f64, size: usize| {
            let low = (at - window.half_px as f64).clamp(0.0, size as f64) as usize;
            (low, (at + window.half_px as f64 + 1.0).clamp(0.0, size as f64) as usize)
        };
        let ((left, right), (top, bottom)) =
            (range(window.centre.x, lit.width), range(window.centre.y, lit.height));
        let (width, height) = (right - left, bottom - top);
        if width.min(height) < 5 || width * height < FEWEST {
            return None;
        }
        let curve = light_of_levels();
        let mut values = Vec::with_capacity(width * height);
        let mut full = Vec::with_capacity(width * height);
        for y in top..bottom {
            let both = || lit.row(y)[left..right].iter().zip(&dark.row(y)[left..right]);
            values.extend(both().map(|(&a, &b)| curve[usize::from(a)] - curve[usize::from(b)]));
            full.extend(both().map(|(&a, &b)| a >= FULL || b >= FULL));
        }
        Some(Self { left, top, light: Plane { width, height, values }, full })
    }

    /// A cell's middle in the pixel frame.
    pub(super) fn place(&self, cell: usize) -> Point {
        let (x, y) = (cell % self.light.width, cell / self.light.width);
        Point::new((self.left + x) as f64 + 0.5, (self.top + y) as f64 + 0.5)
    }

    /// Standard deviation of the noise of a pixel: by the median of what changed either way, which a spot's few pixels do not move.
    pub(super) fn noise(&self) -> f64 {
        let mut sizes: Vec<f32> = self.light.values.iter().map(|v| v.abs()).collect();
        let middle = sizes.len() / 2;
        f64::from(*sizes.select_nth_unstable_by(middle, f32::total_cmp).1) / 0.6745
    }

    /// The cell with the brightest mean of nine, and that.
    pub(super) fn peak(&self) -> (usize, f64) {
        let (width, height) = (self.light.width, self.light.height);
        let mut best = (width + 1, f32::MIN);
        let mut three = vec![0.0; width];
        for y in 1..height - 1 {
            let [above, own, below] = [y - 1, y, y + 1].map(|y| self.light.row(y));
            let columns = above.iter().zip(own).zip(below);
            three.iter_mut().zip(columns).for_each(|(sum, ((a, b), c))| *sum = a + b + c);
            let nine = || three.windows(3).map(|three| three[0] + three[1] + three[2]);
            let most = nine().fold(f32::MIN, |most, nine| if nine > most { nine } else { most });
            if most > best.1 {
                let x = nine().position(|nine| nine == most).unwrap_or_default();
                best = (y * width + x + 1, most);
            }
        }
        (best.0, f64::from(best.1 / 9.0))
    }

    /// A part of it, each pixel's light by its neighbours' too: 1 2 1 across, and down. A sensor that sees one colour a pixel fills in red between the pixels that saw it, by
    /// the mean of two; that pattern, of two pixels, is taken away, and what is left of the spot is a bell again. Nothing of it is full.
    pub(super) fn smoothed(&self, (columns, rows): (Range<usize>, Range<usize>)) -> Self {
        let (left, top) = (self.left + columns.start, self.top + rows.start);
        let mut light = self.light.part(columns, rows);
        smooth(&mut light, Border::GoesOn);
        let full = vec![false; light.values.len()];
        Self { left, top, light, full }
    }

    /// The cells about one that hang together and are brighter than that, with one more around.
    pub(super) fn patch(&self, from: usize, least: f64) -> Patch {
        let (width, height) = (self.light.width, self.light.height);
        let mut seen = vec![false; width * height];
        let (mut cells, mut next) = (Vec::new(), vec![from]);
        seen[from] = true;
        let mut touches_border = false;
        while let Some(cell) = next.pop() {
            cells.push(cell);
            let (x, y) = (cell % width, cell / width);
            let bright = f64::from(self.light.values[cell]) >= least || self.full[cell];
            if !bright && cell != from {
                continue;
            }
            touches_border |= x == 0 || y == 0 || x + 1 == width || y + 1 == height;
            for (dx, dy) in [(0, 1), (1, 0), (1, 2), (2, 1), (0, 0), (2, 0), (0, 2), (2, 2)] {
                let (Some(x), Some(y)) = ((x + dx).checked_sub(1), (y + dy).checked_sub(1)) else { continue };
                if x < width && y < height && !std::mem::replace(&mut seen[y * width + x], true) {
                    next.push(y * width + x);
                }
            }
        }
        Patch { cells, touches_border }
    }
}

/// Cells that hang together.
pub(super) struct Patch {
    pub(super) cells: Vec<usize>,
    pub(super) touches_border: bool,
}
