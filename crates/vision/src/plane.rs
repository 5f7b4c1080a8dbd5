use tracelight_stroke::Point;

/// Values on a grid of pixels, row by row from the top left.
#[derive(Clone)]
pub(crate) struct Plane<T> {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) values: Vec<T>,
}

/// Its size; a picture's worth of numbers helps nobody.
impl<T> std::fmt::Debug for Plane<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Plane({} × {})", self.width, self.height)
    }
}

impl<T: Copy + Default> Plane<T> {
    pub(crate) fn filled(width: usize, height: usize, value: T) -> Self {
        Self { width, height, values: vec![value; width * height] }
    }

    pub(crate) fn row(&self, y: usize) -> &[T] {
        &self.values[y * self.width..][..self.width]
    }

    pub(crate) fn row_mut(&mut self, y: usize) -> &mut [T] {
        &mut self.values[y * self.width..][..self.width]
    }

    /// The value at a pixel; the default outside.
    pub(crate) fn get(&self, x: isize, y: isize) -> T {
        match (usize::try_from(x), usize::try_from(y)) {
            (Ok(x), Ok(y)) if x < self.width && y < self.height => self.values[y * self.width + x],
            _ => T::default(),
        }
    }

    /// The nearest place within the image.
    pub(crate) fn clamp(&self, p: Point) -> Point {
        Point::new(p.x.clamp(0.0, self.width as f64), p.y.clamp(0.0, self.height as f64))
    }

    /// Centre of the pixel with this index.
    pub(crate) fn centre(&self, index: usize) -> Point {
        Point::new((index % self.width) as f64 + 0.5, (index / self.width) as f64 + 0.5)
    }
}

impl Plane<u8> {
    /// Between the four nearest pixels' centres, bilinear; the border's values go on outside.
    pub(crate) fn at(&self, p: Point) -> f64 {
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
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_pixels_centre_is_half_a_pixel_in() {
        let plane = Plane { width: 2, height: 2, values: vec![0u8, 100, 100, 200] };
        assert_eq!(plane.at(Point::new(0.5, 0.5)), 0.0);
        assert_eq!(plane.at(Point::new(1.0, 0.5)), 50.0);
        assert_eq!(plane.at(Point::new(1.0, 1.0)), 100.0);
        assert_eq!(plane.at(Point::new(9.0, 9.0)), 200.0);
        assert_eq!(plane.centre(3), Point::new(1.5, 1.5));
    }
}
