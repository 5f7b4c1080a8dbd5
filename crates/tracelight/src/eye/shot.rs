use tracelight_plant::Image;
use tracelight_vision::Grey;

use crate::failure::Failure;
use crate::output::Raster;
use crate::picture::{self, Source};

/// An image, and when it was taken by the clock of the rig's ticks. What a camera sent is decoded when somebody looks.
#[derive(Clone, Debug)]
pub(crate) struct Shot {
    sent: Sent,
    /// When its first row began to be exposed, as its stamp says, s.
    pub(crate) stamp_s: f64,
    /// How long each row was, s.
    pub(crate) exposure_s: f64,
}

/// What a camera sends.
#[derive(Clone, Debug)]
enum Sent {
    /// Pixels that a simulated camera has yet to compress.
    Simulated(Raster),
    /// An image file, and where it came from.
    Encoded { from: String, bytes: Vec<u8> },
    /// Nothing that has pixels.
    Nothing,
}

/// Quality of what cameras send as JPEG.
const QUALITY: u8 = 92;

impl Shot {
    /// An image file that was there at a time, s; how long it was exposed nobody knows.
    pub(crate) fn encoded(from: &str, bytes: Vec<u8>, stamp_s: f64) -> Self {
        Self { sent: Sent::Encoded { from: from.to_owned(), bytes }, stamp_s, exposure_s: 0.0 }
    }

    /// Its pixels.
    pub(crate) fn pixels(&self) -> Result<Raster, Failure> {
        match &self.sent {
            Sent::Simulated(raster) => {
                let bytes = raster.jpeg(QUALITY).map_err(|e| Failure::failed("camera-image", e))?;
                decoded("the camera's image", &bytes)
            }
            Sent::Encoded { from, bytes } => decoded(from, bytes),
            Sent::Nothing => Err(Failure::failed("camera-image", "the camera's image has no pixels")),
        }
    }

    /// The same of a camera whose lens is covered.
    #[cfg(test)]
    pub(crate) fn covered(mut self) -> Self {
        if let Sent::Simulated(raster) = &self.sent {
            let dark = vec![3; raster.rgb().len()];
            self.sent =
                Raster::new(raster.width(), raster.height(), dark).map_or(Sent::Nothing, Sent::Simulated);
        }
        self
    }

    /// Its red, where a red laser is.
    pub(crate) fn red(&self) -> Result<Grey, Failure> {
        let pixels = self.pixels()?;
        let red = pixels.rgb().iter().copied().step_by(3).collect();
        Grey::new(pixels.width() as usize, pixels.height() as usize, red)
            .map_err(|e| Failure::failed("camera-image", e))
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
        let sent = Raster::new(width as u32, height as u32, rgb).map_or(Sent::Nothing, Sent::Simulated);
        Self { sent, stamp_s: start_s, exposure_s }
    }
}

fn decoded(from: &str, bytes: &[u8]) -> Result<Raster, Failure> {
    match picture::decode(from, bytes)? {
        Source::Pixels(pixels) => Ok(pixels.colour),
        Source::Strokes(_) => Err(Failure::usage(
            "not-a-picture",
            format!("{from} is a drawing; give an image that a camera took"),
        )),
    }
}
