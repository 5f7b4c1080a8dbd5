//! What a picture takes to decode, told by its header: memory and work, before either is spent.

use image::{ColorType, ImageFormat};
use tracelight_task::Failure;

use crate::jpeg::Scans;

/// Largest picture, pixels: 100 megapixels.
pub(crate) const MOST_PIXELS: u64 = 100_000_000;

/// What a decoded picture may take, bytes: that many pixels at 8 bit and four channels. While it is made 8-bit colour and
/// grey, and turned upright, twice as much is held at most.
pub(crate) const MOST_DECODED_BYTES: u64 = 4 * MOST_PIXELS;

/// What a decoder may hold beside that of a JPEG whose scans refine each other, bytes: 16 bits a sample, three for each pixel.
const MOST_HELD_BYTES: u64 = 6 * MOST_PIXELS;

/// Pixels that scans of a JPEG may go over, all together: a second of work. Cameras and programs write ten scans, in a
/// picture of 100 megapixels twenty are read.
const MOST_SCANNED: u64 = 20 * MOST_PIXELS;

/// A scan costs as much as so many pixels of it, however small the picture.
const LEAST_SCANNED: u64 = 10_000;

/// What a header declares.
#[derive(Clone, Copy)]
pub(crate) struct Declared {
    pub(crate) format: Option<ImageFormat>,
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) colour: ColorType,
}

/// Whether a picture is worth beginning to decode.
///
/// # Errors
/// `too-large`, with what it would take, the bound, and what to do.
pub(crate) fn check(path: &str, declared: Declared, bytes: &[u8]) -> Result<(), Failure> {
    let Declared { format, width, height, colour } = declared;
    let pixels = u64::from(width) * u64::from(height);
    if pixels > MOST_PIXELS {
        return Err(too_large(path, &format!("{width} × {height} pixels")));
    }
    let refused =
        |what: String| -> Result<(), Failure> { Err(Failure::usage("too-large", format!("{path} {what}"))) };
    let each = u64::from(colour.bytes_per_pixel());
    let decoded = pixels.saturating_mul(each);
    if decoded > MOST_DECODED_BYTES {
        return refused(format!(
            "would take {} MB, {width} × {height} pixels of {each} bytes; at most {} MB are taken: save it with 8 bits a \
             channel, or scale it down",
            decoded / 1_000_000,
            MOST_DECODED_BYTES / 1_000_000
        ));
    }
    if format == Some(ImageFormat::Jpeg) {
        return check_scans(Scans::of(bytes), pixels).or_else(refused);
    }
    Ok(())
}

/// What is said of a JPEG that takes too long, or too much.
fn check_scans(found: Scans, pixels: u64) -> Result<(), String> {
    let work = found.scans.saturating_mul(pixels.max(LEAST_SCANNED));
    if work > MOST_SCANNED {
        let most = MOST_SCANNED / pixels.max(LEAST_SCANNED);
        return Err(format!(
            "is a JPEG of {} scans over {pixels} pixels; at most {most} scans are read of one so large: save it again, not as \
             progressive",
            found.scans
        ));
    }
    let held = if found.is_held { pixels * found.samples_percent * 2 / 100 } else { 0 };
    if held > MOST_HELD_BYTES {
        return Err(format!(
            "is a progressive JPEG that would take {} MB while it is read; at most {} MB are taken: save it again, not as \
             progressive, or scale it down",
            held / 1_000_000,
            MOST_HELD_BYTES / 1_000_000
        ));
    }
    Ok(())
}

/// What is said of a picture that declares too much.
pub(crate) fn too_large(path: &str, what: &str) -> Failure {
    let most = MOST_PIXELS / 1_000_000;
    Failure::usage(
        "too-large",
        format!("{path} declares {what}; at most {most} megapixels are traced: scale it down"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(format: ImageFormat, side: u32, colour: ColorType) -> String {
        let declared = Declared { format: Some(format), width: side, height: side, colour };
        check("a.png", declared, &[]).map_or_else(|failure| failure.message, |()| String::new())
    }

    #[test]
    fn memory_is_bounded_by_bytes_and_not_by_pixels() {
        let vast = said(ImageFormat::Png, 9_950, ColorType::Rgba16);
        assert!(
            vast.contains("792 MB") && vast.contains("at most 400 MB") && vast.contains("8 bits"),
            "{vast}"
        );
        for (side, colour) in [
            (9_950, ColorType::Rgba8),
            (9_950, ColorType::L16),
            (8_000, ColorType::Rgb16),
            (7_000, ColorType::Rgba16),
        ] {
            assert_eq!(said(ImageFormat::Png, side, colour), "", "{side} {colour:?}");
        }
    }

    #[test]
    fn photographs_of_the_largest_size_are_read_in_any_format() {
        for format in [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::WebP] {
            assert_eq!(said(format, 9_950, ColorType::Rgb8), "", "{format:?}");
        }
    }

    #[test]
    fn work_is_bounded_before_it_is_begun() {
        let jpeg = |scans, side: u64, samples_percent| {
            check_scans(Scans { scans, samples_percent, is_held: true }, side * side)
        };
        let many = jpeg(500, 9_950, 300).unwrap_err();
        assert!(many.contains("500 scans") && many.contains("at most 20 scans"), "{many}");
        assert!(jpeg(12, 9_950, 400).unwrap_err().contains("792 MB"), "four channels");
        assert_eq!(jpeg(12, 9_950, 300), Ok(()), "as programs write them");
        assert_eq!(jpeg(150, 3_464, 300), Ok(()), "12 megapixels");
        assert!(jpeg(1_000_000, 8, 300).is_err(), "no picture, only scans");
    }
}
