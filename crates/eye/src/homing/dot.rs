//! A dot of light, and whether the camera sees it.

use tracelight_image::Grey;
use tracelight_markers::{SpotLost, SpotWindow, find_spot};
use tracelight_rig::Command;
use tracelight_sim::Simulated;
use tracelight_stroke::Point;
use tracelight_task::Failure;

use super::Homing;
use crate::spots::{Light, WHOLE};
use crate::{Eye, Looks};

/// How long a dot is lit, ticks: a camera that sends ten images a second sees it whole.
const DOT_TICKS: u16 = 350;
/// How long its image is waited for, ticks.
const WAIT_TICKS: u32 = 600;
/// Images of a dot in which it is looked for.
const LIT_IMAGES: usize = 3;
/// How far apart two images of one dot may show it, px.
const SAME_PX: f64 = 3.0;

impl<R: Simulated + Eye> Homing<'_, R> {
    /// By how much the wall seems to change by itself, from one image to the next.
    pub(super) fn change(&mut self) -> Result<f64, Failure> {
        const IMAGES: usize = 4;
        let dark = Dark { image: self.rig.take(self.exposure_s)?.red()?, change: 0.0 };
        let mut change = 0.0_f64;
        for _ in 1..IMAGES {
            self.task.check()?;
            change = change.max(dark.brightest(&self.rig.take(self.exposure_s)?.red()?));
        }
        Ok(change)
    }

    /// Lights a dot where the head rests; where the camera sees it, px. What does not go out with it is none.
    pub(super) fn dot(&mut self, change: f64) -> Result<Option<Point>, Failure> {
        let Some(image) = self.image(Light::Dark)? else {
            return Err(Failure::failed(
                "no-image",
                "the camera sends no images any more: is it plugged in?",
            ));
        };
        let dark = Dark { image, change };
        let _ = self.rig.send(Command::Point(DOT_TICKS));
        let mut seen: Vec<Point> = Vec::new();
        for _ in 0..LIT_IMAGES {
            let lit = self.image(Light::Lit)?;
            seen.extend(lit.and_then(|lit| dark.spot(&lit)));
        }
        let &[.., before, now] = seen.as_slice() else { return Ok(None) };
        let after = self.image(Light::Dark)?.and_then(|after| dark.spot(&after));
        let is_gone = after.is_none_or(|after| after.distance(now) > SAME_PX);
        Ok((is_gone && before.distance(now) < SAME_PX).then_some(now))
    }

    /// The next image that was taken all in light, or all in the dark; `None` if none comes.
    fn image(&mut self, wanted: Light) -> Result<Option<Grey>, Failure> {
        for _ in 0..WAIT_TICKS {
            self.step()?;
            while let Some(shot) = self.rig.shot() {
                if shot.is_exposed(self.exposure_s)
                    && self.history.light_in(&self.timing, &shot, WHOLE) == wanted
                    && let Ok(image) = shot.red()
                {
                    return Ok(Some(image));
                }
            }
        }
        Ok(None)
    }
}

/// The wall without light.
struct Dark {
    image: Grey,
    /// The most by which anything on it became brighter without light, as a share of full light.
    change: f64,
}

/// How many times brighter than what becomes brighter by itself the light of a dot is.
const PLAIN: f64 = 3.0;

impl Dark {
    /// The spot in a whole image.
    fn spot(&self, lit: &Grey) -> Option<Point> {
        let spot = find_spot(lit, &self.image, &self.window()).ok()?;
        (spot.brightness > PLAIN * self.change).then_some(spot.at)
    }

    /// By how much anything is brighter in another image of the same.
    fn brightest(&self, other: &Grey) -> f64 {
        match find_spot(other, &self.image, &self.window()) {
            Ok(spot) => spot.brightness,
            Err(SpotLost::Dim { change, .. }) => change / 100.0,
            Err(_) => 0.0,
        }
    }

    /// All of it.
    fn window(&self) -> SpotWindow {
        let (width, height) = (self.image.width(), self.image.height());
        let centre = Point::new(width as f64 / 2.0, height as f64 / 2.0);
        SpotWindow { centre, half_px: width.max(height) / 2 }
    }
}
