//! The program's front door: a file of any kind, picture or drawing.

use std::io::Cursor;

use image::ImageReader;
use tracelight_picture::{Pixels, Source, decode};

use crate::sound::check_sheet;

/// Most pixels that may come out of the door: the documented 100 megapixels.
const MOST_PIXELS: usize = 100_000_000;

/// Pictures that declare more than this, and no more than they may, are left to the program's own tests: they take a
/// second each, and nothing of them that is not in small ones.
const SLOW_PIXELS: u64 = 2_000_000;

/// No message is longer, bytes, whatever stands in the file.
const LONGEST_MESSAGE: usize = 2000;

/// A file is a picture within its bounds, a sound drawing, or refused in a sentence.
///
/// # Panics
/// When it is not.
pub fn check(file: &[u8]) {
    if is_slow(file) {
        return;
    }
    match decode("picture", file) {
        Ok(Source::Pixels(pixels)) => check_pixels(&pixels),
        Ok(Source::Strokes(reading)) => check_sheet(&reading.sheet),
        Err(failure) => {
            let length = failure.message.len();
            assert!((20..=LONGEST_MESSAGE).contains(&length), "{length} bytes: {}", failure.message);
        }
    }
}

fn check_pixels(pixels: &Pixels) {
    let (width, height) = (pixels.colour.width() as usize, pixels.colour.height() as usize);
    assert!(width * height <= MOST_PIXELS, "{width} × {height}");
    assert_eq!((pixels.grey.width(), pixels.grey.height()), (width, height));
    assert_eq!(pixels.grey.levels().len(), width * height);
}

fn is_slow(file: &[u8]) -> bool {
    let Ok(reader) = ImageReader::new(Cursor::new(file)).with_guessed_format() else { return false };
    let Ok((width, height)) = reader.into_dimensions() else { return false };
    (SLOW_PIXELS..=MOST_PIXELS as u64).contains(&(u64::from(width) * u64::from(height)))
}
