use tracelight_aim::Camera;
use tracelight_stroke::{Affine, Point};

use super::config::CameraConfig;

/// Something flat on the wall: a picture, a sheet of paper.
#[derive(Clone)]
pub struct Poster {
    /// Levels of sizes that halve, from the picture as it is.
    levels: Vec<Level>,
    /// Its pixels from places on the target.
    pixel_from_target: Affine,
    /// Side of one of its pixels, m.
    pixel_m: f64,
}

impl std::fmt::Debug for Poster {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Level { width, height, .. } = self.levels[0];
        write!(f, "Poster({width} × {height} of {} m)", self.pixel_m)
    }
}

#[derive(Clone)]
struct Level {
    width: usize,
    height: usize,
    /// What it throws back of red, green and blue light.
    values: Vec<[f32; 3]>,
}

impl Poster {
    /// A picture of `width` pixels in a row, red, green and blue in levels as they are stored, whose pixels lie on the target so. `None`
    /// of a picture without pixels, or that is laid on a line.
    pub fn new(width: usize, rgb: &[[u8; 3]], target_from_pixel: Affine) -> Option<Self> {
        let height = rgb.len().checked_div(width)?;
        let area = target_from_pixel.determinant().abs();
        if height == 0 || width * height != rgb.len() || !(area > 0.0 && area.is_finite()) {
            return None;
        }
        // what is stored is light to the power of 1/2.2
        let linear: Vec<f32> = (0..256).map(|v| (v as f32 / 255.0).powf(2.2)).collect();
        let values = rgb.iter().map(|p| p.map(|v| linear[usize::from(v)])).collect();
        let mut levels = vec![Level { width, height, values }];
        while let Some(half) = levels.last().and_then(Level::half) {
            levels.push(half);
        }
        Some(Self { levels, pixel_from_target: target_from_pixel.inverse(), pixel_m: area.sqrt() })
    }

    /// What a place throws back, over about so many metres; `None` beside the poster.
    fn at(&self, place: Point, over_m: f64) -> Option<[f32; 3]> {
        let p = self.pixel_from_target * place;
        let Level { width, height, .. } = self.levels[0];
        if !((0.0..width as f64).contains(&p.x) && (0.0..height as f64).contains(&p.y)) {
            return None;
        }
        let number = (over_m / self.pixel_m).max(1.0).log2() as usize;
        let level = &self.levels[number.min(self.levels.len() - 1)];
        let (sx, sy) = (level.width as f64 / width as f64, level.height as f64 / height as f64);
        Some(level.between(p.x * sx - 0.5, p.y * sy - 0.5))
    }
}

impl Level {
    fn half(&self) -> Option<Self> {
        let (width, height) = (self.width / 2, self.height / 2);
        let mean = |i: usize| {
            let first = (i / width * 2) * self.width + i % width * 2;
            let four = [first, first + 1, first + self.width, first + self.width + 1].map(|k| self.values[k]);
            std::array::from_fn(|c| 0.25 * four.iter().map(|p| p[c]).sum::<f32>())
        };
        (width.min(height) >= 2).then(|| Self {
            width,
            height,
            values: (0..width * height).map(mean).collect(),
        })
    }

    fn between(&self, x: f64, y: f64) -> [f32; 3] {
        let along = |v: f64, n: usize| {
            let v = v.clamp(0.0, (n - 1) as f64);
            let low = (v as usize).min(n.saturating_sub(2));
            (low, (low + 1).min(n - 1), (v - low as f64) as f32)
        };
        let ((x0, x1, fx), (y0, y1, fy)) = (along(x, self.width), along(y, self.height));
        let at = |x: usize, y: usize| self.values[y * self.width + x];
        let (a, b, c, d) = (at(x0, y0), at(x1, y0), at(x0, y1), at(x1, y1));
        std::array::from_fn(|k| {
            let (upper, lower) = (a[k] + (b[k] - a[k]) * fx, c[k] + (d[k] - c[k]) * fx);
            upper + (lower - upper) * fy
        })
    }
}

/// A wall with posters on it.
#[derive(Clone, Debug)]
pub struct Wall {
    /// What it throws back of red, green and blue light.
    pub plain: [f32; 3],
    /// From the lowest to the uppermost.
    pub posters: Vec<Poster>,
}

/// Samples across a pixel, and as many down.
const ACROSS: usize = 4;

impl Wall {
    fn at(&self, place: Point, over_m: f64) -> [f32; 3] {
        self.posters.iter().rev().find_map(|poster| poster.at(place, over_m)).unwrap_or(self.plain)
    }

    /// What each pixel of a camera gets of it in a reference exposure; one is a pixel that is full.
    pub(super) fn seen(&self, config: &CameraConfig, camera: &Camera) -> Vec<[f32; 3]> {
        let [width, height] = camera.lens.size_px;
        let corner = |i: usize| {
            let (column, row) = (i % (width + 1), i / (width + 1));
            camera.target(Point::new(column as f64, row as f64))
        };
        let corners: Vec<Option<Point>> = (0..(width + 1) * (height + 1)).map(corner).collect();
        let mut seen = Vec::with_capacity(width * height);
        for i in 0..width * height {
            let first = i / width * (width + 1) + i % width;
            let about = [first, first + 1, first + width + 1, first + width + 2].map(|k| corners[k]);
            seen.push(self.pixel(about));
        }
        blur(&mut seen, width, height, config.blur_px);
        for (i, pixel) in seen.iter_mut().enumerate() {
            let at = Point::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
            let (light, lamp) = light_at(config, at, width as f64, height as f64);
            pixel.iter_mut().for_each(|v| *v = *v * light + lamp);
        }
        seen
    }

    /// The mean over a pixel of which the four corners lie on the wall so.
    fn pixel(&self, corners: [Option<Point>; 4]) -> [f32; 3] {
        let [Some(a), Some(b), Some(c), Some(d)] = corners else { return self.plain };
        let over_m = a.distance(d).max(b.distance(c)) / ACROSS as f64;
        let mut sum = [0.0; 3];
        for k in 0..ACROSS * ACROSS {
            let share = |k: usize| (k as f64 + 0.5) / ACROSS as f64;
            let (x, y) = (share(k % ACROSS), share(k / ACROSS));
            let found = self.at(a.lerp(b, x).lerp(c.lerp(d, x), y), over_m);
            sum.iter_mut().zip(found).for_each(|(s, v)| *s += v);
        }
        sum.map(|s| s / (ACROSS * ACROSS) as f32)
    }
}

/// How much of the full light there is at a pixel, and what the lamp adds.
fn light_at(config: &CameraConfig, at: Point, width: f64, height: f64) -> (f32, f32) {
    let [left, right] = config.light;
    let side = left + (right - left) * at.x / width;
    let centre = Point::new(width / 2.0, height / 2.0);
    let corner = at.distance(centre) / centre.to_vec2().hypot();
    let lamp = config.lamp.map_or(0.0, |lamp| {
        let off = at.distance(lamp.at) / lamp.size_px;
        lamp.brightness * (-0.5 * off * off).exp()
    });
    ((side * (1.0 - config.vignetting * corner * corner)) as f32, lamp as f32)
}

/// Gaussian blur, a row and a column at a time.
fn blur(image: &mut [[f32; 3]], width: usize, height: usize, deviation_px: f64) {
    if deviation_px <= 0.0 {
        return;
    }
    let reach = (4.0 * deviation_px).ceil() as isize;
    let weight = |k: isize| (-0.5 * (k as f64 / deviation_px).powi(2)).exp() as f32;
    let total: f32 = (-reach..=reach).map(weight).sum();
    let kernel: Vec<f32> = (-reach..=reach).map(|k| weight(k) / total).collect();
    let pass =
        |from: &[[f32; 3]], step: isize, last: isize, place: &dyn Fn(usize) -> isize| -> Vec<[f32; 3]> {
            let of = |i: usize| {
                let at = place(i);
                let mut sum = [0.0; 3];
                for (k, weight) in (-reach..=reach).zip(&kernel) {
                    let other = (at + k).clamp(0, last) - at;
                    let value = from[(i as isize + other * step) as usize];
                    sum.iter_mut().zip(value).for_each(|(s, v)| *s += weight * v);
                }
                sum
            };
            (0..from.len()).map(of).collect()
        };
    let across = pass(image, 1, width as isize - 1, &|i| (i % width) as isize);
    let both = pass(&across, width as isize, height as isize - 1, &|i| (i / width) as isize);
    image.copy_from_slice(&both);
}
