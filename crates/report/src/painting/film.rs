//! From light to eight bits: a filmic curve, then the sRGB transfer function.

use tracelight_maths::single;

/// Entries of the table between black and white; finer than eight bits even in the darkest tones.
const STEPS: usize = 4096;

/// The film: developed through a table, as powers are slow.
pub(super) struct Film {
    srgb: Vec<u8>,
}

impl Film {
    pub(super) fn new() -> Self {
        let encode = |i: usize| (srgb_from_linear(i as f32 / (STEPS - 1) as f32) * 255.0).round() as u8;
        Self { srgb: (0..STEPS).map(encode).collect() }
    }

    /// A pixel's bytes from its linear light.
    pub(super) fn develop(&self, light: [f32; 3]) -> [u8; 3] {
        light.map(|l| self.srgb[(filmic(l) * (STEPS - 1) as f32 + 0.5) as usize])
    }
}

/// Filmic tone curve: toe, straight part, shoulder. Fit of the ACES reference transform by Krzysztof Narkowicz,
/// "ACES Filmic Tone Mapping Curve" (2015).
fn filmic(x: f32) -> f32 {
    let x = x.clamp(0.0, 1e4);
    (x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)).clamp(0.0, 1.0)
}

/// Transfer function of IEC 61966-2-1.
fn srgb_from_linear(x: f32) -> f32 {
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * single::powf(x, 1.0 / 2.4) - 0.055 }
}

/// Its inverse for a byte.
pub(super) fn linear_from_srgb(byte: u8) -> f32 {
    let x = f32::from(byte) / 255.0;
    if x <= 0.040_45 { x / 12.92 } else { single::powf((x + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_light_is_never_darker_and_white_is_white() {
        let film = Film::new();
        let tones: Vec<u8> =
            (0..2000).map(|i| film.develop([(i as f32 / 100.0).powi(2) / 10.0; 3])[0]).collect();
        assert!(tones.windows(2).all(|w| w[0] <= w[1]));
        assert_eq!((tones[0], tones[1999]), (0, 255));
        assert_eq!(film.develop([f32::NAN, f32::INFINITY, -1.0])[1..], [255, 0]);
    }

    #[test]
    fn bytes_survive_the_way_through_linear_light() {
        for byte in 0..=255_u8 {
            assert_eq!((srgb_from_linear(linear_from_srgb(byte)) * 255.0).round() as u8, byte);
        }
    }
}
