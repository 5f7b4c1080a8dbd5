use super::config::Sensor;

/// Noise, drawn from a seed.
#[derive(Clone, Debug)]
pub(super) struct Electrons {
    dice: oorandom::Rand64,
    /// Normally distributed: quantiles at equal steps of probability.
    normal: Vec<f32>,
}

/// Quantiles that are kept: a step beyond the outermost is rarer than any pixel of an image.
const QUANTILES: usize = 1 << 14;
/// Steps of the curve from light to levels.
const CURVE: usize = 1 << 12;

impl Electrons {
    pub(super) fn new(seed: u64) -> Self {
        let at = |k: usize| quantile((k as f64 + 0.5) / QUANTILES as f64) as f32;
        Self { dice: oorandom::Rand64::new(u128::from(seed)), normal: (0..QUANTILES).map(at).collect() }
    }

    /// Levels of a picture in light, full scale one.
    pub(super) fn read(
        &mut self,
        sensor: &Sensor,
        light: &[[f32; 3]],
        width: usize,
        height: usize,
    ) -> Vec<u8> {
        let curve: Vec<u8> = (0..=CURVE)
            .map(|k| (255.0 * (k as f64 / CURVE as f64).powf(sensor.gamma)).round() as u8)
            .collect();
        // what is cast rounds down
        let level = |share: f32| curve[(share.clamp(0.0, 1.0) * CURVE as f32 + 0.5) as usize];
        if sensor.bayer {
            let mut mosaic = Vec::with_capacity(width * height);
            for (y, row) in light.chunks_exact(width).enumerate() {
                mosaic.extend(row.iter().enumerate().map(|(x, pixel)| pixel[colour(x, y)]));
            }
            let noisy = self.noisy(sensor, mosaic);
            return demosaiced(&noisy, width, height, level);
        }
        let all = self.noisy(sensor, light.iter().flatten().copied().collect());
        all.iter().map(|&v| level(v)).collect()
    }

    /// Shot noise is the root of the electrons there are (Janesick, *Photon Transfer*, §3.2); beyond a full well there are no more.
    fn noisy(&mut self, sensor: &Sensor, mut light: Vec<f32>) -> Vec<f32> {
        let (full, read) = (sensor.full_well as f32, sensor.read_noise as f32);
        for four in light.chunks_mut(4) {
            let bits = self.dice.rand_u64();
            for (k, v) in four.iter_mut().enumerate() {
                let normal = self.normal[(bits >> (16 * k)) as usize % QUANTILES];
                let electrons = (*v * full).min(full);
                *v = (electrons + normal * (electrons + read * read).sqrt()) / full;
            }
        }
        light
    }
}

/// Which colour a pixel sees: 0 red, 1 green, 2 blue.
const fn colour(x: usize, y: usize) -> usize {
    x % 2 + y % 2
}

/// All colours of each pixel, in levels: those it does not see are the means of neighbours that do.
fn demosaiced(mosaic: &[f32], width: usize, height: usize, level: impl Fn(f32) -> u8) -> Vec<u8> {
    let mut all = Vec::with_capacity(3 * mosaic.len());
    for y in 0..height {
        let [above, own, below] = [mirrored(y, height, true), y, mirrored(y, height, false)]
            .map(|row| &mosaic[row * width..][..width]);
        for x in 0..width {
            let (left, right) = (mirrored(x, width, true), mirrored(x, width, false));
            let beside = 0.5 * (own[left] + own[right]);
            let upright = 0.5 * (above[x] + below[x]);
            let corners = 0.25 * (above[left] + above[right] + below[left] + below[right]);
            let colours = match (x % 2, y % 2) {
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
    let mut z = (p / (1.0 - p)).ln() / 1.702;
    for _ in 0..20 {
        let density = (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt();
        let off = 0.5 * libm::erfc(-z * std::f64::consts::FRAC_1_SQRT_2) - p;
        // half a deviation at most: far out the density is next to nothing
        z -= (off / density).clamp(-0.5, 0.5);
    }
    z
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let mut electrons = Electrons::new(1);
        let read = electrons.noisy(&sensor, vec![0.4; 100_000]);
        let mean = read.iter().sum::<f32>() / 1e5;
        let variance = read.iter().map(|v| (v - mean).powi(2)).sum::<f32>() / 1e5;
        assert!((mean - 0.4).abs() < 5e-4);
        let told = (400.0_f32 + 100.0) / 1e6;
        assert!((variance / told - 1.0).abs() < 0.02, "{variance} {told}");
    }

    #[test]
    fn a_grey_wall_is_grey_through_the_mosaic_and_a_red_one_red() {
        let level = |v: f32| (100.0 * v + 0.5) as u8;
        assert!(demosaiced(&[0.3; 12 * 8], 12, 8, level).iter().all(|&v| v == 30));
        let mosaic: Vec<f32> = (0..96).map(|i| f32::from(u8::from(colour(i % 12, i / 12) == 0))).collect();
        for found in demosaiced(&mosaic, 12, 8, level).chunks_exact(3) {
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
