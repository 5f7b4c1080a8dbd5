//! The laser's spot in shots, held against what the encoders said when they were taken.

use tracelight_aim::{Alignment, Camera, SeenSpot};
use tracelight_markers::{Spot, SpotLost, SpotWindow, find_spot};
use tracelight_maths::hypot;
use tracelight_plant::RelayConfig;
use tracelight_rig::{PanTilt, TICK_F64_S, Telemetry};
use tracelight_stroke::Point;

use tracelight_rigfile::Timing;

use crate::Shot;
use crate::painted::Painted;

/// What the joints did and whether the laser was driven, tick by tick.
#[derive(Clone, Debug)]
pub struct History {
    /// After a change of the gate nobody knows for so long whether there is light, s.
    switches_s: f64,
    ticks: Vec<(PanTilt<f64>, bool)>,
    /// The tick of the first.
    first: u32,
}

/// Whether light left the head throughout a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Light {
    /// All the time.
    Lit,
    /// At no time.
    Dark,
    /// Now and then, or nobody knows.
    Mixed,
}

/// How much longer than is believed of a relay it may take, s.
const SLACK_S: f64 = 0.005;

/// For so long at least what was is known, ticks: five minutes, longer than any image is on its way and any dots take.
const KEPT_TICKS: usize = 300_000;

/// Forgets what is older than that of what is kept tick by tick from a first one on.
pub(crate) fn forget<T>(ticks: &mut Vec<T>, first: &mut u32) {
    if ticks.len() > 2 * KEPT_TICKS {
        ticks.drain(..KEPT_TICKS);
        *first = first.wrapping_add(KEPT_TICKS as u32);
    }
}

impl History {
    /// Of a laser with that relay.
    #[must_use]
    pub const fn new(relay: &RelayConfig) -> Self {
        Self { switches_s: relay.on_s.max(relay.off_s) + SLACK_S, ticks: Vec::new(), first: 0 }
    }

    /// After a change of the gate nobody knows for so long whether there is light, s.
    #[must_use]
    pub const fn switches_s(&self) -> f64 {
        self.switches_s
    }

    /// One more tick; they come in order.
    pub fn push(&mut self, telemetry: &Telemetry) {
        if self.ticks.is_empty() {
            self.first = telemetry.tick;
        }
        forget(&mut self.ticks, &mut self.first);
        self.ticks.push((telemetry.position_rad.map(f64::from), telemetry.actuation.lights()));
    }

    fn between(&self, from_s: f64, until_s: f64) -> Option<&[(PanTilt<f64>, bool)]> {
        let place = |time_s: f64| time_s / TICK_F64_S - f64::from(self.first);
        let (from, until) = (place(from_s).floor(), place(until_s).ceil());
        let inside = from >= 0.0 && until < self.ticks.len() as f64 && until >= from;
        inside.then(|| &self.ticks[from as usize..=until as usize])
    }

    /// Whether there was light from one time to another.
    #[must_use]
    pub fn light(&self, from_s: f64, until_s: f64) -> Light {
        let Some(ticks) = self.between(from_s - self.switches_s, until_s) else { return Light::Mixed };
        let lit = ticks.iter().filter(|(_, gate)| *gate).count();
        match lit {
            0 => Light::Dark,
            all if all == ticks.len() => Light::Lit,
            _ => Light::Mixed,
        }
    }

    /// Where the joints were at a time, rad, between ticks evenly.
    fn at(&self, time_s: f64) -> Option<PanTilt<f64>> {
        let place = time_s / TICK_F64_S - f64::from(self.first);
        let before = place.floor();
        if before < 0.0 || before as usize + 1 >= self.ticks.len() {
            return None;
        }
        let (share, before) = (place - before, before as usize);
        let (a, b) = (self.ticks[before].0, self.ticks[before + 1].0);
        Some(PanTilt::from_fn(|j| a[j] + share * (b[j] - a[j])))
    }

    /// Where the joints were in the mean from one time to another, rad, and how fast they were, rad/s.
    fn mean(&self, from_s: f64, until_s: f64) -> Option<(PanTilt<f64>, PanTilt<f64>)> {
        const PIECES: usize = 16;
        let length_s = until_s - from_s;
        let mut sum = PanTilt::new(0.0, 0.0);
        for k in 0..PIECES {
            let at = self.at(from_s + length_s * (k as f64 + 0.5) / PIECES as f64)?;
            sum = PanTilt::from_fn(|j| sum[j] + at[j] / PIECES as f64);
        }
        // over 4 ms at least: the encoders' opinion of a speed is rough
        let about_s = (0.5 * length_s).max(2e-3);
        let middle_s = 0.5 * (from_s + until_s);
        let (a, b) = (self.at(middle_s - about_s)?, self.at(middle_s + about_s)?);
        Some((sum, PanTilt::from_fn(|j| (b[j] - a[j]) / (2.0 * about_s))))
    }
}

impl History {
    /// Whether there was light while rows of an image were exposed, from one down it to another; surely, as far as times are known.
    #[must_use]
    pub fn light_in(&self, timing: &Timing, shot: &Shot, [from, until]: [f64; 2]) -> Light {
        let (from_s, _) = timing.row_s(shot.stamp_s, shot.exposure_s, from);
        let (_, until_s) = timing.row_s(shot.stamp_s, shot.exposure_s, until);
        self.light(from_s - timing.unsure_s, until_s + timing.unsure_s)
    }
}

/// All rows of an image.
pub const WHOLE: [f64; 2] = [0.0, 1.0];

/// When an image was taken, as it is stamped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stamp {
    stamp_s: f64,
    exposure_s: f64,
}

/// A spot in an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighting {
    when: Stamp,
    /// How far down the image: 0 in the first row, 1 in the last.
    down: f64,
    /// Where on the target, m.
    at: Point,
    /// Standard deviation of either coordinate, m.
    deviation_m: f64,
}

impl Sighting {
    /// When it was, as it is believed: from and until, s.
    #[must_use]
    pub fn time_s(&self, timing: &Timing) -> (f64, f64) {
        timing.row_s(self.when.stamp_s, self.when.exposure_s, self.down)
    }

    /// The same with where the encoders had the joints then; `None` if they were not watched then.
    #[must_use]
    pub fn spot(&self, history: &History, timing: &Timing) -> Option<SeenSpot> {
        let (from_s, until_s) = timing.row_s(self.when.stamp_s, self.when.exposure_s, self.down);
        let (angle_rad, rate_rad_s) = history.mean(from_s, until_s)?;
        Some(SeenSpot { angle_rad, rate_rad_s, down: self.down, at: self.at, deviation_m: self.deviation_m })
    }
}

/// What a shot told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sight {
    /// Nothing: no spot was to be seen, or nobody knows.
    Nothing,
    /// Where the spot was.
    Seen(Sighting),
    /// The spot was to be seen, and was not.
    Lost(SpotLost),
}

/// Looks for the spot in one shot after the other.
pub struct SpotWatch {
    camera: Camera,
    /// When images are taken.
    pub timing: Timing,
    /// The latest image without a spot.
    dark: Option<Shot>,
    /// How far from where it was believed the last spot was seen, px.
    last_off_px: Option<tracelight_stroke::Vec2>,
    /// How bright spots are of late, as a share of the brightest there can be.
    usual: Option<f64>,
    /// How long the next images should be exposed, s,
    pub exposure_s: f64,
    /// and how long once there is an image without the spot to hold them against.
    wished_s: f64,
    /// Shots in which a spot was awaited and not found.
    pub lost: usize,
    /// Why the last image showed no spot.
    pub last_lost: Option<SpotLost>,
    /// What was seen, as a picture, if one is wanted.
    pub painted: Option<Painted>,
}

/// What speckle and one pixel in four that sees red leave a spot uncertain by, px.
const LEAST_DEVIATION_PX: f64 = 0.1;
/// What is less than this share as bright as spots were of late is noise: of a covered lens, say.
const LEAST_OF_USUAL: f64 = 0.1;
/// Half of the side of the window in which a spot is looked for: where the last one told where, and before.
const NEAR_PX: usize = 40;
const FAR_PX: usize = 200;

impl SpotWatch {
    /// For a camera, with a first guess of a short exposure, s.
    #[must_use]
    pub const fn new(camera: Camera, exposure_s: f64) -> Self {
        Self {
            camera,
            timing: Timing::USUAL,
            dark: None,
            last_off_px: None,
            usual: None,
            exposure_s,
            wished_s: exposure_s,
            lost: 0,
            last_lost: None,
            painted: None,
        }
    }

    /// No exposure is longer than this, s.
    pub const fn bound(&mut self, longest_s: f64) {
        self.wished_s = self.wished_s.min(longest_s);
        self.exposure_s = self.exposure_s.min(longest_s);
    }

    /// Begins with a shot without the spot.
    pub fn begin(&mut self, dark: Shot) {
        self.dark = Some(dark);
    }

    /// Looks at a shot. `head` is what is believed of where the beam goes.
    pub fn see(&mut self, shot: &Shot, history: &History, head: &Alignment) -> Sight {
        let when = Stamp { stamp_s: shot.stamp_s, exposure_s: shot.exposure_s };
        if history.light_in(&self.timing, shot, WHOLE) == Light::Dark {
            self.dark = Some(shot.clone());
            self.exposure_s = self.wished_s;
            return Sight::Nothing;
        }
        let Some(awaited) = self.awaited(when, history, head) else { return Sight::Nothing };
        let down = self.down(awaited);
        if history.light_in(&self.timing, shot, [down; 2]) != Light::Lit {
            return Sight::Nothing;
        }
        match self.look(shot, when, awaited) {
            Some(Ok(sighting)) => Sight::Seen(sighting),
            Some(Err(why)) => {
                if matches!(why, SpotLost::Dim { .. }) {
                    self.wished_s *= 1.2;
                }
                self.last_off_px = None;
                (self.lost, self.last_lost) = (self.lost + 1, Some(why));
                Sight::Lost(why)
            }
            None => Sight::Nothing,
        }
    }

    /// Whether there is an image of the wall in the dark to hold one with the spot against.
    #[must_use]
    pub fn is_ready(&self) -> bool {
        self.exposure_s == self.wished_s
            && self.dark.as_ref().is_some_and(|dark| dark.is_exposed(self.exposure_s))
    }

    /// How far down the image a place is.
    fn down(&self, at: Point) -> f64 {
        (at.y / self.camera.lens.size_px[1] as f64).clamp(0.0, 1.0)
    }

    /// The spot near where it is awaited; `None` if there is no image to hold that against, or it shows no wall there.
    fn look(&mut self, shot: &Shot, when: Stamp, awaited: Point) -> Option<Result<Sighting, SpotLost>> {
        let Some(dark) = self.dark.as_ref().filter(|dark| dark.is_exposed(when.exposure_s)) else {
            // it was lit again before another exposure was there in the dark
            self.exposure_s = self.dark.as_ref().map_or(self.exposure_s, |dark| dark.exposure_s);
            return None;
        };
        let (centre, half_px) = match self.last_off_px {
            Some(off) => (awaited + off, NEAR_PX),
            None => (awaited, FAR_PX),
        };
        let window = SpotWindow { centre, half_px };
        let Ok((lit, begins)) = shot.red_near(&window) else {
            return Some(Err(SpotLost::OutOfSight(centre)));
        };
        let (dark, _) = dark.red_near(&window).ok()?;
        let spot = match find_spot(&lit, &dark, &SpotWindow { centre: centre - begins, ..window }) {
            Ok(spot) => Spot { at: spot.at + begins, ..spot },
            Err(SpotLost::OutOfSight(at)) => return Some(Err(SpotLost::OutOfSight(at + begins))),
            Err(why) => return Some(Err(why)),
        };
        let least = self.usual.map_or(0.0, |usual| LEAST_OF_USUAL * usual);
        if spot.brightness < least {
            return Some(Err(SpotLost::Dim { change: 100.0 * spot.brightness, least: 100.0 * least }));
        }
        self.usual = Some(self.usual.map_or(spot.brightness, |usual| 0.8 * usual + 0.2 * spot.brightness));
        if spot.clipped > 0 {
            self.wished_s = 0.7 * when.exposure_s;
        }
        self.last_off_px = Some(spot.at - awaited);
        if let Some(painted) = &mut self.painted {
            painted.add(&lit, &dark, begins, &self.camera);
        }
        let at = self.camera.target(spot.at)?;
        let deviation_m = hypot(spot.deviation_px, LEAST_DEVIATION_PX) / self.camera.scale(at)?;
        Some(Ok(Sighting { when, down: self.down(spot.at), at, deviation_m }))
    }

    /// Where the spot should be in an image, px.
    fn awaited(&self, when: Stamp, history: &History, head: &Alignment) -> Option<Point> {
        let mut down = 0.5;
        let mut at = None;
        // which row it is on tells when that was exposed
        for _ in 0..3 {
            let (from_s, until_s) = self.timing.row_s(when.stamp_s, when.exposure_s, down);
            let angle = history.at(0.5 * (from_s + until_s))?;
            let pixel = self.camera.pixel(head.geometry.spot(&head.pose, angle)?)?;
            down = self.down(pixel);
            at = Some(pixel);
        }
        at
    }
}
