//! The light of the part of an image that a marker is in.

use tracelight_image::Plane;
use tracelight_stroke::{Point, Vec2};

use super::square::SIDE;
use crate::light::{Border, light_of_levels, smooth};

/// How far off a boundary can be placed, px.
pub(super) const FURTHEST_PX: f64 = 1.5;

/// How closely a marker is looked at.
#[derive(Clone, Copy)]
pub(super) struct Closeness {
    /// How many times its light is smoothed. What a sensor of one colour a pixel fills in goes away by it, which is different from pixel to
    /// pixel, and what is left bends so little from pixel to pixel that a straight line between them is true.
    smoothings: usize,
    /// Furthest sample across a boundary, px.
    pub(super) reach_px: f64,
}

impl Closeness {
    /// Of a marker by the side of its smallest cells, px. The smallest have no sharpness to spare: with all smoothed once, corners of eighty
    /// markers down to 19 px a side are found to 0.055 px, with none 0.053, so 0.048. Large ones have room for more: looked at as those of
    /// middle size are, four pages of four put the wall 0.039 mm off, so 0.026.
    const fn for_cells(side_px: f64) -> Self {
        let (smoothings, reach_px) = match side_px {
            ..3.0 => (0, 2.5),
            ..6.0 => (1, 2.5),
            _ => (2, MOST_REACH_PX),
        };
        Self { smoothings, reach_px }
    }

    pub(super) fn of(corners: &[Point; 4]) -> Self {
        let sides = (0..4).map(|k| corners[k].distance(corners[(k + 1) % 4]));
        Self::for_cells(sides.fold(f64::MAX, f64::min) / SIDE as f64)
    }
}

const MOST_REACH_PX: f64 = 3.5;

/// The light of a part of an image.
pub(super) struct Part {
    /// Its upper left, px.
    corner: Vec2,
    light: Plane<f32>,
}

impl Part {
    /// About a square and what is looked at beside it.
    pub(super) fn about(plane: &Plane<u8>, corners: &[Point; 4], closeness: Closeness) -> Self {
        const MARGIN: f64 = 2.0 * FURTHEST_PX + MOST_REACH_PX + 2.0;
        let range = |of: fn(&Point) -> f64, size: usize| {
            let least = corners.iter().map(of).fold(f64::MAX, f64::min) - MARGIN;
            let most = corners.iter().map(of).fold(f64::MIN, f64::max) + MARGIN;
            let place = |v: f64| v.clamp(0.0, size as f64) as usize;
            (place(least), place(most.ceil()))
        };
        let ((left, right), (top, bottom)) = (range(|p| p.x, plane.width), range(|p| p.y, plane.height));
        let light = light_of_levels();
        let mut values = Vec::with_capacity((right - left) * (bottom - top));
        for y in top..bottom {
            values.extend(plane.row(y)[left..right].iter().map(|&v| light[usize::from(v)]));
        }
        let mut light = Plane { width: right - left, height: bottom - top, values };
        (0..closeness.smoothings).for_each(|_| smooth(&mut light, Border::Stays));
        let corner = Vec2::new(left as f64, top as f64);
        Self { corner, light }
    }

    /// Light at equal steps from a place on, bilinear; `None` where a step leads out of the part.
    pub(super) fn along(&self, from: Point, step: Vec2, light: &mut [f32]) -> Option<()> {
        let steps = self.light.steps(from - self.corner, step, light.len())?;
        let share = |v: i32| v as f32 * (1.0 / 65536.0);
        for (v, (first, x, y)) in light.iter_mut().zip(steps) {
            let mix = |first: usize| match self.light.values.get(first..first + 2) {
                Some(&[a, b]) => a + (b - a) * share(x),
                _ => 0.0,
            };
            let (above, below) = (mix(first), mix(first + self.light.width));
            *v = above + (below - above) * share(y);
        }
        Some(())
    }
}
