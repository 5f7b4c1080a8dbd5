use tracelight_maths::single;

/// A field of light or texture: one `f32` a pixel, rows from the top.
#[derive(Clone, Debug)]
pub(super) struct Plane {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) values: Vec<f32>,
}

impl Plane {
    /// A field of zeros.
    pub(super) fn dark(width: usize, height: usize) -> Self {
        Self { width, height, values: vec![0.0; width * height] }
    }

    /// White noise in [−1, 1): the same for the same `seed`, whatever the machine.
    pub(super) fn noise(width: usize, height: usize, seed: u32) -> Self {
        let values = (0..width * height).map(|i| grain(i as u32, seed)).collect();
        Self { width, height, values }
    }

    /// Adds energy at a point, shared among the four pixels around it; what falls outside is lost.
    pub(super) fn splat(&mut self, x: f32, y: f32, energy: f32) {
        let (x, y) = (x - 0.5, y - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let (fx, fy) = (x - left, y - top);
        // what is not a number fails the first two comparisons
        if !(left >= 0.0 && top >= 0.0) || left as usize + 1 >= self.width || top as usize + 1 >= self.height
        {
            return;
        }
        let at = top as usize * self.width + left as usize;
        self.values[at] += energy * (1.0 - fx) * (1.0 - fy);
        self.values[at + 1] += energy * fx * (1.0 - fy);
        self.values[at + self.width] += energy * (1.0 - fx) * fy;
        self.values[at + self.width + 1] += energy * fx * fy;
    }

    /// Half the size, each pixel the mean of four.
    pub(super) fn halved(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mut out = Self::dark(width, height);
        for (y, row) in out.values.chunks_exact_mut(width).enumerate() {
            let upper = self.row(2 * y);
            let lower = self.row((2 * y + 1).min(self.height - 1));
            for (x, value) in row.iter_mut().enumerate() {
                let (a, b) = (2 * x, (2 * x + 1).min(self.width - 1));
                *value = 0.25 * (upper[a] + upper[b] + lower[a] + lower[b]);
            }
        }
        out
    }

    /// Halved `times` times.
    pub(super) fn reduced(&self, times: u32) -> Self {
        (0..times).fold(self.clone(), |plane, _| plane.halved())
    }

    /// Blurred by a Gaussian, standard deviations in pixels; the edges go on as they are. Its work grows with
    /// sigma: reduce first for wide ones.
    pub(super) fn blurred(&self, sigma_x: f32, sigma_y: f32) -> Self {
        let mut across = Self::dark(self.width, self.height);
        let kernel = gaussian(sigma_x);
        for (y, out) in across.values.chunks_exact_mut(self.width).enumerate() {
            convolve_row(self.row(y), out, &kernel);
        }
        let mut both = Self::dark(self.width, self.height);
        let kernel = gaussian(sigma_y);
        let reach = kernel.len() / 2;
        for (y, out) in both.values.chunks_exact_mut(self.width).enumerate() {
            for (k, &weight) in kernel.iter().enumerate() {
                let from = across.row((y + k).saturating_sub(reach).min(self.height - 1));
                out.iter_mut().zip(from).for_each(|(o, v)| *o += weight * v);
            }
        }
        both
    }

    /// One row.
    pub(super) fn row(&self, y: usize) -> &[f32] {
        &self.values[y * self.width..(y + 1) * self.width]
    }

    /// Value at a point of a picture `2^reduced` times as large, between pixels by bilinear interpolation.
    pub(super) fn sample(&self, x: f32, y: f32, reduced: u32) -> f32 {
        let scale = 1.0 / (1_u32 << reduced) as f32;
        let x = (x * scale - 0.5).clamp(0.0, (self.width - 1) as f32);
        let y = (y * scale - 0.5).clamp(0.0, (self.height - 1) as f32);
        let (left, top) = (x as usize, y as usize);
        let (fx, fy) = (x - left as f32, y - top as f32);
        let right = (left + 1).min(self.width - 1);
        let (upper, lower) = (self.row(top), self.row((top + 1).min(self.height - 1)));
        let mix = |row: &[f32]| row[left] + (row[right] - row[left]) * fx;
        mix(upper) + (mix(lower) - mix(upper)) * fy
    }

    /// Scaled so that the mean square is one.
    pub(super) fn normalized(mut self) -> Self {
        let square: f64 = self.values.iter().map(|&v| f64::from(v * v)).sum();
        let scale = (self.values.len() as f64 / square.max(1e-30)).sqrt() as f32;
        self.values.iter_mut().for_each(|v| *v *= scale);
        self
    }
}

fn convolve_row(from: &[f32], out: &mut [f32], kernel: &[f32]) {
    let reach = kernel.len() / 2;
    let mut padded = Vec::with_capacity(from.len() + 2 * reach);
    padded.resize(reach, from[0]);
    padded.extend_from_slice(from);
    padded.resize(from.len() + 2 * reach, from[from.len() - 1]);
    for (k, &weight) in kernel.iter().enumerate() {
        out.iter_mut().zip(&padded[k..]).for_each(|(o, v)| *o += weight * v);
    }
}

/// Weights of a Gaussian cut at three sigmas, sum one, odd number.
fn gaussian(sigma: f32) -> Vec<f32> {
    let reach = (3.0 * sigma).ceil().max(0.0) as i32;
    let weight = |i: i32| single::exp(-0.5 * single::powi(i as f32 / sigma.max(1e-3), 2));
    let weights: Vec<f32> = (-reach..=reach).map(weight).collect();
    let sum: f32 = weights.iter().sum();
    weights.into_iter().map(|w| w / sum).collect()
}

/// A pixel's noise in [−1, 1): the finalizer of MurmurHash3 (Appleby 2011) over its number.
fn grain(i: u32, seed: u32) -> f32 {
    let mut h = i.wrapping_mul(0x9e37_79b9) ^ seed.wrapping_mul(0x85eb_ca6b);
    h = (h ^ h >> 16).wrapping_mul(0x85eb_ca6b);
    h = (h ^ h >> 13).wrapping_mul(0xc2b2_ae35);
    h ^= h >> 16;
    (h >> 8) as f32 / (1_u32 << 23) as f32 - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blurring_keeps_the_energy() {
        let mut plane = Plane::dark(64, 48);
        plane.splat(30.3, 20.9, 5.0);
        for sigma in [0.8, 2.5, 4.0] {
            let sum: f32 = plane.blurred(sigma, sigma).values.iter().sum();
            assert!((sum - 5.0).abs() < 1e-3, "{sigma}: {sum}");
        }
    }

    #[test]
    fn light_outside_the_picture_is_lost_not_wrapped() {
        let mut plane = Plane::dark(8, 8);
        for (x, y) in [(-3.0, 4.0), (9.0, 4.0), (4.0, -1.0), (4.0, 1e9), (f32::NAN, 2.0)] {
            plane.splat(x, y, 1.0);
        }
        assert!(plane.values.iter().all(|&v| v == 0.0));
    }

    #[test]
    fn a_reduced_field_is_sampled_where_it_was() {
        let ramp: Vec<f32> = (0..64 * 64).map(|i| (i % 64) as f32 + 0.5).collect();
        let plane = Plane { width: 64, height: 64, values: ramp }.reduced(3);
        for x in [8.0_f32, 20.0, 33.3, 50.0] {
            assert!((plane.sample(x, 30.0, 3) - x).abs() < 1e-3);
        }
    }
}
