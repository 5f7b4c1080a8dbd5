//! An 8-bit picture turned upright.

use image::metadata::Orientation;

/// Side of the squares that are turned one after the other, pixels: a picture's columns read one by one would come from memory
/// pixel by pixel.
const TILE: usize = 32;

/// The picture's size and bytes, three a pixel, as its orientation says how it is seen.
pub(crate) fn turned(
    (width, height): (usize, usize),
    rgb: Vec<u8>,
    orientation: Orientation,
) -> ((usize, usize), Vec<u8>) {
    if orientation == Orientation::NoTransforms || rgb.len() != 3 * width * height {
        return ((width, height), rgb);
    }
    let size = if is_on_its_side(orientation) { (height, width) } else { (width, height) };
    let mut upright = vec![0; rgb.len()];
    for (top, left) in tiles(size) {
        for y in top..(top + TILE).min(size.1) {
            for x in left..(left + TILE).min(size.0) {
                let (from_x, from_y) = source((x, y), size, orientation);
                let [from, to] = [from_y * width + from_x, y * size.0 + x].map(|pixel| 3 * pixel);
                upright[to..to + 3].copy_from_slice(&rgb[from..from + 3]);
            }
        }
    }
    (size, upright)
}

const fn is_on_its_side(orientation: Orientation) -> bool {
    matches!(
        orientation,
        Orientation::Rotate90
            | Orientation::Rotate270
            | Orientation::Rotate90FlipH
            | Orientation::Rotate270FlipH
    )
}

fn tiles((width, height): (usize, usize)) -> impl Iterator<Item = (usize, usize)> {
    (0..height).step_by(TILE).flat_map(move |top| (0..width).step_by(TILE).map(move |left| (top, left)))
}

/// Which pixel of the picture as it is stored is seen at a place of the upright one, whose size is given.
const fn source(
    (x, y): (usize, usize),
    (width, height): (usize, usize),
    orientation: Orientation,
) -> (usize, usize) {
    let (right, below) = (width - 1 - x, height - 1 - y);
    match orientation {
        Orientation::NoTransforms => (x, y),
        Orientation::FlipHorizontal => (right, y),
        Orientation::FlipVertical => (x, below),
        Orientation::Rotate180 => (right, below),
        Orientation::Rotate90 => (y, right),
        Orientation::Rotate270 => (below, x),
        Orientation::Rotate90FlipH => (y, x),
        Orientation::Rotate270FlipH => (below, right),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{DynamicImage, RgbImage};

    #[test]
    fn a_picture_is_turned_as_its_library_does() {
        for number in 1..=8 {
            let orientation = Orientation::from_exif(number).unwrap();
            for (width, height) in [(1, 1), (3, 2), (70, 33)] {
                let stored = RgbImage::from_fn(width, height, |x, y| image::Rgb([x as u8, y as u8, 7]));
                let mut known = DynamicImage::from(stored.clone());
                known.apply_orientation(orientation);
                let (size, rgb) = turned((width as usize, height as usize), stored.into_raw(), orientation);
                assert_eq!(size, (known.width() as usize, known.height() as usize), "{orientation:?}");
                assert_eq!(rgb, known.into_rgb8().into_raw(), "{orientation:?} {width} × {height}");
            }
        }
    }
}
