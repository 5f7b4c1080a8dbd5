use crate::error::ImageError;
use crate::plane::Plane;

/// An image of brightnesses: 0 is black, 255 white.
///
/// Rows from the top, pixels from the left. In the pixel frame it spans [0, width] × [0, height], so that the
/// first pixel's centre is (0.5, 0.5).
#[derive(Clone, Debug)]
pub struct Grey {
    plane: Plane<u8>,
}

impl Grey {
    /// Smallest side of an image that can hold a drawing, px.
    pub const LEAST_SIDE: usize = 8;

    /// From `width · height` levels, row by row from the top left.
    ///
    /// # Errors
    /// When the number of levels is another one, or the image is under 8 px in width or height.
    pub fn new(width: usize, height: usize, levels: Vec<u8>) -> Result<Self, ImageError> {
        if width.checked_mul(height) != Some(levels.len()) {
            return Err(ImageError::Levels { width, height, levels: levels.len() });
        }
        if width.min(height) < Self::LEAST_SIDE {
            return Err(ImageError::TooSmall { width, height, least: Self::LEAST_SIDE });
        }
        Ok(Self { plane: Plane { width, height, values: levels } })
    }

    /// Pixels in a row.
    #[inline]
    pub const fn width(&self) -> usize {
        self.plane.width
    }

    /// Rows.
    #[inline]
    pub const fn height(&self) -> usize {
        self.plane.height
    }

    /// The levels, row by row from the top left.
    #[inline]
    pub fn levels(&self) -> &[u8] {
        &self.plane.values
    }

    /// Views the image as a plane.
    #[inline]
    pub const fn plane(&self) -> &Plane<u8> {
        &self.plane
    }

    /// A part of an image, however small.
    pub const fn of_part(plane: Plane<u8>) -> Self {
        Self { plane }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_image_needs_as_many_levels_as_pixels() {
        assert!(Grey::new(10, 10, vec![0; 100]).is_ok());
        let error = Grey::new(10, 10, vec![0; 99]).unwrap_err();
        assert_eq!(error, ImageError::Levels { width: 10, height: 10, levels: 99 });
        assert!(Grey::new(usize::MAX, 2, vec![]).is_err());
        assert!(matches!(Grey::new(1, 10_000, vec![0; 10_000]), Err(ImageError::TooSmall { .. })));
    }

    #[test]
    fn a_vast_image_is_averaged_down() {
        let grey = Grey::new(30, 20, (0..600).map(|i| (i % 30 / 3 * 10) as u8).collect()).unwrap();
        let small = grey.plane.reduced(3);
        assert_eq!((small.width, small.height), (10, 6));
        assert_eq!(small.row(5), [0, 10, 20, 30, 40, 50, 60, 70, 80, 90]);
    }
}
