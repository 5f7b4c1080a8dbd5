use tracelight_aim::Camera;
use tracelight_maths::{exp, log2, powi, single};
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
        let linear: Vec<f32> = (0..256).map(|v| single::powf(v as f32 / 255.0, 2.2)).collect();
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
        let number = log2((over_m / self.pixel_m).max(1.0)) as usize;
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

/// Parts of a pixel, across and down: the lens blurs them before the pixel takes their mean. Blurred after, a sharp edge within a pixel
/// would look askew, and be found up to 0.02 px nearer to the pixel's border than it is.
const PARTS: usize = 2;
/// Samples across a part, and as many down.
const ACROSS: usize = 2;

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
        let mut parts = Light::dark(PARTS * width, PARTS * height);
        for i in 0..width * height {
            let (column, row) = (i % width, i / width);
            let first = row * (width + 1) + column;
            let about = [first, first + 1, first + width + 1, first + width + 2].map(|k| corners[k]);
            for k in 0..PARTS * PARTS {
                let (right, down) = (k % PARTS, k / PARTS);
                let at = (PARTS * row + down) * PARTS * width + PARTS * column + right;
                parts.values[at] = self.part(about, [right, down]);
            }
        }
        let mut seen = parts.through_lens(config.blur_px).values;
        for (i, pixel) in seen.iter_mut().enumerate() {
            let at = Point::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
            let (light, lamp) = light_at(config, at, width as f64, height as f64);
            pixel.iter_mut().for_each(|v| *v = *v * light + lamp);
        }
        seen
    }

    /// The mean over a part of a pixel of which the four corners lie on the wall so.
    fn part(&self, corners: [Option<Point>; 4], part: [usize; 2]) -> [f32; 3] {
        let [Some(a), Some(b), Some(c), Some(d)] = corners else { return self.plain };
        let over_m = a.distance(d).max(b.distance(c)) / (PARTS * ACROSS) as f64;
        let mut sum = [0.0; 3];
        for k in 0..ACROSS * ACROSS {
            let share = |part: usize, k: usize| ((ACROSS * part + k) as f64 + 0.5) / (PARTS * ACROSS) as f64;
            let (x, y) = (share(part[0], k % ACROSS), share(part[1], k / ACROSS));
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
        lamp.brightness * exp(-0.5 * off * off)
    });
    ((side * (1.0 - config.vignetting * corner * corner)) as f32, lamp as f32)
}

/// Red, green and blue light on a grid, row by row.
struct Light {
    width: usize,
    height: usize,
    values: Vec<[f32; 3]>,
}

impl Light {
    fn dark(width: usize, height: usize) -> Self {
        Self { width, height, values: vec![[0.0; 3]; width * height] }
    }

    /// Of pixels, from their parts: blurred by a bell, and the mean of each pixel's, a row and a column at a time.
    fn through_lens(&self, deviation_px: f64) -> Self {
        let weights = weights(deviation_px);
        let mut across = Self::dark(self.width / PARTS, self.height);
        for i in 0..across.values.len() {
            let (x, row) = (i % across.width, &self.values[i / across.width * self.width..][..self.width]);
            for (k, weight) in weights.iter().enumerate() {
                add(&mut across.values[i], row[beside(x, k, &weights, self.width)], *weight);
            }
        }
        let mut both = Self::dark(across.width, self.height / PARTS);
        for (y, row) in both.values.chunks_exact_mut(across.width).enumerate() {
            for (k, weight) in weights.iter().enumerate() {
                let other = &across.values[beside(y, k, &weights, self.height) * across.width..];
                row.iter_mut().zip(other).for_each(|(sum, value)| add(sum, *value, *weight));
            }
        }
        both
    }
}

fn add(sum: &mut [f32; 3], value: [f32; 3], weight: f32) {
    sum.iter_mut().zip(value).for_each(|(s, v)| *s += weight * v);
}

/// How much a pixel gets of each part about it: of as many before its first as behind its last.
fn weights(deviation_px: f64) -> Vec<f32> {
    let deviation = PARTS as f64 * deviation_px;
    let reach = (4.0 * deviation).ceil() as isize;
    let bell = |k: isize| if k == 0 { 1.0 } else { exp(-0.5 * powi(k as f64 / deviation, 2)) };
    let total: f64 = (-reach..=reach).map(bell).sum();
    let last = PARTS as isize - 1;
    let weight = |k: isize| {
        let of_parts = (0..=last).filter(|part| (k - part).abs() <= reach).map(|part| bell(k - part));
        (of_parts.sum::<f64>() / (total * PARTS as f64)) as f32
    };
    (-reach..=last + reach).map(weight).collect()
}

/// Which part of a row or column a pixel's weight `k` is for; the outermost go on outside.
fn beside(pixel: usize, k: usize, weights: &[f32], count: usize) -> usize {
    let before = (weights.len() - PARTS) / 2;
    (PARTS * pixel + k).saturating_sub(before).min(count - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_aim::{CameraPose, Lens};
    use tracelight_stroke::Vec2;

    #[test]
    fn a_sharp_edge_looks_even_wherever_in_a_pixel_it_lies() {
        let lens = Lens::ideal(64, 16, 100.0);
        let camera = Camera { lens, pose: CameraPose::looking_at([0.0, 0.0, 1.0], [0.0; 3]).unwrap() };
        let usual = CameraConfig::webcam();
        let config = CameraConfig { vignetting: 0.0, light: [1.0, 1.0], ..usual };
        for k in 0..16 {
            // white from there on; a pixel is 10 mm
            let edge = 32.0 + f64::from(k) / 16.0;
            let left = camera.target(Point::new(edge, 8.0)).unwrap();
            let place = Affine::scale(1e-3).then_translate(left.to_vec2() - Vec2::new(0.0, 0.5));
            let white = Poster::new(1000, &[[255; 3]; 1_000_000], place).unwrap();
            let seen = Wall { plain: [0.0; 3], posters: vec![white] }.seen(&config, &camera);
            let row = &seen[8 * 64..][22..44];
            let steps = row.windows(2).zip(23..).map(|(v, x)| (f64::from(v[1][0] - v[0][0]), f64::from(x)));
            let moment = |power: i32, about: f64| -> f64 {
                steps.clone().map(|(step, x)| step * (x - about).powi(power)).sum()
            };
            let mean = moment(1, 0.0);
            // four samples a pixel tell places of so sharp an edge to an eighth
            assert!((moment(0, 0.0) - 1.0).abs() < 1e-3 && (mean - edge).abs() < 0.13, "{edge}: {mean}");
            // if pixels were blurred after they had taken their mean: up to 0.096
            assert!(moment(3, mean).abs() < 0.02, "{edge}: {}", moment(3, mean));
        }
    }
}
