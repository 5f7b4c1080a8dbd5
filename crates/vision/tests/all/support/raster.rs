//! A rasterizer that counts samples: 8 × 8 in every pixel, so that a pixel's level is the share of it that is
//! inked, to 1/64.

use tracelight_stroke::Point;

/// Samples along either side of a pixel.
const SIDE: usize = 8;

/// Ink on a grid of samples; one word holds those of one pixel.
pub(crate) struct Canvas {
    width: usize,
    height: usize,
    samples: Vec<u64>,
}

impl Canvas {
    /// Without ink.
    pub(crate) fn new(width: usize, height: usize) -> Self {
        Self { width, height, samples: vec![0; width * height] }
    }

    /// Inks everything within half a pen's width of a polyline: round ends and corners.
    pub(crate) fn pen(&mut self, points: &[Point], width: f64) {
        for pair in points.windows(2) {
            self.segment(pair[0], pair[1], 0.5 * width);
        }
    }

    fn segment(&mut self, a: Point, b: Point, radius: f64) {
        let along = b - a;
        let length2 = along.hypot2().max(1e-300);
        let near = |p: Point| {
            let share = ((p - a).dot(along) / length2).clamp(0.0, 1.0);
            (p - (a + along * share)).hypot2() <= radius * radius
        };
        let range = |low: f64, high: f64, most: usize| {
            (low - radius).floor().max(0.0) as usize..((high + radius).ceil().max(0.0) as usize).min(most)
        };
        for y in range(a.y.min(b.y), a.y.max(b.y), self.height) {
            for x in range(a.x.min(b.x), a.x.max(b.x), self.width) {
                let word = &mut self.samples[y * self.width + x];
                (0..64).filter(|&k| near(sample(x, y, k))).for_each(|k| *word |= 1 << k);
            }
        }
    }

    /// Inks what closed polylines enclose (even-odd).
    pub(crate) fn fill(&mut self, rings: &[Vec<Point>]) {
        for row in 0..self.height * SIDE {
            let y = (row as f64 + 0.5) / SIDE as f64;
            let mut crossings: Vec<f64> = rings.iter().flat_map(|ring| crossings(ring, y)).collect();
            crossings.sort_by(f64::total_cmp);
            for span in crossings.chunks_exact(2) {
                let column =
                    |x: f64| (x * SIDE as f64 - 0.5).ceil().clamp(0.0, (self.width * SIDE) as f64) as usize;
                for c in column(span[0])..column(span[1]) {
                    let bit = row % SIDE * SIDE + c % SIDE;
                    self.samples[row / SIDE * self.width + c / SIDE] |= 1 << bit;
                }
            }
        }
    }

    /// The inked share of each pixel, row by row.
    pub(crate) fn shares(&self) -> impl Iterator<Item = f64> + '_ {
        self.samples.iter().map(|w| f64::from(w.count_ones()) / 64.0)
    }
}

/// Place of sample `k` of a pixel.
fn sample(x: usize, y: usize, k: usize) -> Point {
    let at = |pixel: usize, k: usize| pixel as f64 + (k as f64 + 0.5) / SIDE as f64;
    Point::new(at(x, k % SIDE), at(y, k / SIDE))
}

/// Where a ring crosses the horizontal at `y`.
fn crossings(ring: &[Point], y: f64) -> impl Iterator<Item = f64> + '_ {
    let next = ring.iter().skip(1).chain(ring.first());
    let edges = ring.iter().zip(next).filter(move |(a, b)| (a.y <= y) != (b.y <= y));
    edges.map(move |(a, b)| a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x))
}
