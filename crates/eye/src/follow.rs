//! A camera that follows the spot while it draws: what is slowly off is estimated, what is suddenly off is told.

use tracelight_aim::{Alignment, Camera, Correction, Trim, TrimBelief};
use tracelight_markers::SpotLost;
use tracelight_plant::RelayConfig;
use tracelight_rig::{PanTilt, Phase, TICK_F64_S, Telemetry};
use tracelight_rigfile::Timing;
use tracelight_sim::Tick;
use tracelight_stroke::Point;

use crate::painted::Painted;
use crate::seen::SeenMark;
use crate::spots::{History, Sight, Sighting, SpotWatch, forget};
use crate::{Eye, Shot};

/// What is known when it begins.
#[derive(Clone, Debug)]
pub struct Followed {
    /// Where it looks from.
    pub camera: Camera,
    /// The head as it is believed to be.
    pub head: Alignment,
    /// When its images are taken.
    pub timing: Timing,
    /// In which the spot is not full, s.
    pub exposure_s: f64,
    /// How far off the head may slowly be.
    pub belief: TrimBelief,
    /// Width of an encoder's count, rad.
    pub count_rad: f64,
    /// The laser's.
    pub relay: RelayConfig,
}

/// What does not look as it should.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Suspicion {
    /// The spot is elsewhere, by so much, m.
    Off(f64),
    /// It is not to be seen.
    Lost(SpotLost),
    /// A joint is further from where it should be than it ever is, rad: somebody may have bumped into the head.
    Jolt(f64),
}

/// Why a camera's images tell nothing for the time being.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blind {
    /// There are none.
    NoImages,
    /// They are all the same.
    Frozen,
    /// Their stamps can not be true.
    Stamps,
    /// They were not taken when their stamps say.
    Untimely,
    /// Nothing is on them.
    Covered,
}

impl Blind {
    /// As a sentence's end.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::NoImages => "the camera sends no images any more: is it still plugged in?",
            Self::Frozen => "the camera sends the same image again and again: it is frozen",
            Self::Stamps => {
                "the camera's stamps can not be true: they go back, lie ahead, or are more than 0.5 s old"
            }
            Self::Untimely => {
                "the camera's images were not taken when their stamps say: the head stands where it stood, and its spot seems elsewhere"
            }
            Self::Covered => {
                "the camera sees nothing any more: is its lens covered or turned away, or the light off?"
            }
        }
    }
}

/// How far off a spot must be to be suspected, m: less is trimmed,
const SUSPECT_M: f64 = 1.5e-3;
/// and in deviations of what is not known.
const SUSPECT_DEVIATIONS: f64 = 6.0;
/// Images in a row without the spot that are suspect, and over how long at least, s.
const LOST_IMAGES: u32 = 3;
const LOST_S: f64 = 0.06;
/// Longest without an image, s, or three times as long as it took before.
const SILENCE_S: f64 = 1.0;
/// Longest that an image is on its way, s.
const LATEST_S: f64 = 0.5;
/// The same image so often is no chance.
const SAME_IMAGES: u32 = 2;

/// How far a joint must be from its setpoint to be taken for jolted, rad, and in how many times what it was at most of late;
const JOLT_RAD: f64 = 1e-4;
const JOLT_TIMES: f64 = 1.5;
/// of late: what was is forgotten by a share each so many ticks, in some ten seconds.
const LATE_TICKS: u32 = 100;
const LATE_FADES: f64 = 1e-2;
/// and only after so many ticks of light is it known,
const WATCHED_TICKS: u32 = 1000;
/// and so many after a stop.
const BEGUN_TICKS: u32 = 200;

/// How far the joint that is further off is from its setpoint, rad.
#[must_use]
pub fn strayed_rad(telemetry: &Telemetry) -> f64 {
    let off = PanTilt::from_fn(|j| telemetry.setpoint[j].position_rad - telemetry.position_rad[j]);
    f64::from(off.pan.abs().max(off.tilt.abs()))
}

/// Follows the spot.
pub struct Follower {
    /// Where the spot is looked for.
    pub watch: SpotWatch,
    history: History,
    head: Alignment,
    trim: Trim,
    /// Until when that has aged, s.
    aged_s: f64,
    now_s: f64,
    /// Where the spot was asked to be and where the plan's clock stood, tick by tick.
    asked: Vec<(Option<Point>, u32)>,
    first_tick: u32,
    blind: Option<Blind>,
    /// The last image, and how often it was the same.
    last: Option<(Shot, u32)>,
    /// When that came, or the first tick.
    heard_s: f64,
    /// Longest from an image to the next of late, s.
    period_s: f64,
    /// How far a joint was from its setpoint at most of late while it was lit, rad, and for how many ticks that was watched.
    strayed_rad: f64,
    /// Likewise of the last few ticks.
    now_strayed_rad: f64,
    watched_ticks: u32,
    /// Ticks since the plan's clock last began to run.
    traced_ticks: u32,
    lost: u32,
    lost_since_s: f64,
    /// Plan's clock when the spot was last seen where it should be.
    good_plan_tick: Option<u32>,
    /// Each spot that was seen.
    pub marks: Vec<SeenMark>,
    /// An exposure that somebody wants an image of, s, and that image.
    wanted_s: Option<f64>,
    taken: Option<Shot>,
}

impl Follower {
    /// Begins with a rig at rest in the dark. What is seen is painted there.
    #[must_use]
    pub fn new(followed: &Followed, painted: Option<Painted>) -> Self {
        let mut watch = SpotWatch::new(followed.camera, followed.exposure_s);
        (watch.timing, watch.painted) = (followed.timing, painted);
        Self {
            watch,
            history: History::new(&followed.relay),
            head: followed.head,
            trim: Trim::new(followed.head, &followed.belief, followed.count_rad),
            aged_s: 0.0,
            now_s: 0.0,
            asked: Vec::new(),
            first_tick: 0,
            blind: None,
            last: None,
            heard_s: 0.0,
            period_s: 0.0,
            strayed_rad: 0.0,
            now_strayed_rad: 0.0,
            watched_ticks: 0,
            traced_ticks: 0,
            lost: 0,
            lost_since_s: 0.0,
            good_plan_tick: None,
            marks: Vec::new(),
            wanted_s: None,
            taken: None,
        }
    }

    /// From now on an image is awaited whose rows are exposed so long, s; until it is [taken](Self::taken) nothing is followed.
    pub const fn want(&mut self, exposure_s: f64) {
        self.wanted_s = Some(exposure_s);
    }

    /// Ends that: none is awaited any more.
    pub const fn want_no_more(&mut self) {
        self.wanted_s = None;
    }

    /// Takes that image, once it is there.
    pub fn taken(&mut self) -> Option<Shot> {
        let taken = self.taken.take();
        if taken.is_some() {
            self.wanted_s = None;
        }
        taken
    }

    /// What its images would tell is not waited for.
    pub const fn distrust(&mut self, why: Blind) {
        self.blind = Some(why);
    }

    /// What joints are beyond their encoders.
    #[must_use]
    pub fn correction(&self) -> Correction {
        self.trim.correction()
    }

    /// Longest from an image to the next of late, s.
    #[must_use]
    pub const fn period_s(&self) -> f64 {
        self.period_s
    }

    /// Begins to listen for images anew: for a while they were somebody else's.
    pub fn hear_again(&mut self) {
        (self.heard_s, self.last) = (f64::INFINITY, None);
    }

    /// Whether the plan's clock runs for so long already that what strays is no restart's: who begins again amid a stroke strays more than who is under way.
    #[must_use]
    pub const fn is_under_way(&self) -> bool {
        self.traced_ticks > BEGUN_TICKS
    }

    /// Why it sees nothing, if so.
    #[must_use]
    pub const fn blind(&self) -> Option<Blind> {
        self.blind
    }

    /// Where the plan's clock stood when the spot was last seen where it should be.
    #[must_use]
    pub const fn good_plan_tick(&self) -> Option<u32> {
        self.good_plan_tick
    }

    /// The camera stands elsewhere than was believed.
    pub fn look_from(&mut self, camera: Camera) {
        let (timing, exposure_s) = (self.watch.timing, self.watch.exposure_s);
        let painted = self.watch.painted.take();
        self.watch = SpotWatch::new(camera, exposure_s);
        self.watch.timing = timing;
        self.watch.painted = painted;
        self.lost = 0;
    }

    /// One tick that was watched, with where the spot was asked to be; what is suspect, if anything is.
    pub fn tick<R: Eye>(&mut self, rig: &mut R, tick: &Tick) -> Option<Suspicion> {
        self.remember(&tick.telemetry, tick.asked);
        let mut suspicion = self.jolted(&tick.telemetry);
        while let Some(shot) = rig.shot() {
            let can_be_true = self.can_be_true(&shot);
            self.watch.bound(rig.longest_s());
            match self.wanted_s {
                Some(wanted_s) if shot.is_exposed(wanted_s) => {
                    self.taken = Some(shot);
                }
                Some(_) => {}
                None if can_be_true => suspicion = suspicion.or(self.see(&shot)),
                None => {}
            }
            rig.expose(self.wanted_s.unwrap_or(self.watch.exposure_s));
        }
        if self.now_s - self.heard_s > SILENCE_S.max(3.0 * self.period_s) && self.blind.is_none() {
            self.blind = Some(Blind::NoImages);
        }
        suspicion
    }

    /// Whether a joint strayed as it never did since it was first lit: encoders feel a bump before any image shows it.
    fn jolted(&mut self, telemetry: &Telemetry) -> Option<Suspicion> {
        if telemetry.phase != Phase::Tracing {
            self.traced_ticks = 0;
            return None;
        }
        self.traced_ticks = self.traced_ticks.saturating_add(1);
        if !telemetry.actuation.lights() {
            return None;
        }
        let off_rad = strayed_rad(telemetry);
        let known = self.watched_ticks > WATCHED_TICKS && self.is_under_way();
        let is_jolt = known && off_rad > JOLT_RAD + JOLT_TIMES * self.strayed_rad;
        self.now_strayed_rad = self.now_strayed_rad.max(off_rad);
        self.watched_ticks = self.watched_ticks.saturating_add(1);
        // a bump that begins must not count as what was usual before
        if self.watched_ticks.is_multiple_of(LATE_TICKS) {
            let before = (1.0 - LATE_FADES) * self.strayed_rad;
            self.strayed_rad = before.max(std::mem::take(&mut self.now_strayed_rad));
        }
        is_jolt.then_some(Suspicion::Jolt(off_rad))
    }

    fn remember(&mut self, telemetry: &Telemetry, asked: Option<Point>) {
        self.now_s = f64::from(telemetry.tick) * TICK_F64_S;
        self.heard_s = self.heard_s.min(self.now_s);
        forget(&mut self.asked, &mut self.first_tick);
        if self.asked.is_empty() {
            (self.first_tick, self.heard_s, self.aged_s) = (telemetry.tick, self.now_s, self.now_s);
        }
        self.history.push(telemetry);
        self.asked.push((asked, telemetry.plan_tick));
    }

    /// Whether an image and its stamp are those of a camera that looks.
    fn can_be_true(&mut self, shot: &Shot) -> bool {
        let ended_s = shot.stamp_s + shot.exposure_s;
        let in_time = (self.now_s - LATEST_S..=self.now_s + self.watch.timing.unsure_s).contains(&ended_s);
        let (before_s, same) = match &self.last {
            Some((last, same)) => (last.stamp_s, if shot.is_same(last) { same + 1 } else { 0 }),
            None => (f64::NEG_INFINITY, 0),
        };
        let is_later = shot.stamp_s > before_s;
        if self.last.is_some() {
            self.period_s = (0.9 * self.period_s).max(self.now_s - self.heard_s);
        }
        (self.last, self.heard_s) = (Some((shot.clone(), same)), self.now_s);
        // whose clock was wrong once is not believed again
        if matches!(self.blind, Some(Blind::Stamps | Blind::Untimely)) {
            return false;
        }
        if !(in_time && is_later) {
            self.blind = Some(Blind::Stamps);
        } else if same >= SAME_IMAGES {
            self.blind = Some(Blind::Frozen);
        } else if matches!(self.blind, Some(Blind::NoImages | Blind::Frozen)) && same == 0 {
            self.blind = None;
        }
        same == 0 && self.blind.is_none_or(|why| why == Blind::Covered)
    }

    fn see(&mut self, shot: &Shot) -> Option<Suspicion> {
        match self.watch.see(shot, &self.history, &self.head) {
            Sight::Nothing | Sight::Lost(SpotLost::OutOfSight(_)) => None,
            Sight::Seen(sighting) => {
                self.lost = 0;
                self.hold_against(&sighting)
            }
            Sight::Lost(why) => {
                if self.lost == 0 {
                    self.lost_since_s = self.now_s;
                }
                self.lost += 1;
                let long = self.lost >= LOST_IMAGES && self.now_s - self.lost_since_s >= LOST_S;
                (long && self.blind.is_none()).then_some(Suspicion::Lost(why))
            }
        }
    }

    fn hold_against(&mut self, sighting: &Sighting) -> Option<Suspicion> {
        let (from_s, until_s) = sighting.time_s(&self.watch.timing);
        let spot = sighting.spot(&self.history, &self.watch.timing)?;
        let late_s = self.trim.late_s(spot.down);
        let taken_s = 0.5 * (from_s + until_s) + late_s;
        self.trim.age((taken_s - self.aged_s).max(0.0));
        self.aged_s = self.aged_s.max(taken_s);
        let surprise = self.trim.surprise(&spot)?;
        let off_m = surprise.off.hypot();
        let is_off = off_m > SUSPECT_M && surprise.deviations > SUSPECT_DEVIATIONS;
        // what stands out of the noise of a covered lens is no spot
        if is_off && self.blind.is_some() {
            return None;
        }
        let place = |time_s: f64| (time_s / TICK_F64_S).round() as i64 - i64::from(self.first_tick);
        let within = |time_s: f64| place(time_s).clamp(0, self.asked.len() as i64 - 1) as usize;
        let ticks = &self.asked[within(from_s + late_s)..=within(until_s + late_s)];
        let asked: Option<Vec<Point>> = ticks.iter().map(|(asked, _)| *asked).collect();
        if let Some(asked) = asked.filter(|asked| !asked.is_empty()) {
            let sum = asked.iter().fold(Point::ORIGIN.to_vec2(), |sum, at| sum + at.to_vec2());
            let mean = (sum / asked.len() as f64).to_point();
            self.marks.push(SeenMark { time_s: taken_s, seen: spot.at, asked: mean });
        }
        if is_off {
            return Some(Suspicion::Off(off_m));
        }
        self.good_plan_tick = ticks.first().map(|(_, plan_tick)| *plan_tick);
        self.blind = None;
        self.trim.learn(&spot);
        None
    }
}
