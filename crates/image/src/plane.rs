use std::ops::Range;

use tracelight_stroke::{Point, Vec2};

use crate::mask::Mask;

/// Values on a grid of pixels, row by row from the top left.
#[derive(Clone)]
pub struct Plane<T> {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `width · height` of them, row by row.
    pub values: Vec<T>,
}

/// Its size; a picture's worth of numbers helps nobody.
impl<T> std::fmt::Debug for Plane<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Plane({} × {})", self.width, self.height)
    }
}

impl<T: Copy + Default> Plane<T> {
    /// One value everywhere.
    pub fn filled(width: usize, height: usize, value: T) -> Self {
        Self { width, height, values: vec![value; width * height] }
    }

    /// The values of a row.
    pub fn row(&self, y: usize) -> &[T] {
        &self.values[y * self.width..][..self.width]
    }

    /// Returns a row for writing.
    pub fn row_mut(&mut self, y: usize) -> &mut [T] {
        &mut self.values[y * self.width..][..self.width]
    }

    /// Its values in some columns and rows.
    pub fn part(&self, columns: Range<usize>, rows: Range<usize>) -> Self {
        let (width, height) = (columns.len(), rows.len());
        let values = rows.flat_map(|y| self.row(y)[columns.clone()].iter().copied()).collect();
        Self { width, height, values }
    }

    /// Sets the pixels of a mask, as large as this, to the default.
    pub fn clear(&mut self, mask: &Mask) {
        for cell in mask.cells() {
            let (x, y) = mask.place(cell);
            self.row_mut(y)[x] = T::default();
        }
    }

    /// The value at a pixel; the default outside.
    pub fn get(&self, x: isize, y: isize) -> T {
        match (usize::try_from(x), usize::try_from(y)) {
            (Ok(x), Ok(y)) if x < self.width && y < self.height => self.values[y * self.width + x],
            _ => T::default(),
        }
    }

    /// Rows as columns, in squares that fit into the cache.
    pub fn transposed(&self) -> Self {
        const SQUARE: usize = 32;
        let (w, h) = (self.width, self.height);
        let mut out = Self::filled(h, w, T::default());
        for top in (0..h).step_by(SQUARE) {
            for left in (0..w).step_by(SQUARE) {
                let bottom = (top + SQUARE).min(h);
                for x in left..(left + SQUARE).min(w) {
                    let column = out.values[x * h..][top..bottom].iter_mut();
                    column.enumerate().for_each(|(down, v)| *v = self.values[(top + down) * w + x]);
                }
            }
        }
        out
    }

    /// Whether the value with this number is one of the outermost.
    pub fn is_at_border(&self, i: usize) -> bool {
        let (x, y) = (i % self.width, i / self.width);
        x == 0 || y == 0 || x + 1 == self.width || y + 1 == self.height
    }

    /// Whether a place is within the image.
    pub fn holds(&self, p: Point) -> bool {
        (0.0..self.width as f64).contains(&p.x) && (0.0..self.height as f64).contains(&p.y)
    }

    /// Adds to a patch of values, by their numbers, all that it reaches from neighbour to neighbour, row by row and column by column; `joins`
    /// says whether the first leads to the second. What is `seen` already is not reached; the patch is part of it.
    pub fn flood(&self, patch: &mut Vec<usize>, seen: &mut [bool], joins: impl Fn(usize, usize) -> bool) {
        let mut next = 0;
        while let Some(&i) = patch.get(next) {
            let (x, y) = ((i % self.width) as isize, (i / self.width) as isize);
            for (x, y) in [(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)] {
                let inside = (0..self.width as isize).contains(&x) && (0..self.height as isize).contains(&y);
                if inside {
                    let k = y as usize * self.width + x as usize;
                    if !seen[k] && joins(i, k) {
                        seen[k] = true;
                        patch.push(k);
                    }
                }
            }
            next += 1;
        }
    }

    /// The nearest place within the image.
    pub fn clamp(&self, p: Point) -> Point {
        Point::new(p.x.clamp(0.0, self.width as f64), p.y.clamp(0.0, self.height as f64))
    }

    /// Equal steps from a place on: of each, the number of the pixel up left of it, and how far it is from that one's centre to the next's,
    /// across and down, in 65536ths. `None` where a step has no pixels' centres on all sides, and on a plane longer than [`LONGEST`].
    pub fn steps(
        &self,
        from: Point,
        step: Vec2,
        count: usize,
    ) -> Option<impl Iterator<Item = (usize, i32, i32)> + use<T>> {
        let to = from + step * count.saturating_sub(1) as f64;
        let inside = |p: Point| {
            (0.5..self.width as f64 - 0.501).contains(&p.x)
                && (0.5..self.height as f64 - 0.501).contains(&p.y)
        };
        if !(inside(from) && inside(to)) || self.width.max(self.height) > LONGEST {
            return None;
        }
        // whole numbers are cut at the pixel sooner than broken ones
        let fixed = |v: f64| (v * 65536.0) as i32;
        let ((mut x, mut y), (dx, dy)) =
            ((fixed(from.x - 0.5), fixed(from.y - 0.5)), (fixed(step.x), fixed(step.y)));
        let width = self.width;
        Some((0..count).map(move |_| {
            let at = ((y >> 16) as usize * width + (x >> 16) as usize, x & 0xffff, y & 0xffff);
            (x, y) = (x + dx, y + dy);
            at
        }))
    }
}

/// Longest side on which places have 16 bits behind the point and fit into 32, px.
const LONGEST: usize = 1 << 15;

impl Plane<u8> {
    /// Means of `k` × `k` pixels; what does not fill a block at the right and lower border is left out.
    pub fn reduced(&self, k: usize) -> Self {
        let (width, height) = (self.width / k, self.height / k);
        let mut plane = Self::filled(width, height, 0);
        let area = (k * k) as u32;
        let mut columns = vec![0u32; width * k];
        for y in 0..height {
            // column by column first, many at once
            columns.fill(0);
            for row in (y * k..(y + 1) * k).map(|y| self.row(y)) {
                columns.iter_mut().zip(row).for_each(|(sum, &v)| *sum += u32::from(v));
            }
            let sums = columns.chunks_exact(k).map(|block| block.iter().sum::<u32>());
            plane.row_mut(y).iter_mut().zip(sums).for_each(|(v, sum)| *v = ((sum + area / 2) / area) as u8);
        }
        plane
    }

    /// Four pixels for each, on the cubics through the pixels' centres (Catmull and Rom, "A class of local interpolating splines", 1974).
    pub fn doubled(&self) -> Self {
        self.doubled_across().transposed().doubled_across().transposed()
    }

    fn doubled_across(&self) -> Self {
        // a quarter of a pixel beside the second of four centres, in 128ths
        const QUARTER: [i32; 4] = [-9, 111, 29, -3];
        let mut out = Self::filled(2 * self.width, self.height, 0);
        let last = self.width - 1;
        for y in 0..self.height {
            let row = self.row(y);
            let at = |x: usize, by: isize| i32::from(row[x.saturating_add_signed(by).min(last)]);
            let mixed = |x: usize, way: isize| {
                let sum: i32 = QUARTER.iter().zip(-1..).map(|(weight, by)| weight * at(x, way * by)).sum();
                ((sum + 64) >> 7).clamp(0, 255) as u8
            };
            for (x, two) in out.row_mut(y).chunks_exact_mut(2).enumerate() {
                two.copy_from_slice(&[mixed(x, -1), mixed(x, 1)]);
            }
        }
        out
    }

    /// Between the four nearest pixels' centres, bilinear; the border's values go on outside.
    #[inline]
    pub fn at(&self, p: Point) -> f64 {
        let along = |v: f64, n: usize| {
            let v = (v - 0.5).clamp(0.0, (n - 1) as f64);
            let low = (v as usize).min(n.saturating_sub(2));
            (low, (low + 1).min(n - 1), v - low as f64)
        };
        let ((x0, x1, fx), (y0, y1, fy)) = (along(p.x, self.width), along(p.y, self.height));
        let row = |y: usize| {
            let row = self.row(y);
            f64::from(row[x0]) * (1.0 - fx) + f64::from(row[x1]) * fx
        };
        row(y0) * (1.0 - fy) + row(y1) * fy
    }

    /// The mean of [`Self::at`] over some places; 0 of none.
    pub fn mean_at(&self, places: impl Iterator<Item = Point>) -> f64 {
        let (sum, count) = places.fold((0.0, 0.0), |(sum, count), p| (sum + self.at(p), count + 1.0));
        sum / f64::max(count, 1.0)
    }

    /// Values at equal steps from a place on, as [`Self::at`] gives them but for its last digits.
    #[inline]
    pub fn along(&self, from: Point, step: Vec2, values: &mut [f32]) {
        let Some(steps) = self.steps(from, step, values.len()) else {
            values.iter_mut().enumerate().for_each(|(k, v)| *v = self.at(from + step * k as f64) as f32);
            return;
        };
        for (value, (first, x, y)) in values.iter_mut().zip(steps) {
            // 8 bits are enough for the mixture
            let (fx, fy) = (x >> 8, y >> 8);
            let mix = |first: usize| match self.values.get(first..first + 2) {
                Some(&[a, b]) => i32::from(a) * 256 + (i32::from(b) - i32::from(a)) * fx,
                _ => 0,
            };
            let (above, below) = (mix(first), mix(first + self.width));
            *value = (above * 256 + (below - above) * fy) as f32 * (1.0 / 65536.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twice_as_closely_a_parabola_is_the_same_parabola() {
        let level = |x: f64, y: f64| 20.0 + 1.5 * (x - 9.0).powi(2) + 0.5 * (y - 7.0).powi(2) + 0.2 * x * y;
        let (width, height) = (18, 14);
        let values = (0..width * height)
            .map(|i| level((i % width) as f64 + 0.5, (i / width) as f64 + 0.5).round() as u8)
            .collect();
        let plane = Plane { width, height, values };
        let large = plane.doubled();
        assert_eq!((large.width, large.height), (2 * width, 2 * height));
        for (x, y) in (4..32).flat_map(|x| (4..24).map(move |y| (x, y))) {
            let off = f64::from(large.row(y)[x]) - level(0.5 * (x as f64 + 0.5), 0.5 * (y as f64 + 0.5));
            assert!(off.abs() < 1.6, "{off} at {x}, {y}");
        }
        let part = plane.part(3..9, 2..4);
        assert_eq!((part.width, part.height, part.row(1)), (6, 2, &plane.row(3)[3..9]));
    }

    #[test]
    fn the_first_pixels_centre_is_half_a_pixel_in() {
        let plane = Plane { width: 2, height: 2, values: vec![0u8, 100, 100, 200] };
        assert_eq!(plane.at(Point::new(0.5, 0.5)), 0.0);
        assert_eq!(plane.at(Point::new(1.0, 0.5)), 50.0);
        assert_eq!(plane.at(Point::new(1.0, 1.0)), 100.0);
        assert_eq!(plane.at(Point::new(9.0, 9.0)), 200.0);
    }

    #[test]
    fn values_along_a_line_are_those_at_its_places() {
        let values = (0..64 * 48).map(|i| (i * 37 % 251) as u8).collect();
        let plane = Plane { width: 64, height: 48, values };
        for (from, step) in
            [((5.2, 6.1), (1.3, 0.7)), ((60.0, 40.0), (-1.9, -1.2)), ((1.0, 47.0), (0.4, 0.3))]
        {
            let (from, step) = (Point::from(from), Vec2::from(step));
            let mut found = [0.0; 20];
            plane.along(from, step, &mut found);
            for (k, v) in found.into_iter().enumerate() {
                // 1/256 px of the steepest slope there is, either way
                assert!((f64::from(v) - plane.at(from + step * k as f64)).abs() < 2.0);
            }
        }
    }
}
