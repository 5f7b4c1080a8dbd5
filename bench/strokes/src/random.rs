use std::f64::consts::TAU;

use oorandom::Rand64;

/// Seeded draws.
pub struct Random(Rand64);

impl Random {
    /// From a seed; equal seeds draw alike everywhere.
    pub fn new(seed: u128) -> Self {
        Self(Rand64::new(seed))
    }

    /// Evenly in [least, most).
    pub fn between(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * self.0.rand_float()
    }

    /// In [least, most), each factor as likely as any other.
    pub fn log_between(&mut self, least: f64, most: f64) -> f64 {
        self.between(least.ln(), most.ln()).exp()
    }

    /// A whole number in [least, most].
    pub fn whole(&mut self, least: usize, most: usize) -> usize {
        self.0.rand_range(least as u64..most as u64 + 1) as usize
    }

    /// True with this probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.0.rand_float() < probability
    }

    /// 1 or −1.
    pub fn sign(&mut self) -> f64 {
        if self.chance(0.5) { 1.0 } else { -1.0 }
    }

    /// An angle, rad.
    pub fn angle(&mut self) -> f64 {
        self.between(0.0, TAU)
    }

    /// One of these, which must not be none.
    pub fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.whole(0, from.len() - 1)]
    }

    /// 64 even bits.
    pub fn bits(&mut self) -> u64 {
        self.0.rand_u64()
    }
}

/// Standard normal draws by the quantile of 16 even bits: the noise of a picture of many megapixels.
pub(crate) struct Normal {
    quantiles: Vec<f32>,
}

impl Normal {
    pub(crate) fn new() -> Self {
        const STEPS: usize = 1 << 16;
        let quantiles = (0..STEPS).map(|i| quantile((i as f64 + 0.5) / STEPS as f64) as f32);
        Self { quantiles: quantiles.collect() }
    }

    /// Four draws at once.
    pub(crate) fn four(&self, random: &mut Random) -> [f32; 4] {
        let bits = random.bits();
        [0, 16, 32, 48].map(|shift| self.quantiles[(bits >> shift) as usize & 0xFFFF])
    }
}

/// Of the standard normal distribution, to 4.5e-4: Abramowitz and Stegun, *Handbook of Mathematical Functions*, 26.2.23.
fn quantile(p: f64) -> f64 {
    let tail = p.min(1.0 - p);
    let t = (-2.0 * tail.ln()).sqrt();
    let up = 2.515_517 + t * (0.802_853 + t * 0.010_328);
    let down = 1.0 + t * (1.432_788 + t * (0.189_269 + t * 0.001_308));
    (t - up / down).copysign(p - 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_noise_has_the_spread_it_is_said_to_have() {
        let normal = Normal::new();
        let mut random = Random::new(1);
        let draws: Vec<f64> = (0..50_000).flat_map(|_| normal.four(&mut random)).map(f64::from).collect();
        let mean = draws.iter().sum::<f64>() / draws.len() as f64;
        let variance = draws.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / draws.len() as f64;
        assert!(mean.abs() < 0.01 && (variance - 1.0).abs() < 0.02, "mean {mean}, variance {variance}");
    }
}
