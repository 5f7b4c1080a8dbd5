//! How much memory a picture takes while it is traced, told before it is decoded.

use std::fs::{self, File};
use std::io::BufReader;

/// Memory of all pictures in work together, bytes.
pub(crate) const MOST_BYTES: u64 = 1_500_000_000;

/// Of a picture with pixels: decoded, colour and grey, ink, distances and regions. 400 MB at 24 megapixels is what a
/// picture may take; clean drawings of that size were measured to take 172 MB, and eight threads 770 MB in all.
const BYTES_A_PIXEL: u64 = 17;
/// Of a drawing: the worst SVG of 16 MiB takes 900 MB (see `formats::MAX_BYTES`).
const BYTES_A_DRAWING_BYTE: u64 = 56;

/// Memory that tracing `picture` takes, bytes; `u64::MAX` where nothing can be known before it is read.
pub(crate) fn bytes(picture: &str) -> u64 {
    // what is no plain file may only be read once: a pipe
    let Some(length) = fs::metadata(picture).ok().filter(fs::Metadata::is_file).map(|m| m.len()) else {
        return if picture == "-" || fs::exists(picture).unwrap_or(false) { u64::MAX } else { 0 };
    };
    let size = File::open(picture).ok().and_then(|f| imagesize::reader_size(BufReader::new(f)).ok());
    match size {
        Some(size) => (size.width as u64)
            .saturating_mul(size.height as u64)
            .saturating_mul(BYTES_A_PIXEL)
            .saturating_add(length),
        None => length.saturating_mul(BYTES_A_DRAWING_BYTE),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example(name: &str) -> String {
        format!("{}/../../examples/{name}", env!("CARGO_MANIFEST_DIR"))
    }

    #[test]
    fn a_picture_weighs_what_its_header_declares() {
        let star = bytes(&example("star.png"));
        assert!(
            (640 * 480 * BYTES_A_PIXEL..640 * 480 * BYTES_A_PIXEL + 100_000).contains(&star),
            "{star} bytes"
        );
    }

    #[test]
    fn a_drawing_weighs_by_its_length_and_a_pipe_fills_all_room() {
        let readme = example("README.md");
        assert_eq!(bytes(&readme), 56 * fs::metadata(&readme).unwrap().len());
        assert_eq!(bytes("-"), u64::MAX);
        assert_eq!(bytes("no/such/picture.png"), 0);
    }
}
