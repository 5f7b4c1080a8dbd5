use tracelight_stroke::{Drawing, Path, Point, StrokeKind};

use super::{TOLERANCE_PX, pen};

/// Scan lines a pixel when a shape is filled. Along each the coverage is exact; across them a level edge comes out at
/// most 1/32 px from where it is.
const LINES: usize = 16;

/// Which share of every pixel is inked, row by row from the top left.
pub(crate) struct Canvas {
    pub(crate) size: [usize; 2],
    pub(crate) coverage: Vec<f64>,
}

impl Canvas {
    pub(crate) fn new(size: [usize; 2]) -> Self {
        Self { size, coverage: vec![0.0; size[0] * size[1]] }
    }

    /// A drawing in ink: centrelines with their pen, all outlines together filled by the even-odd rule.
    pub(crate) fn inked(size: [usize; 2], drawing: &Drawing) -> Self {
        let mut canvas = Self::new(size);
        let (outlines, lines): (Vec<_>, Vec<_>) =
            drawing.strokes.iter().partition(|s| s.kind == StrokeKind::Outline);
        canvas.fill(&outlines.iter().map(|s| &s.path).collect::<Vec<_>>());
        for stroke in lines {
            pen::draw(&mut canvas, &stroke.path, stroke.pen.unwrap_or(1.0));
        }
        canvas
    }

    /// Calls `of` with the centre of every pixel of a box and keeps the larger coverage.
    pub(crate) fn cover(&mut self, from: Point, to: Point, of: impl Fn(Point) -> f64) {
        let [width, height] = self.size;
        let columns = from.x.floor().max(0.0) as usize..(to.x.ceil().max(0.0) as usize).min(width);
        for v in from.y.floor().max(0.0) as usize..(to.y.ceil().max(0.0) as usize).min(height) {
            for u in columns.clone() {
                let here = &mut self.coverage[v * width + u];
                *here = here.max(of(Point::new(u as f64 + 0.5, v as f64 + 0.5)).min(1.0));
            }
        }
    }

    /// Fills the inside of closed paths, even-odd.
    pub(crate) fn fill(&mut self, outlines: &[&Path]) {
        let rings: Vec<_> = outlines.iter().map(|path| path.flatten(TOLERANCE_PX)).collect();
        for line in 0..self.size[1] * LINES {
            let v = (line as f64 + 0.5) / LINES as f64;
            for span in crossings(&rings, v).chunks_exact(2) {
                self.fill_span(line / LINES, span[0], span[1]);
            }
        }
    }

    /// Adds one scan line's share of what lies between two abscissae.
    fn fill_span(&mut self, row: usize, from: f64, to: f64) {
        let width = self.size[0];
        let columns = from.floor().max(0.0) as usize..(to.ceil().max(0.0) as usize).min(width);
        for u in columns {
            let inside = to.min(u as f64 + 1.0) - from.max(u as f64);
            self.coverage[row * width + u] += inside.max(0.0) / LINES as f64;
        }
    }
}

/// Where the rings cross a horizontal line, from left to right.
fn crossings(rings: &[Vec<Point>], v: f64) -> Vec<f64> {
    let edges = rings.iter().flat_map(|ring| ring.windows(2));
    let mut at: Vec<_> = edges
        .filter(|e| (e[0].y <= v) != (e[1].y <= v))
        .map(|e| e[0].x + (e[1].x - e[0].x) * (v - e[0].y) / (e[1].y - e[0].y))
        .collect();
    at.sort_by(f64::total_cmp);
    at
}
