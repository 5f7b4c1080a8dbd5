//! Pen lines in pixels: which share of each pixel is inked.

use tracelight_stroke::Point;

/// A rectangle of pixels, and how much of each is ink, 0 to 1, row by row from the upper left.
pub(super) struct Ink {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) coverage: Vec<f64>,
}

impl Ink {
    /// No ink yet.
    pub(super) fn none(width: usize, height: usize) -> Self {
        Self { width, height, coverage: vec![0.0; width * height] }
    }

    /// Draws a polyline with round ends and joins. Points and pen in pixels.
    pub(super) fn draw(&mut self, line: &[Point], pen_px: f64) {
        for side in line.windows(2) {
            self.side(side[0], side[1], pen_px / 2.0);
        }
    }

    fn side(&mut self, a: Point, b: Point, half: f64) {
        let along = b - a;
        let reach = half + 1.0;
        let cells = |low: f64, high: f64, count: usize| {
            ((low - reach).max(0.0) as usize)..((high + reach).max(0.0) as usize + 1).min(count)
        };
        for y in cells(a.y.min(b.y), a.y.max(b.y), self.height) {
            for x in cells(a.x.min(b.x), a.x.max(b.x), self.width) {
                let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
                let share = ((p - a).dot(along) / along.hypot2().max(1e-12)).clamp(0.0, 1.0);
                let inked = (half - p.distance(a + along * share) + 0.5).clamp(0.0, 1.0);
                let here = &mut self.coverage[y * self.width + x];
                *here = here.max(inked);
            }
        }
    }
}
