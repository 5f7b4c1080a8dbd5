use std::sync::Arc;

use tracelight_maths::{erfc, exp, ln, powf};

use super::config::Sensor;
use super::part::Part;
use super::splitmix::{GOLDEN, mixed};

/// Noise, drawn from a seed.
#[derive(Clone, Debug)]
pub(super) struct Electrons {
    seed: u64,
    /// Normally distributed: quantiles at equal steps of probability.
    normal: Arc<[f32]>,
    /// Levels at equal steps of light.
    curve: Arc<[u8]>,
}

/// Which pixels of which image are read.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mosaic {
    /// Width and height of the image.
    pub(super) size: [usize; 2],
    /// What light is there of: a pixel more around what is wanted, whose colours lean on it.
    pub(super) wide: Part,
    /// What is wanted.
    pub(super) part: Part,
    /// The image's number: each has its own noise.
    pub(super) number: u64,
}

/// Quantiles that are kept: a step beyond the outermost is rarer than any pixel of an image.
const QUANTILES: usize = 1 << 14;
/// Steps of the curve from light to levels.
const CURVE: usize = 1 << 12;

impl Electrons {
    /// `gamma` is the exponent from light to levels.
    pub(super) fn new(seed: u64, gamma: f64) -> Self {
        let at = |k: usize| quantile((k as f64 + 0.5) / QUANTILES as f64) as f32;
        let level = |k: usize| (255.0 * powf(k as f64 / CURVE as f64, gamma)).round() as u8;
        Self { seed, normal: (0..QUANTILES).map(at).collect(), curve: (0..=CURVE).map(level).collect() }
    }

    /// Levels of a picture in light, full scale one.
    pub(super) fn read(&self, sensor: &Sensor, light: &[[f32; 3]], mosaic: &Mosaic) -> Vec<u8> {
        // what is cast rounds down
        let level = |share: f32| self.curve[(share.clamp(0.0, 1.0) * CURVE as f32 + 0.5) as usize];
        let Mosaic { wide, part, .. } = mosaic;
        let places =
            (0..wide.height).flat_map(|y| (0..wide.width).map(move |x| (wide.left + x, wide.top + y)));
        if sensor.bayer {
            let mut values: Vec<f32> = places.zip(light).map(|((x, y), pixel)| pixel[colour(x, y)]).collect();
            self.spoil(sensor, &mut values, (0, mosaic));
            return demosaiced(&values, mosaic, level);
        }
        let mut all: Vec<Vec<f32>> = (0..3).map(|c| light.iter().map(|pixel| pixel[c]).collect()).collect();
        all.iter_mut().zip(0..).for_each(|(plane, c)| self.spoil(sensor, plane, (c, mosaic)));
        let inside = |&(_, (x, y)): &(usize, (usize, usize))| {
            (part.left..part.left + part.width).contains(&x)
                && (part.top..part.top + part.height).contains(&y)
        };
        let wanted = places.enumerate().filter(inside);
        wanted.flat_map(|(i, _)| [0, 1, 2].map(|c| level(all[c][i]))).collect()
    }

    /// Adds noise. That of light is the root of the electrons there are (Janesick, *Photon Transfer*, §3.2); beyond a full well there are no
    /// more. What a pixel draws depends on its place and its image's number alone.
    fn spoil(&self, sensor: &Sensor, values: &mut [f32], (plane, mosaic): (u64, &Mosaic)) {
        let (full, read) = (sensor.full_well as f32, sensor.read_noise as f32);
        let wide = &mosaic.wide;
        let image = mixed(self.seed.wrapping_add(mosaic.number.wrapping_mul(GOLDEN)) ^ plane << 60);
        for (y, row) in values.chunks_mut(wide.width.max(1)).enumerate() {
            let row_seed = mixed(image ^ (wide.top + y) as u64);
            let bits_of = |four: usize| mixed(row_seed.wrapping_add((four as u64).wrapping_mul(GOLDEN)));
            let (mut four, mut bits) = (wide.left / 4, bits_of(wide.left / 4));
            for (k, v) in row.iter_mut().enumerate() {
                let x = wide.left + k;
                if x / 4 != four {
                    (four, bits) = (x / 4, bits_of(x / 4));
                }
                let normal = self.normal[(bits >> (16 * (x % 4))) as usize % QUANTILES];
                let electrons = (*v * full).min(full);
                *v = (electrons + normal * (electrons + read * read).sqrt()) / full;
            }
        }
    }
}

/// Which colour a pixel sees: 0 red, 1 green, 2 blue.
const fn colour(x: usize, y: usize) -> usize {
    x % 2 + y % 2
}

/// All colours of each wanted pixel, in levels: those it does not see are the means of neighbours that do.
fn demosaiced(values: &[f32], mosaic: &Mosaic, level: impl Fn(f32) -> u8) -> Vec<u8> {
    let Mosaic { size, wide, part, .. } = mosaic;
    let mut all = Vec::with_capacity(3 * part.width * part.height);
    for y in part.top..part.top + part.height {
        let [above, own, below] = [mirrored(y, size[1], true), y, mirrored(y, size[1], false)]
            .map(|row| &values[(row - wide.top) * wide.width..][..wide.width]);
        for column in part.left..part.left + part.width {
            let x = column - wide.left;
            let [left, right] = [true, false].map(|before| mirrored(column, size[0], before) - wide.left);
            let beside = 0.5 * (own[left] + own[right]);
            let upright = 0.5 * (above[x] + below[x]);
            let corners = 0.25 * (above[left] + above[right] + below[left] + below[right]);
            let colours = match (column % 2, y % 2) {
                (0, 0) => [own[x], 0.5 * (beside + upright), corners],
                (1, 1) => [corners, 0.5 * (beside + upright), own[x]],
                (1, 0) => [beside, own[x], upright],
                _ => [upright, own[x], beside],
            };
            all.extend(colours.map(&level));
        }
    }
    all
}

/// The place before or after one; beyond the border its mirror image.
const fn mirrored(at: usize, size: usize, before: bool) -> usize {
    match (before, at) {
        (true, 0) => 1,
        (true, _) => at - 1,
        (false, _) if at + 1 == size => size - 2,
        (false, _) => at + 1,
    }
}

/// The normal distribution's quantile: Newton's method on its distribution, from a logistic one's.
fn quantile(p: f64) -> f64 {
    let mut z = ln(p / (1.0 - p)) / 1.702;
    for _ in 0..20 {
        let density = exp(-0.5 * z * z) / std::f64::consts::TAU.sqrt();
        let off = 0.5 * erfc(-z * std::f64::consts::FRAC_1_SQRT_2) - p;
        // half a deviation at most: far out the density is next to nothing
        z -= (off / density).clamp(-0.5, 0.5);
    }
    z
}

#[cfg(test)]
mod tests {
    use super::*;

    fn whole(width: usize, height: usize) -> Mosaic {
        let part = Part::whole([width, height]);
        Mosaic { size: [width, height], wide: part, part, number: 0 }
    }

    #[test]
    fn noise_is_that_of_the_electrons() {
        let sensor = Sensor {
            full_well: 1000.0,
            read_noise: 10.0,
            reference_s: 1.0,
            readout_s: 0.0,
            gamma: 1.0,
            bayer: false,
        };
        let mut read = vec![0.4; 100_000];
        Electrons::new(1, 1.0).spoil(&sensor, &mut read, (0, &whole(400, 250)));
        let mean = read.iter().sum::<f32>() / 1e5;
        let variance = read.iter().map(|v| (v - mean).powi(2)).sum::<f32>() / 1e5;
        assert!((mean - 0.4).abs() < 5e-4);
        let told = (400.0_f32 + 100.0) / 1e6;
        assert!((variance / told - 1.0).abs() < 0.02, "{variance} {told}");
    }

    #[test]
    fn a_grey_wall_is_grey_through_the_mosaic_and_a_red_one_red() {
        let level = |v: f32| (100.0 * v + 0.5) as u8;
        assert!(demosaiced(&[0.3; 12 * 8], &whole(12, 8), level).iter().all(|&v| v == 30));
        let mosaic: Vec<f32> = (0..96).map(|i| f32::from(u8::from(colour(i % 12, i / 12) == 0))).collect();
        for found in demosaiced(&mosaic, &whole(12, 8), level).chunks_exact(3) {
            assert_eq!(found, [100, 0, 0]);
        }
    }

    #[test]
    fn quantiles_are_those_of_the_normal_distribution() {
        for (p, z) in [(0.5, 0.0), (0.975, 1.959_963_984_540_054), (1e-4, -3.719_016_485_455_709)] {
            assert!((quantile(p) - z).abs() < 1e-9);
        }
    }
}
