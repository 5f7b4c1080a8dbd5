//! Light from levels, and less noise on it.

use std::ops::Range;
use std::sync::LazyLock;

use tracelight_image::Plane;

/// Light of each level, as a share of the brightest: cameras store it to a power of about 1/2.2.
pub(crate) fn light_of_levels() -> &'static [f32; 256] {
    static LIGHT: LazyLock<[f32; 256]> =
        LazyLock::new(|| std::array::from_fn(|level| (level as f32 / 255.0).powf(2.2)));
    &LIGHT
}

/// What becomes of the outermost values where all are smoothed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Border {
    /// They stay as they are along their border.
    Stays,
    /// They are smoothed as if beyond it there were the same again.
    GoesOn,
}

impl Border {
    /// Which of so many values are smoothed.
    const fn smoothed(self, count: usize) -> Range<usize> {
        match self {
            Self::Stays => 1..count.saturating_sub(1),
            Self::GoesOn => 0..count,
        }
    }
}

/// Each value with its neighbours by 1 2 1, across and down.
pub(crate) fn smooth(light: &mut Plane<f32>, border: Border) {
    let width = light.width;
    for row in light.values.chunks_exact_mut(width.max(1)) {
        let mut before = row.first().copied().unwrap_or(0.0);
        for x in border.smoothed(width) {
            let own = row[x];
            row[x] = 0.25 * (before + row[(x + 1).min(width - 1)]) + 0.5 * own;
            before = own;
        }
    }
    let mut before = light.values.get(..width).unwrap_or(&[]).to_vec();
    for y in border.smoothed(light.height) {
        let (own, below) = light.values[y * width..].split_at_mut(width);
        // beyond the last row there is itself again
        let last = if below.is_empty() { own.to_vec() } else { Vec::new() };
        let below = if below.is_empty() { &last } else { &below[..width] };
        for ((own, before), below) in own.iter_mut().zip(&mut before).zip(below) {
            let smooth = 0.25 * (*before + *below) + 0.5 * *own;
            *before = *own;
            *own = smooth;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn smoothed(values: &[f32], border: Border) -> Vec<f32> {
        let mut light = Plane { width: 3, height: values.len() / 3, values: values.to_vec() };
        smooth(&mut light, border);
        light.values
    }

    #[test]
    fn one_pixels_light_is_spread_by_1_2_1_either_way() {
        let one = [0.0, 0.0, 0.0, 0.0, 16.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(smoothed(&one, Border::GoesOn), [1.0, 2.0, 1.0, 2.0, 4.0, 2.0, 1.0, 2.0, 1.0]);
        assert_eq!(smoothed(&one, Border::Stays), [0.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn light_at_the_border_stays_or_goes_on_beyond_it() {
        let corner = [16.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(smoothed(&corner, Border::GoesOn), [9.0, 3.0, 0.0, 3.0, 1.0, 0.0]);
        assert_eq!(smoothed(&corner, Border::Stays), [16.0, 4.0, 0.0, 0.0, 0.0, 0.0]);
        assert!(smoothed(&[], Border::GoesOn).is_empty());
    }
}
