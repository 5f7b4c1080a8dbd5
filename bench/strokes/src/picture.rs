use std::io::Cursor;

use image::codecs::jpeg::JpegEncoder;
use image::{ExtendedColorType, GrayImage, ImageError, ImageFormat};
use tracelight_stroke::Drawing;

/// Grey levels, and the strokes that are in them.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Row by row from the top left.
    pub levels: Vec<u8>,
    /// The truth, pixel frame.
    pub truth: Drawing,
}

impl Picture {
    /// As PNG.
    ///
    /// # Errors
    /// When the encoder fails, for example on a picture without pixels.
    pub fn png(&self) -> Result<Vec<u8>, ImageError> {
        let mut bytes = Vec::new();
        let image = GrayImage::from_raw(self.width as u32, self.height as u32, self.levels.clone());
        image.unwrap_or_default().write_to(&mut Cursor::new(&mut bytes), ImageFormat::Png)?;
        Ok(bytes)
    }
}

/// What JPEG of this quality, in per cent, makes of grey levels.
pub(crate) fn through_jpeg(levels: Vec<u8>, width: usize, height: usize, quality: u8) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = JpegEncoder::new_with_quality(&mut bytes, quality);
    let encoded = encoder.encode(&levels, width as u32, height as u32, ExtendedColorType::L8);
    let decoded = encoded.and_then(|()| image::load_from_memory_with_format(&bytes, ImageFormat::Jpeg));
    decoded.map_or(levels, |image| image.into_luma8().into_raw())
}
