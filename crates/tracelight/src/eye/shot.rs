use std::io::Cursor;

use image::ImageFormat;
use tracelight_plant::Image;
use tracelight_vision::Grey;

use crate::failure::Failure;
use crate::output::Raster;

/// An image, and when it was taken by the clock of the rig's ticks. What a camera sent is decoded when somebody looks.
#[derive(Clone, Debug)]
pub(crate) struct Shot {
    pub(crate) width: usize,
    pub(crate) height: usize,
    sent: Sent,
    /// When its first row began to be exposed, as its stamp says, s.
    pub(crate) stamp_s: f64,
    /// How long each row was, s.
    pub(crate) exposure_s: f64,
}

/// What a camera sends.
#[derive(Clone, Debug)]
enum Sent {
    /// Red, green and blue of each pixel, row by row from the upper left, that a simulated camera has yet to compress.
    Simulated(Vec<u8>),
}

/// Quality of what cameras send as JPEG.
const QUALITY: u8 = 92;

impl Shot {
    /// Red, green and blue of each pixel, row by row from the upper left.
    pub(crate) fn pixels(&self) -> Result<Raster, Failure> {
        let broken =
            |why: String| Failure::failed("camera-image", format!("the camera sent a broken image: {why}"));
        let Sent::Simulated(rgb) = &self.sent;
        let raw = Raster::new(self.width as u32, self.height as u32, rgb.clone());
        let bytes = raw
            .ok_or_else(|| broken("it has no pixels".to_owned()))?
            .jpeg(QUALITY)
            .map_err(|e| broken(e.to_string()))?;
        let image = image::load(Cursor::new(bytes), ImageFormat::Jpeg)
            .map_err(|e| broken(e.to_string()))?
            .into_rgb8();
        Raster::new(image.width(), image.height(), image.into_raw())
            .ok_or_else(|| broken("it has no pixels".to_owned()))
    }

    /// The same of a camera whose lens is covered.
    #[cfg(test)]
    pub(crate) fn covered(mut self) -> Self {
        let Sent::Simulated(rgb) = &mut self.sent;
        rgb.fill(3);
        self
    }

    /// Its red, where a red laser is.
    pub(crate) fn red(&self) -> Result<Grey, Failure> {
        let red = self.pixels()?.rgb().iter().copied().step_by(3).collect();
        Grey::new(self.width, self.height, red).map_err(|e| Failure::failed("camera-image", e))
    }
}

/// Brightness of each pixel.
pub(crate) fn grey(raster: &Raster) -> Result<Grey, Failure> {
    let luma =
        |p: &[u8]| ((77 * u32::from(p[0]) + 150 * u32::from(p[1]) + 29 * u32::from(p[2]) + 128) >> 8) as u8;
    let levels = raster.rgb().chunks_exact(3).map(luma).collect();
    Grey::new(raster.width() as usize, raster.height() as usize, levels)
        .map_err(|e| Failure::failed("camera-image", e))
}

impl From<Image> for Shot {
    fn from(image: Image) -> Self {
        let Image { width, height, rgb, start_s, exposure_s, .. } = image;
        Self { width, height, sent: Sent::Simulated(rgb), stamp_s: start_s, exposure_s }
    }
}
