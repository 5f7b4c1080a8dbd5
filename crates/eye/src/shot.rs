//! An image, and when it was taken.

use tracelight_image::Grey;
use tracelight_markers::SpotWindow;
use tracelight_picture::{Raster, Source, decode};
use tracelight_plant::{Image, Part};
use tracelight_sim::Taken;
use tracelight_stroke::{Point, Vec2};
use tracelight_task::Failure;

use crate::coding::{Coding, Layout, as_file};

/// An image, and when it was taken by the clock of the rig's ticks. What a camera sent is decoded when somebody looks.
#[derive(Clone, Debug)]
pub struct Shot {
    sent: Sent,
    /// When its first row began to be exposed, as its stamp says, s.
    pub stamp_s: f64,
    /// How long each row was, s.
    pub exposure_s: f64,
}

/// What a camera sends.
#[derive(Clone, Debug)]
enum Sent {
    /// What a simulated camera has yet to compute and compress.
    Simulated(Box<Taken>),
    /// An image file, and where it came from.
    Encoded { from: String, bytes: Vec<u8> },
    /// What a camera that is plugged in sent, and which.
    Coded { from: String, layout: Layout, bytes: Vec<u8> },
    /// Pixels.
    #[cfg(test)]
    Pixels(Raster),
}

/// Quality of what cameras send as JPEG.
const QUALITY: u8 = 92;

impl Shot {
    /// An image file that was there at a time, s; how long it was exposed nobody knows.
    #[must_use]
    pub fn encoded(from: &str, bytes: Vec<u8>, stamp_s: f64) -> Self {
        Self { sent: Sent::Encoded { from: from.to_owned(), bytes }, stamp_s, exposure_s: 0.0 }
    }

    /// What a camera that is plugged in sent: when its first row began to be exposed, and how long each was (0 where nobody knows), s.
    #[must_use]
    pub fn sent(from: &str, layout: Layout, bytes: Vec<u8>, [stamp_s, exposure_s]: [f64; 2]) -> Self {
        Self { sent: Sent::Coded { from: from.to_owned(), layout, bytes }, stamp_s, exposure_s }
    }

    /// Its pixels.
    ///
    /// # Errors
    /// Bytes that are no image, or one that is too large.
    pub fn pixels(&self) -> Result<Raster, Failure> {
        match &self.sent {
            Sent::Simulated(taken) => compressed(taken.image()),
            Sent::Encoded { from, bytes } => decoded(from, bytes),
            Sent::Coded { from, layout, bytes } if layout.coding() == Coding::Jpeg => {
                let spoilt =
                    |e: Failure| Failure::failed("camera-image", format!("a spoilt image: {}", e.message));
                decoded(from, &as_file(bytes)).map_err(spoilt)
            }
            Sent::Coded { from, layout, bytes } => layout
                .pixels(bytes)
                .ok_or_else(|| Failure::failed("camera-image", format!("{from} sent half an image"))),
            #[cfg(test)]
            Sent::Pixels(raster) => Ok(raster.clone()),
        }
    }

    /// The same of a camera whose lens is covered.
    #[cfg(test)]
    pub fn covered(mut self) -> Self {
        if let Sent::Simulated(taken) = &self.sent {
            let [width, height] = taken.size();
            let dark = vec![3; 3 * width * height];
            let raster = Raster::new(width as u32, height as u32, dark);
            self.sent = Sent::Pixels(raster.expect("as many levels as pixels have"));
        }
        self
    }

    /// Whether each row was exposed so long, s, to a hundredth of it.
    #[must_use]
    pub fn is_exposed(&self, exposure_s: f64) -> bool {
        (self.exposure_s - exposure_s).abs() <= 0.01 * exposure_s
    }

    /// Whether it shows to the byte what another does: no two images of a camera that looks do, for their noise.
    #[must_use]
    pub fn is_same(&self, other: &Self) -> bool {
        match (&self.sent, &other.sent) {
            (Sent::Simulated(one), Sent::Simulated(other)) => one.shows_same(other),
            (Sent::Encoded { bytes: one, .. }, Sent::Encoded { bytes: other, .. })
            | (Sent::Coded { bytes: one, .. }, Sent::Coded { bytes: other, .. }) => one == other,
            _ => false,
        }
    }

    /// Its red, where a red laser is, in a window and some way around it; and where in the image that begins. Of a simulated camera nothing
    /// else is computed: as JPEG has it, blocks of 16 pixels by themselves.
    ///
    /// # Errors
    /// As of [`Self::pixels`].
    pub fn red_near(&self, window: &SpotWindow) -> Result<(Grey, Vec2), Failure> {
        /// Side of the squares that JPEG compresses by themselves, colours that stand for four pixels included.
        const BLOCK: usize = 16;
        let Sent::Simulated(taken) = &self.sent else { return Ok((self.red()?, Vec2::ZERO)) };
        let range = |at: f64, size: usize| {
            let reach = (window.half_px + BLOCK / 2) as f64;
            let low = (at - reach).clamp(0.0, size as f64) as usize / BLOCK * BLOCK;
            let high = ((at + reach).clamp(0.0, size as f64) as usize).next_multiple_of(BLOCK).min(size);
            (low, high.saturating_sub(low))
        };
        let [columns, rows] = taken.size();
        let Point { x, y } = window.centre;
        let ((left, width), (top, height)) = (range(x, columns), range(y, rows));
        if width == 0 || height == 0 {
            return Err(Failure::failed("camera-image", "the spot is awaited out of the camera's sight"));
        }
        let part = compressed(taken.part(&Part { left, top, width, height }))?;
        Ok((red(&part)?, Vec2::new(left as f64, top as f64)))
    }

    /// Its red, where a red laser is.
    ///
    /// # Errors
    /// As of [`Self::pixels`].
    pub fn red(&self) -> Result<Grey, Failure> {
        red(&self.pixels()?)
    }
}

fn red(pixels: &Raster) -> Result<Grey, Failure> {
    let levels = pixels.rgb().iter().copied().step_by(3).collect();
    Grey::new(pixels.width() as usize, pixels.height() as usize, levels)
        .map_err(|e| Failure::failed("camera-image", e))
}

/// What a simulated camera sends, as it arrives.
fn compressed(image: Image) -> Result<Raster, Failure> {
    let unsound = || Failure::failed("camera-image", "the camera's image has no pixels");
    let Image { width, height, rgb, .. } = image;
    let raster = Raster::new(width as u32, height as u32, rgb).ok_or_else(unsound)?;
    let bytes = raster.jpeg(QUALITY).map_err(|e| Failure::failed("camera-image", e))?;
    decoded("the camera's image", &bytes)
}

/// Brightness of each pixel.
///
/// # Errors
/// An image that is too large, or has no pixels.
pub fn grey(raster: &Raster) -> Result<Grey, Failure> {
    let luma =
        |p: &[u8]| ((77 * u32::from(p[0]) + 150 * u32::from(p[1]) + 29 * u32::from(p[2]) + 128) >> 8) as u8;
    let levels = raster.rgb().chunks_exact(3).map(luma).collect();
    Grey::new(raster.width() as usize, raster.height() as usize, levels)
        .map_err(|e| Failure::failed("camera-image", e))
}

impl From<Taken> for Shot {
    fn from(taken: Taken) -> Self {
        let Taken { stamp_s, exposure_s, .. } = taken;
        Self { sent: Sent::Simulated(Box::new(taken)), stamp_s, exposure_s }
    }
}

fn decoded(from: &str, bytes: &[u8]) -> Result<Raster, Failure> {
    match decode(from, bytes)? {
        Source::Pixels(pixels) => Ok(pixels.colour),
        Source::Strokes(_) => Err(Failure::usage(
            "not-a-picture",
            format!("{from} is a drawing; give an image that a camera took"),
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_aim::{Camera, CameraPose, HeadPose, Lens};
    use tracelight_plant::{CameraConfig, SimulatedCamera, Wall};
    use tracelight_sim::{RigConfig, Room, Simulated, SimulatedRig};

    #[test]
    fn what_is_looked_at_near_the_spot_is_as_it_is_in_the_whole_image() {
        let pose = CameraPose::looking_at([0.1, 0.1, 1.0], [0.0; 3]).unwrap();
        let camera = Camera { lens: Lens::ideal(200, 150, 150.0), pose };
        let wall = Wall { plain: [0.3, 0.25, 0.2], posters: vec![] };
        let eye = SimulatedCamera::new(&CameraConfig::webcam(), &camera, &wall, 1);
        let rig = SimulatedRig::new(&RigConfig::report(), HeadPose::square_on(0.9144), 0);
        let mut room = Room::new(rig, eye, 3);
        let taken = (0..500).find_map(|_| {
            room.step();
            room.taken()
        });
        let shot = Shot::from(taken.unwrap());
        let whole = shot.red().unwrap();
        for centre in [Point::new(100.0, 70.0), Point::new(3.0, 4.0), Point::new(199.0, 149.0)] {
            let window = SpotWindow { centre, half_px: 20 };
            let (part, begins) = shot.red_near(&window).unwrap();
            let (left, top) = (begins.x as usize, begins.y as usize);
            for y in 0..150_usize {
                for x in 0..200_usize {
                    let place = Point::new(x as f64 + 0.5, y as f64 + 0.5);
                    if (place.x - centre.x).abs() > 21.0 || (place.y - centre.y).abs() > 21.0 {
                        continue;
                    }
                    let own = part.levels()[(y - top) * part.width() + x - left];
                    assert_eq!(own, whole.levels()[y * 200 + x], "{centre} {x} {y}");
                }
            }
        }
        let beyond = SpotWindow { centre: Point::new(-300.0, 10.0), half_px: 20 };
        assert!(shot.red_near(&beyond).is_err());
    }
}
