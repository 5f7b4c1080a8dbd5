//! Pictures of one marker, drawn with what is true of it known.

use tracelight_image::Grey;
use tracelight_stroke::{Point, Vec2};

use crate::fiducial::square::Square;
use crate::fiducial::tag_cells;

/// Parts of a pixel's side that are drawn.
const FINE: usize = 5;

/// How a marker on a white page on a wall is seen, in even light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scene {
    /// Side of the image, px.
    pub(super) size: usize,
    /// White about the marker, cells.
    pub(super) white_cells: f64,
    /// Light of black, of white, and of the wall about the page.
    pub(super) light: [f64; 3],
    /// Side of the black squares that touch the marker's corners, cells.
    pub(super) touching_cells: f64,
    /// Standard deviation of the blur, px.
    pub(super) blur_px: f64,
    /// How much of what a level differs by from those about it the camera adds to it.
    pub(super) sharpened: f64,
    /// Standard deviation of the noise, levels.
    pub(super) noise: f64,
}

impl Scene {
    pub(super) const PLAIN: Self = Self {
        size: 120,
        white_cells: 1.5,
        light: [0.03, 0.8, 0.4],
        touching_cells: 0.0,
        blur_px: 0.8,
        sharpened: 0.0,
        noise: 2.0,
    };

    /// The marker with that id and these corners.
    pub(super) fn picture(&self, id: u16, corners: &[Point; 4], seed: u64) -> Grey {
        let fine = self.size * FINE;
        let sharp: Vec<f64> = {
            let square = Square::of(corners).unwrap();
            let cells = tag_cells(id).unwrap();
            let place = |k: usize| (k as f64 + 0.5) / FINE as f64;
            let at = |i: usize| on_marker(&square, Point::new(place(i % fine), place(i / fine)));
            (0..fine * fine).map(|i| self.light_at(&cells, at(i))).collect()
        };
        let blurred = blurred(&blurred(&sharp, 1, self.blur_px), fine, self.blur_px);
        let level = |i: usize| {
            let (x, y) = (i % self.size * FINE, i / self.size * FINE);
            let sum: f64 = (0..FINE * FINE).map(|k| blurred[(y + k / FINE) * fine + x + k % FINE]).sum();
            (sum / (FINE * FINE) as f64).powf(1.0 / 2.2) * 255.0
        };
        let levels: Vec<f64> = (0..self.size * self.size).map(level).collect();
        let mut dice = oorandom::Rand64::new(u128::from(seed));
        let mut noisy = |v: f64| {
            let sum: f64 = (0..12).map(|_| dice.rand_float()).sum();
            (v + self.noise * (sum - 6.0)).round().clamp(0.0, 255.0) as u8
        };
        let levels = (0..levels.len()).map(|i| noisy(self.as_sharpened(&levels, i))).collect();
        Grey::new(self.size, self.size, levels).unwrap()
    }

    fn light_at(&self, black: &[[bool; 8]; 8], at: Option<Point>) -> f64 {
        let [ink, white, wall] = self.light;
        let Some(at) = at else { return wall };
        let inside = |v: f64| (0.0..8.0).contains(&v);
        // how far it is from the marker, across and down
        let beside = |v: f64| (v - 8.0).max(-v).max(0.0);
        let (x, y) = (beside(at.x), beside(at.y));
        let touches = |v: f64| v > 0.0 && v <= self.touching_cells;
        match inside(at.x) && inside(at.y) {
            true if black[at.y as usize][at.x as usize] => ink,
            true => white,
            false if touches(x) && touches(y) => ink,
            false if x.max(y) < self.white_cells => white,
            false => wall,
        }
    }

    /// A level as the camera stores it.
    fn as_sharpened(&self, levels: &[f64], i: usize) -> f64 {
        let (x, y) = ((i % self.size) as isize, (i / self.size) as isize);
        let at = |x: isize, y: isize| {
            let inside = |v: isize| v.clamp(0, self.size as isize - 1) as usize;
            levels[inside(y) * self.size + inside(x)]
        };
        let weight = |d: isize| if d == 0 { 0.5 } else { 0.25 };
        let about: f64 = (-1..=1)
            .flat_map(|dy| (-1..=1).map(move |dx| (dx, dy)))
            .map(|(dx, dy)| weight(dx) * weight(dy) * at(x + dx, y + dy))
            .sum();
        levels[i] + self.sharpened * (levels[i] - about)
    }
}

/// Where a pixel is on the marker: by Newton's method.
fn on_marker(square: &Square, p: Point) -> Option<Point> {
    let mut at = Point::new(4.0, 4.0);
    for _ in 0..20 {
        let (seen, across, down) = square.with_slopes(at.x, at.y)?;
        let (off, det) = (p - seen, across.cross(down));
        at += Vec2::new(off.cross(down) / det, across.cross(off) / det);
    }
    Some(at)
}

/// Along numbers that are `step` apart.
fn blurred(from: &[f64], step: usize, blur_px: f64) -> Vec<f64> {
    let reach = (3.0 * blur_px * FINE as f64) as isize;
    let weights: Vec<f64> =
        (-reach..=reach).map(|d| (-0.5 * (d as f64 / (blur_px * FINE as f64)).powi(2)).exp()).collect();
    let total: f64 = weights.iter().sum();
    let last = from.len() as isize - 1;
    let sum = |i: isize| {
        let at = |d: isize| from[(i + d * step as isize).clamp(0, last) as usize];
        weights.iter().zip(-reach..).map(|(weight, d)| weight * at(d)).sum::<f64>()
    };
    (0..from.len()).map(|i| sum(i as isize) / total).collect()
}

/// A picture of one marker on a white page on a grey wall: blurred, with noise.
pub(super) fn picture(id: u16, corners: &[Point; 4], blur_px: f64, noise: f64, seed: u64) -> Grey {
    Scene { blur_px, noise, ..Scene::PLAIN }.picture(id, corners, seed)
}

/// Renders an image as a single-chip colour sensor with nearest-neighbour interpolation shows it, in video brightness. Levels are gamma-coded
/// (1/2.2); the interpolation is linear in light.
pub(super) fn through_mosaic(image: &Grey) -> Grey {
    let (width, height) = (image.width(), image.height());
    let light = |x: isize, y: isize| {
        let beyond = |v: isize, n: usize| if v < 0 { 1 } else { (v as usize).min(n - 1) };
        (f64::from(image.levels()[beyond(y, height) * width + beyond(x, width)]) / 255.0).powf(2.2)
    };
    let brightness = |i: usize| {
        let (x, y) = ((i % width) as isize, (i / width) as isize);
        let mean = |places: &[(isize, isize)]| {
            places.iter().map(|(dx, dy)| light(x + dx, y + dy)).sum::<f64>() / places.len() as f64
        };
        let (own, beside, upright) = (light(x, y), mean(&[(-1, 0), (1, 0)]), mean(&[(0, -1), (0, 1)]));
        let corners = mean(&[(-1, -1), (1, -1), (-1, 1), (1, 1)]);
        let [red, green, blue] = match (x % 2, y % 2) {
            (0, 0) => [own, 0.5 * (beside + upright), corners],
            (1, 1) => [corners, 0.5 * (beside + upright), own],
            (1, 0) => [beside, own, upright],
            _ => [upright, own, beside],
        }
        .map(|v| 255.0 * v.powf(1.0 / 2.2));
        (0.299 * red + 0.587 * green + 0.114 * blue).round() as u8
    };
    Grey::new(width, height, (0..width * height).map(brightness).collect()).unwrap()
}
