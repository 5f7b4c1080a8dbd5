//! A dot of light, and whether the camera sees it.

use tracelight_image::Grey;
use tracelight_markers::{SpotLost, SpotWindow, find_spot};
use tracelight_rig::TICK_F64_S;
use tracelight_rigfile::Timing;
use tracelight_session::Request;
use tracelight_stroke::Point;
use tracelight_task::Failure;

use crate::homing::state::Homing;
use crate::spots::{Light, WHOLE};
use crate::{Driven, Looks};

/// How much longer than an image takes a dot is lit, ticks.
const MORE_TICKS: u16 = 10;
/// How long a rig makes wait for more light at most, ticks: it looks back on ten seconds.
const BUDGET_TICKS: u32 = 11_000;
/// How long its image is waited for, ticks.
const WAIT_TICKS: u32 = 600;
/// Most dots until an image is taken all in light.
const MOST_DOTS: usize = 3;
/// How far apart two images of one dot may show it, px.
const SAME_PX: f64 = 3.0;

impl<D: Driven> Homing<'_, D> {
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

    /// Lights the laser twice where the head rests; where the camera sees it, px. What does not come and go with it is none. Where nothing comes
    /// the first time, there is no second: a head of which nobody knows where it points has little light to spend.
    pub(super) fn dot(&mut self, change: f64) -> Result<Option<Point>, Failure> {
        let Some(before) = self.glimpse(change)? else { return Ok(None) };
        let now = self.glimpse(change)?;
        Ok(now.filter(|now| before.distance(*now) < SAME_PX))
    }

    /// Lights the laser until one image shows it, and looks whether it went out again.
    fn glimpse(&mut self, change: f64) -> Result<Option<Point>, Failure> {
        let Some(image) = self.image(Light::Dark)? else {
            return Err(Failure::failed(
                "no-image",
                "the camera sends no images any more: is it plugged in?",
            ));
        };
        let dark = Dark { image, change };
        for _ in 0..MOST_DOTS {
            self.light()?;
            let lit = self.image(Light::Lit)?;
            self.rig.ask(Request::Disarm)?;
            let Some(lit) = lit else { continue };
            let Some(now) = dark.spot(&lit) else { return Ok(None) };
            let after = self.image(Light::Dark)?.and_then(|after| dark.spot(&after));
            return Ok(after.is_none_or(|after| after.distance(now) > SAME_PX).then_some(now));
        }
        Ok(None)
    }

    /// Lights the laser as soon as there may be light again, for as long as an image takes.
    fn light(&mut self) -> Result<(), Failure> {
        let Timing { readout_s, unsure_s, .. } = self.timing;
        let image_s = self.rig.longest_s() + self.exposure_s + readout_s + 2.0 * unsure_s;
        let dot_ticks = ((image_s + self.history.switches_s()) / TICK_F64_S) as u16 + MORE_TICKS;
        self.begin()?;
        for _ in 0..BUDGET_TICKS {
            self.rig.ask(Request::Mark(dot_ticks))?;
            if self.step()?.actuation.lights() {
                break;
            }
        }
        Ok(())
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
