//! What takes images: when told, or by itself while a rig runs.

use tracelight_task::Failure;

use crate::about::About;
use crate::driven::Driven;
use crate::shot::Shot;

/// Something that takes an image when told.
pub trait Looks {
    /// The next image, each row of it exposed so long, s, if the camera can be told.
    ///
    /// # Errors
    /// The camera is gone, sends nothing in time, or has no further image.
    fn take(&mut self, exposure_s: f64) -> Result<Shot, Failure>;

    /// Longest that a row can be exposed, s; `None` of a camera that exposes as it likes.
    fn longest(&self) -> Option<f64>;

    /// What it says of itself, and how its images came.
    fn about(&self) -> About {
        About::default()
    }

    /// Makes its images brighter at the same exposure from the next on, if it can.
    fn brighten(&mut self) -> bool {
        false
    }
}

/// Largest image that is taken, bytes: a hundred megapixels as JPEG.
pub const MOST_IMAGE_BYTES: usize = 64_000_000;

/// Longest that an image is waited for, ticks: the slowest cameras there are send one a second.
pub const PATIENCE_TICKS: u32 = 3000;

/// A rig that rests in the dark meanwhile.
impl<R: Driven> Looks for R {
    fn take(&mut self, exposure_s: f64) -> Result<Shot, Failure> {
        self.expose(exposure_s);
        for _ in 0..PATIENCE_TICKS {
            self.step()?;
            while let Some(shot) = self.shot() {
                // those taken before it was told are exposed otherwise
                if shot.is_exposed(exposure_s) {
                    return Ok(shot);
                }
            }
        }
        let waited_s = f64::from(PATIENCE_TICKS) * tracelight_rig::TICK_F64_S;
        Err(Failure::failed(
            "no-image",
            format!(
                "the camera sent no image for {waited_s:.0} s: is it plugged in, and used by nobody else?"
            ),
        ))
    }

    fn longest(&self) -> Option<f64> {
        Some(self.longest_s())
    }
}
