use std::sync::LazyLock;

use crate::VisionError;
use crate::plane::Plane;

/// Smallest side of an image that can hold a drawing, px.
const LEAST_SIDE: usize = 8;

/// More pixels than this say nothing more about a drawing; larger images are averaged down.
pub(crate) const MOST_PIXELS: usize = 12_000_000;

/// An image of brightnesses: 0 is black, 255 white.
///
/// Rows from the top, pixels from the left. In the pixel frame it spans [0, width] × [0, height], so that the
/// first pixel's centre is (0.5, 0.5).
#[derive(Clone, Debug)]
pub struct Grey {
    pub(crate) plane: Plane<u8>,
}

/// Light of each level, as a share of the brightest: cameras store it to a power of about 1/2.2.
pub(crate) fn light_of_levels() -> &'static [f32; 256] {
    static LIGHT: LazyLock<[f32; 256]> =
        LazyLock::new(|| std::array::from_fn(|level| (level as f32 / 255.0).powf(2.2)));
    &LIGHT
}

impl Grey {
    /// From `width · height` levels, row by row from the top left.
    ///
    /// # Errors
    /// When the number of levels is another one, or the image is under 8 px in width or height.
    pub fn new(width: usize, height: usize, levels: Vec<u8>) -> Result<Self, VisionError> {
        if width.checked_mul(height) != Some(levels.len()) {
            return Err(VisionError::Levels { width, height, levels: levels.len() });
        }
        if width.min(height) < LEAST_SIDE {
            return Err(VisionError::TooSmall { width, height, least: LEAST_SIDE });
        }
        Ok(Self { plane: Plane { width, height, values: levels } })
    }

    /// Pixels in a row.
    pub const fn width(&self) -> usize {
        self.plane.width
    }

    /// Rows.
    pub const fn height(&self) -> usize {
        self.plane.height
    }

    /// The levels, row by row from the top left.
    pub fn levels(&self) -> &[u8] {
        &self.plane.values
    }

    /// Averaged so many times either way, the shorter side still has 8 px.
    pub(crate) fn most_reduction(&self) -> usize {
        (self.width().min(self.height()) / LEAST_SIDE).max(1)
    }

    /// How many pixels either way are averaged into one before tracing: 1 up to 12 megapixels. Never so many that
    /// a side falls under 8 px.
    pub(crate) fn reduction(&self) -> usize {
        let (w, h, most) = (self.width(), self.height(), self.most_reduction());
        (1..=most).find(|k| (w / k) * (h / k) <= MOST_PIXELS).unwrap_or(most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_image_needs_as_many_levels_as_pixels() {
        assert!(Grey::new(10, 10, vec![0; 100]).is_ok());
        let error = Grey::new(10, 10, vec![0; 99]).unwrap_err();
        assert_eq!(error, VisionError::Levels { width: 10, height: 10, levels: 99 });
        assert!(Grey::new(usize::MAX, 2, vec![]).is_err());
        assert!(matches!(Grey::new(1, 10_000, vec![0; 10_000]), Err(VisionError::TooSmall { .. })));
    }

    #[test]
    fn a_vast_image_is_averaged_down() {
        let grey = Grey::new(30, 20, (0..600).map(|i| (i % 30 / 3 * 10) as u8).collect()).unwrap();
        let small = grey.plane.reduced(3);
        assert_eq!((small.width, small.height), (10, 6));
        assert_eq!(small.row(5), [0, 10, 20, 30, 40, 50, 60, 70, 80, 90]);
        assert_eq!(grey.reduction(), 1);
    }
}
