//! Linear light from grey levels, and noise reduction.

use std::sync::LazyLock;

use tracelight_image::Plane;
use tracelight_maths::single;

/// Light of each level, as a share of the brightest: cameras store it to a power of about 1/2.2.
pub(crate) fn light_of_levels() -> &'static [f32; 256] {
    static LIGHT: LazyLock<[f32; 256]> =
        LazyLock::new(|| std::array::from_fn(|level| single::powf(level as f32 / 255.0, 2.2)));
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

/// Each value with its neighbours by 1 2 1, across and down.
pub(crate) fn smooth(light: &mut Plane<f32>, border: Border) {
    let (width, height) = (light.width, light.height);
    light.values.chunks_exact_mut(width.max(1)).for_each(|row| smooth_row(row, border));
    let rows = match border {
        Border::Stays => 1..height.saturating_sub(1),
        Border::GoesOn => 0..height,
    };
    let mut above = light.values.get(..width).unwrap_or(&[]).to_vec();
    for y in rows {
        let (row, below) = light.values[y * width..].split_at_mut(width);
        match below.get(..width) {
            Some(below) => smooth_down(row, &mut above, below),
            None => {
                let beyond = row.to_vec();
                smooth_down(row, &mut above, &beyond);
            }
        }
    }
}

fn smooth_row(row: &mut [f32], border: Border) {
    let (Some(&first), Some(&last)) = (row.first(), row.last()) else { return };
    let (second, end) = (row.get(1).copied().unwrap_or(first), row.len() - 1);
    let mut before = first;
    for x in 1..end {
        let own = row[x];
        row[x] = 0.25 * (before + row[x + 1]) + 0.5 * own;
        before = own;
    }
    if border == Border::GoesOn {
        row[0] = 0.25 * (first + second) + 0.5 * first;
        row[end] = 0.25 * (before + last) + 0.5 * last;
    }
}

/// A row with the one above, as that was, and the one below; from then on it is the one above, as it was.
fn smooth_down(row: &mut [f32], above: &mut [f32], below: &[f32]) {
    for ((own, above), below) in row.iter_mut().zip(above).zip(below) {
        let smooth = 0.25 * (*above + *below) + 0.5 * *own;
        *above = *own;
        *own = smooth;
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
