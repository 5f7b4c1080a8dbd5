/// Smooth random values on the plane, in [0, 1]: value noise (Ebert and others, *Texturing and Modeling*, 2003, ch. 2),
/// two octaves.
#[derive(Clone, Copy)]
pub(crate) struct Grain {
    seed: u64,
    /// Size of a cell, px, along x and along y.
    cell: (f64, f64),
}

impl Grain {
    pub(crate) fn new(seed: u64, cell: (f64, f64)) -> Self {
        Self { seed, cell }
    }

    pub(crate) fn at(&self, x: f64, y: f64) -> f64 {
        let (u, v) = (x / self.cell.0, y / self.cell.1);
        (2.0 * self.octave(u, v, 0) + self.octave(2.0 * u + 0.37, 2.0 * v + 0.71, 1)) / 3.0
    }

    fn octave(&self, u: f64, v: f64, octave: u64) -> f64 {
        let (column, row) = (u.floor(), v.floor());
        let smooth = |t: f64| t * t * (3.0 - 2.0 * t);
        let (s, t) = (smooth(u - column), smooth(v - row));
        let corner = |dx: f64, dy: f64| self.corner((column + dx) as i64, (row + dy) as i64, octave);
        let top = corner(0.0, 0.0) * (1.0 - s) + corner(1.0, 0.0) * s;
        let bottom = corner(0.0, 1.0) * (1.0 - s) + corner(1.0, 1.0) * s;
        top * (1.0 - t) + bottom * t
    }

    /// A word of the cell's place, mixed by the first half of SplitMix64's finalizer.
    fn corner(&self, column: i64, row: i64, octave: u64) -> f64 {
        let word = (column as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15)
            ^ (row as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F)
            ^ self.seed.wrapping_add(octave);
        let word = (word ^ (word >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let word = (word ^ (word >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (word >> 40) as f64 / (1_u64 << 24) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_grain_is_even_and_smooth() {
        let grain = Grain::new(7, (2.0, 2.0));
        let values: Vec<f64> =
            (0..40_000).map(|i| grain.at(f64::from(i % 200), f64::from(i / 200))).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        assert!((mean - 0.5).abs() < 0.02, "{mean}");
        assert!(values.iter().all(|v| (0.0..=1.0).contains(v)));
        assert!((grain.at(3.0, 4.0) - grain.at(3.01, 4.0)).abs() < 0.05);
    }
}
