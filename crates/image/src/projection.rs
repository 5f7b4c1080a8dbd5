//! Perspective of a rectangle.

use tracelight_stroke::{Point, Vec2};

use crate::solve::linear;

/// From a rectangle to pixels: (0, 0) is its first corner, (width, 0) the second, (width, height) the third.
#[derive(Clone, Copy, Debug)]
pub struct Projection(pub [f64; 8]);

impl Projection {
    /// Of a rectangle of this width and height, with its corners in order; `None` where they span none.
    pub fn of((width, height): (f64, f64), corners: &[Point; 4]) -> Option<Self> {
        let mut rows = [[0.0; 9]; 8];
        let places = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
        for (k, &(x, y)) in places.iter().enumerate() {
            let Point { x: u, y: v } = corners[k];
            rows[2 * k] = [x, y, 1.0, 0.0, 0.0, 0.0, -u * x, -u * y, u];
            rows[2 * k + 1] = [0.0, 0.0, 0.0, x, y, 1.0, -v * x, -v * y, v];
        }
        linear(rows).map(Self)
    }

    /// Where a place of the rectangle is, px; `None` behind the camera.
    #[inline]
    pub fn at(&self, x: f64, y: f64) -> Option<Point> {
        self.with_slopes(x, y).map(|(at, _, _)| at)
    }

    /// Maps a position, and gives the steps of one unit across and one unit down there, px.
    #[inline]
    pub fn with_slopes(&self, x: f64, y: f64) -> Option<(Point, Vec2, Vec2)> {
        let [a, b, c, d, e, f, g, h] = self.0;
        let w = g * x + h * y + 1.0;
        if w < 1e-3 {
            return None;
        }
        let one = 1.0 / w;
        let (u, v) = ((a * x + b * y + c) * one, (d * x + e * y + f) * one);
        let across = Vec2::new((a - u * g) * one, (d - v * g) * one);
        let down = Vec2::new((b - u * h) * one, (e - v * h) * one);
        Some((Point::new(u, v), across, down))
    }
}
