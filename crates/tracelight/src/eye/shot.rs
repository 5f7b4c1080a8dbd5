use std::io::Cursor;

use image::ImageFormat;
use tracelight_plant::Image;
use tracelight_vision::{Grey, VisionError};

use crate::output::Raster;

/// An image, and when it was taken by the clock of the rig's ticks.
#[derive(Clone, Debug)]
pub(crate) struct Shot {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// Red, green and blue of each pixel, row by row from the upper left.
    pub(crate) rgb: Vec<u8>,
    /// When its first row began to be exposed, as its stamp says, s.
    pub(crate) stamp_s: f64,
    /// How long each row was, s.
    pub(crate) exposure_s: f64,
}

/// Quality of what cameras send as JPEG.
const QUALITY: u8 = 92;

impl Shot {
    /// Brightness of each pixel.
    pub(crate) fn grey(&self) -> Result<Grey, VisionError> {
        let luma = |p: &[u8]| {
            ((77 * u32::from(p[0]) + 150 * u32::from(p[1]) + 29 * u32::from(p[2]) + 128) >> 8) as u8
        };
        Grey::new(self.width, self.height, self.rgb.chunks_exact(3).map(luma).collect())
    }

    /// Its red, where a red laser is.
    pub(crate) fn red(&self) -> Result<Grey, VisionError> {
        Grey::new(self.width, self.height, self.rgb.iter().copied().step_by(3).collect())
    }

    /// Share of its pixels that are darker than a level.
    pub(crate) fn share_below(&self, level: u8) -> f64 {
        let below = self.rgb.chunks_exact(3).filter(|p| p.iter().all(|&v| v < level)).count();
        below as f64 / (self.width * self.height).max(1) as f64
    }

    /// For display; `None` of an image without pixels.
    pub(crate) fn raster(&self) -> Option<Raster> {
        Raster::new(self.width as u32, self.height as u32, self.rgb.clone())
    }

    /// As a camera that sends JPEG hands it over.
    pub(crate) fn through_jpeg(mut self) -> Self {
        let sent = self.raster().and_then(|raster| raster.jpeg(QUALITY).ok());
        let seen = sent.and_then(|bytes| {
            image::load(Cursor::new(bytes), ImageFormat::Jpeg).ok().map(|image| image.into_rgb8().into_raw())
        });
        if let Some(rgb) = seen {
            self.rgb = rgb;
        }
        self
    }
}

impl From<Image> for Shot {
    fn from(image: Image) -> Self {
        let Image { width, height, rgb, start_s, exposure_s, .. } = image;
        Self { width, height, rgb, stamp_s: start_s, exposure_s }
    }
}
