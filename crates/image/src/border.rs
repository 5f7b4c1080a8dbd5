//! The border of a region of ink, edge by edge, and what it encloses.

use tracelight_stroke::Point;

use crate::mask::Mask;

/// Directions along pixel edges, clockwise from right: (x, y) steps.
const STEPS: [(isize, isize); 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

/// An edge between an ink pixel and a paper pixel.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    /// Column and row of the ink pixel.
    pub ink: (isize, isize),
    /// Column and row of the paper pixel; it may lie beyond the mask.
    pub paper: (isize, isize),
}

impl Edge {
    /// Between its two pixels.
    #[inline]
    pub fn middle(&self) -> Point {
        let between = |ink: isize, paper: isize| (ink + paper) as f64 / 2.0 + 0.5;
        Point::new(between(self.ink.0, self.paper.0), between(self.ink.1, self.paper.1))
    }
}

/// The edges of a border in order, ink on the right, from the left edge of ink pixel (x, y) upwards until there
/// again (crack following: Rosenfeld, "Connectivity in digital pictures", 1970). Ink joined at corners stays joined.
pub fn border(mask: &Mask, x: isize, y: isize, walked: &mut Mask) -> Vec<Edge> {
    const UP: usize = 3;
    let ink = |p: (isize, isize)| mask.get(p.0, p.1);
    let start = ((x, y), UP);
    let (mut pixel, mut direction) = start;
    let mut edges = Vec::new();
    loop {
        let (ahead, left) = (STEPS[direction], STEPS[(direction + 3) % 4]);
        let paper = (pixel.0 + left.0, pixel.1 + left.1);
        edges.push(Edge { ink: pixel, paper });
        if direction == UP {
            walked.set(mask.cell(pixel.0 as usize, pixel.1 as usize));
        }
        let beyond = (paper.0 + ahead.0, paper.1 + ahead.1);
        let before = (pixel.0 + ahead.0, pixel.1 + ahead.1);
        (pixel, direction) = if ink(beyond) {
            (beyond, (direction + 3) % 4)
        } else if ink(before) {
            (before, direction)
        } else {
            (pixel, (direction + 1) % 4)
        };
        if (pixel, direction) == start {
            return edges;
        }
    }
}

/// Signed area of a polygon: positive if it is clockwise as seen.
pub fn area(points: &[Point]) -> f64 {
    let next = points.iter().skip(1).chain(points.first());
    0.5 * points.iter().zip(next).map(|(a, b)| a.to_vec2().cross(b.to_vec2())).sum::<f64>()
}
