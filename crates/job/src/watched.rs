//! A run that a camera follows: what is slowly off is trimmed under way; what is suddenly off ends the light, is looked into, and the job goes
//! on from where the light was last seen to be right.

use tracelight_aim::Correction;
use tracelight_eye::figures::{FollowFigures, SeenOff, TrimFigures};
use tracelight_eye::follow::{Blind, Follower, Suspicion};
use tracelight_eye::painted::Painted;
use tracelight_eye::power::{PowerWatch, lost_power};
use tracelight_eye::seen::{SeenLight, SeenMark};
use tracelight_eye::trim::Trimmer;
use tracelight_eye::trouble::TroubleAt;
use tracelight_pipeline::Driving;
use tracelight_rig::{Fault, PanTilt, TICK_F64_S, Telemetry};
use tracelight_rigfile::camera::KnownCamera;
use tracelight_session::{Request, Session};
use tracelight_sim::{Room, Run, Tick, tick, tick_trimmed};
use tracelight_stroke::Drawing;
use tracelight_task::{Failure, Stop, Task};
use tracelight_trajectory::Plan;

use crate::diary::Diary;
use crate::hands::{Hands, Sighting};
use crate::keep::{Keep, REST_TICKS as KEPT_TICKS};
use crate::remainder::{join, left};
use crate::seen::Seen;

/// What is to be run.
pub(crate) struct WatchedJob<'a> {
    pub(crate) plan: &'a Plan,
    /// The strokes it draws, in its order.
    pub(crate) drawing: &'a Drawing,
    pub(crate) driving: &'a Driving,
    pub(crate) seen: &'a Seen,
    /// The gate is held dark.
    pub(crate) dry: bool,
}

/// What came of it.
pub(crate) struct WatchedRun {
    pub(crate) run: Run,
    /// What was run in the end: the plan as far as it was followed, and those that took its place.
    pub(crate) plan: Plan,
    pub(crate) figures: FollowFigures,
    pub(crate) seen: SeenLight,
    /// Pauses and other speeds.
    pub(crate) notes: Vec<String>,
    /// Why it ended before its time, if the user did not end it.
    pub(crate) failure: Option<Failure>,
}

/// Ticks in which a head comes to rest in the dark, and images that show its light have arrived.
pub(crate) const REST_TICKS: u32 = 300;
/// Furthest that an encoder may have jumped for its head to be looked for by dots, rad: what is further off draws them who knows where.
const MOST_JUMP_RAD: f64 = 0.06;

/// Most times that a job is begun anew after something was suddenly off.
pub(crate) const MOST_RECOVERIES: usize = 6;

/// Why a stretch of a run ended.
pub(crate) enum Ended {
    Done,
    Fault(Fault),
    Suspect(Suspicion),
    Stopped,
    GivenUp,
}

/// What is to be looked into once somebody who holds the job lets it go on.
#[derive(Clone, Copy)]
pub(crate) enum Due {
    Fault(Fault),
    Suspicion(Suspicion),
}

/// A camera that looks into what is off, while somebody may stand at the wall.
#[derive(Default)]
pub(crate) struct Looking {
    /// Whether it does.
    pub(crate) on: bool,
    /// Set once that is to end: whoever stands there stopped it, or the whole job is over.
    pub(crate) stop: Stop,
    /// Speed of the plan's clock that is asked for; meanwhile it is the plan's own.
    pub(crate) speed: f32,
}

/// Why a head must be found again.
pub(crate) struct Why {
    pub(crate) words: String,
    /// A camera saw its spot elsewhere.
    pub(crate) seen_off: bool,
}

/// A run under way.
pub(crate) struct Watched<'a> {
    pub(crate) job: &'a WatchedJob<'a>,
    pub(crate) session: Session<Room>,
    /// Trims the plan that is followed; `None` while there is none.
    pub(crate) trimmer: Option<Trimmer>,
    /// Number of the first stroke of that plan.
    pub(crate) first: u32,
    /// Who stands at the wall.
    pub(crate) hands: &'a mut dyn Hands,
    pub(crate) diary: Diary,
    pub(crate) looking: Looking,
    /// Somebody has paused or stopped it, or a fault has, and nobody has let it go on.
    pub(crate) held: bool,
    pub(crate) due: Option<Due>,
    /// Who holds the job, or stopped the camera's look, has armed since, and wants it to go on where it cannot by itself.
    pub(crate) goes_on: bool,
    /// Tick of the rig, as long as that had power.
    pub(crate) now: u32,
    /// Ticks since it rests.
    rests: u32,
    pub(crate) follower: Follower,
    pub(crate) driving: Driving,
    pub(crate) wall: KnownCamera,
    pub(crate) run: Run,
    /// All that is planned, one after the other.
    pub(crate) joined: Plan,
    /// Where in it the plan that is followed now begins, and where its clock stands.
    pub(crate) base: u32,
    pub(crate) plan_tick: u32,
    pub(crate) troubles: Vec<TroubleAt>,
    pub(crate) blind: Option<Blind>,
    /// A dot is drawn.
    pub(crate) dots: bool,
    pub(crate) figures: FollowFigures,
    pub(crate) keep: &'a mut dyn Keep,
    pub(crate) failed: Option<Failure>,
    /// Tick at which was told last what the camera has seen, and how many images that were.
    seen_told: (u32, usize),
    pub(crate) power: PowerWatch,
    /// The rig lost power.
    pub(crate) unpowered: bool,
    pub(crate) task: Task<'a>,
}

/// Runs a plan, watched.
pub(crate) fn run_watched<'a>(
    job: &'a WatchedJob<'a>,
    room: Room,
    (keep, hands): (&'a mut dyn Keep, &'a mut dyn Hands),
    task: Task<'a>,
) -> Result<WatchedRun, Failure> {
    let painted = Painted::new(&job.seen.image, job.seen.followed.camera);
    let mut watched = Watched {
        job,
        session: Session::new(room),
        trimmer: None,
        first: 0,
        hands,
        diary: Diary::default(),
        looking: Looking::default(),
        held: false,
        due: None,
        goes_on: false,
        now: 0,
        rests: 0,
        follower: Follower::new(&job.seen.followed, Some(painted)),
        driving: job.driving.clone(),
        wall: job.seen.wall.clone(),
        run: Run::default(),
        joined: job.plan.clone(),
        base: 0,
        plan_tick: 0,
        troubles: job.seen.troubles.clone(),
        blind: None,
        dots: false,
        figures: FollowFigures { closed: !job.seen.open, ..FollowFigures::default() },
        keep,
        failed: None,
        seen_told: (0, 0),
        power: PowerWatch::default(),
        unpowered: false,
        task,
    };
    watched.step();
    if job.driving.rig.drive.kind.is_open_loop() {
        watched.await_darkness();
    }
    watched.await_hands();
    // what was drawn until then is told whatever became of it
    let failure = watched.all(job.plan.clone(), job.drawing.clone()).err();
    watched.look(false);
    watched.darken();
    let failure = watched.power_lost().or(failure);
    watched.failed.take().map_or(Ok(()), Err)?;
    watched.tell();
    let fault = watched.session.told().latched.map(Failure::fault);
    watched.diary.end(&watched.session.snapshot());
    let Watched { run, joined, figures, follower, diary, .. } = watched;
    let painting = follower.watch.painted.as_ref().and_then(Painted::picture);
    let seen = SeenLight { marks: follower.marks, painting };
    Ok(WatchedRun { run, plan: joined, figures, seen, notes: diary.notes, failure: failure.or(fault) })
}

impl Watched<'_> {
    /// Runs a drawing, and what is left of it whenever something was suddenly off.
    fn all(&mut self, mut plan: Plan, mut drawing: Drawing) -> Result<(), Failure> {
        loop {
            let Some((why, first, left)) = self.one(&plan, &drawing)? else { return Ok(()) };
            let next = self.looked(|watched| watched.found_again(&why, &left))?;
            self.first += first;
            self.base = join(&mut self.joined, self.plan_tick, &next, self.first);
            self.plan_tick = self.base;
            self.task.stage("run", self.joined.points.len() as u64);
            (plan, drawing) = (next, left);
        }
    }

    /// Follows a plan to its end, or to where the head is to be found again: then why, and what is left with the number of its first stroke.
    fn one(&mut self, plan: &Plan, drawing: &Drawing) -> Result<Option<(Why, u32, Drawing)>, Failure> {
        loop {
            let suspicion = match self.follow(plan)? {
                Ended::Fault(fault) => {
                    let why = Why { words: format!("fault {}", fault.code()), seen_off: false };
                    return Ok(left(plan, drawing, self.rewound()).map(|(first, left)| (why, first, left)));
                }
                Ended::Done | Ended::Stopped | Ended::GivenUp => return Ok(None),
                Ended::Suspect(suspicion) => suspicion,
            };
            let Some(why) = self.looked(|watched| watched.look_after(suspicion))? else { continue };
            // what was all but finished is finished
            if let Some((first, left)) = left(plan, drawing, self.rewound()) {
                return Ok(Some((why, first, left)));
            }
        }
    }

    /// Waits until the camera has seen the wall in the dark. A head with encoders needs no less time to see that they follow its motors; one without
    /// is lit at once.
    fn await_darkness(&mut self) {
        const MOST_TICKS: u32 = 1000;
        for _ in 0..MOST_TICKS {
            if self.follower.watch.is_ready() || self.is_over() {
                return;
            }
            self.step();
        }
    }

    /// Has the camera look into what is off, until it has, however often somebody stops that on its way and has it go on. It looks on until a plan is
    /// followed again.
    fn looked<T>(&mut self, mut look: impl FnMut(&mut Self) -> Result<T, Failure>) -> Result<T, Failure> {
        self.look(true);
        loop {
            let found = look(self);
            // its images were for somebody else
            self.follower.hear_again();
            if !self.is_to_look_again() {
                return found;
            }
        }
    }

    pub(crate) fn can_recover(&self) -> bool {
        let may_look = self.follower.blind().is_none() && !self.job.seen.open && !self.job.dry;
        may_look && self.figures.recoveries.len() < MOST_RECOVERIES && self.jumped_rad() < MOST_JUMP_RAD
    }

    /// How far an encoder was from where its joint was believed a tick before, when the fault came, rad.
    fn jumped_rad(&self) -> f64 {
        let count_rad = self.driving.rig.model.encoder.count_rad();
        let ticks = &self.run.ticks;
        let Some(sound) = ticks.iter().rposition(|tick| tick.telemetry.fault().is_none()) else { return 0.0 };
        let (before, now) = (&ticks[sound].telemetry, &ticks[(sound + 1).min(ticks.len() - 1)].telemetry);
        let off = PanTilt::from_fn(|j| {
            let count = now.measured[j].count.wrapping_add(now.lost_counts[j]);
            f64::from(count) * count_rad - f64::from(before.position_rad[j])
        });
        off.pan.abs().max(off.tilt.abs())
    }

    /// Whether the user, a log that can not be written, or a rig without power ends the run.
    pub(crate) fn is_over(&self) -> bool {
        self.is_ended() || self.looking.stop.is_wanted()
    }

    /// Likewise, but for what somebody at the wall may let go on.
    pub(crate) fn is_ended(&self) -> bool {
        self.task.stop.is_wanted() || self.failed.is_some() || self.unpowered
    }

    /// Where the present plan's clock stood when the light was last seen to be right; where it begins, if it never was.
    fn rewound(&self) -> u32 {
        let good = self.follower.good_plan_tick().filter(|tick| *tick >= self.base);
        good.map_or(0, |tick| tick - self.base).min(self.plan_tick - self.base)
    }

    /// One tick, watched and kept.
    pub(crate) fn step(&mut self) -> (Tick, Option<Suspicion>) {
        let mut tick = match &mut self.trimmer {
            Some(trimmer) => tick_trimmed(&mut self.session, trimmer),
            None => tick(&mut self.session),
        };
        if !self.has_power(&tick) {
            return (tick, None);
        }
        self.place(&mut tick);
        self.strike(&tick);
        let suspicion = self.follower.tick(self.session.rig_mut(), &tick);
        self.tell_blindness();
        self.tell_sight();
        self.log(&tick);
        if tick.telemetry.tick.is_multiple_of(256) {
            self.task.at(u64::from(tick.telemetry.plan_tick));
        }
        // a dot is not the drawing's
        let keeps = !self.dots || !tick.light;
        let waits = !self.looking.on || self.looking.stop.is_wanted();
        let rests = waits && !self.session.state().is_on() && !tick.light;
        self.rests = if rests { self.rests.saturating_add(1) } else { 0 };
        if keeps && self.rests <= KEPT_TICKS {
            self.run.ticks.push(tick);
        }
        self.listen();
        (tick, suspicion)
    }

    /// Tells whoever stands at the wall what the camera has seen since he was told last.
    fn tell_sight(&mut self) {
        /// How often, ticks; and of how many images an error is the mean.
        const EACH: u32 = 200;
        const LAST: usize = 25;
        let (marks, (told, count)) = (&self.follower.marks, self.seen_told);
        let Some(mark) = marks.last().filter(|_| marks.len() > count && self.now >= told + EACH) else {
            return;
        };
        let last = &marks[marks.len().saturating_sub(LAST)..];
        let sum: f64 = last.iter().map(|mark| mark.seen.distance_squared(mark.asked)).sum();
        let rms_m = (sum / last.len() as f64).sqrt();
        let sighting = Sighting { seen: mark.seen, asked: mark.asked, rms_m, images: marks.len() };
        self.seen_told = (self.now, marks.len());
        self.hands.sees(&sighting);
    }

    /// Whether the rig still has power at a tick; its ticks, counts and clock are others once it lost it.
    pub(crate) fn has_power(&mut self, tick: &Tick) -> bool {
        self.unpowered |= self.power.is_lost(&tick.telemetry);
        if !self.unpowered {
            self.now = tick.telemetry.tick;
        }
        !self.unpowered
    }

    /// Logs a tick. Whether it could be: otherwise that ends the run.
    pub(crate) fn log(&mut self, tick: &Tick) -> bool {
        let logged = self.keep.tick(&self.joined, tick);
        let is_logged = logged.is_ok();
        self.failed = self.failed.take().or(logged.err());
        is_logged
    }

    /// Tells of a rig that lost power since it drew.
    fn power_lost(&mut self) -> Option<Failure> {
        self.unpowered.then(|| {
            self.remark("the rig lost power: it is dark, and does not know where its head points; light that was still on its way out is not in these figures".to_owned());
            lost_power()
        })
    }

    /// Tells a tick where the plan wanted the spot, before it was trimmed, and where in all that is planned its clock stands.
    fn place(&mut self, tick: &mut Tick) {
        let Telemetry { plan_tick, setpoint, .. } = &mut tick.telemetry;
        let angle = match &self.trimmer {
            Some(trimmer) => {
                self.plan_tick = self.base + *plan_tick;
                trimmer.untrimmed(*plan_tick, setpoint)
            }
            None => self.follower.correction().apply(setpoint.map(|s| f64::from(s.position_rad))),
        };
        tick.asked = self.driving.machine.geometry.spot(&self.driving.pose, angle);
        *plan_tick = self.plan_tick;
    }

    /// Lets happen what is to go wrong now.
    fn strike(&mut self, tick: &Tick) {
        let now_s = f64::from(tick.telemetry.plan_tick) * TICK_F64_S;
        let left_s = self.joined.duration_s() - now_s;
        let Self { troubles, session, .. } = self;
        troubles.retain(|trouble| !trouble.strike(session.rig_mut(), (now_s, left_s), tick.light));
    }

    /// The figures of what was seen.
    fn tell(&mut self) {
        for trouble in std::mem::take(&mut self.troubles) {
            self.remark(format!("{trouble} did not happen: the job was over, or nothing was lit"));
        }
        let off: Vec<f64> = self.follower.marks.iter().map(SeenMark::off_mm).collect();
        let Correction { offset_rad, scale } = self.follower.correction();
        let figures = &mut self.figures;
        figures.spots = off.len();
        figures.lost_images += self.follower.watch.lost;
        figures.off_mm = SeenOff::of(off);
        figures.trim = TrimFigures {
            pan_mrad: 1e3 * offset_rad.pan,
            tilt_mrad: 1e3 * offset_rad.tilt,
            pan_scale_percent: 100.0 * scale.pan,
            tilt_scale_percent: 100.0 * scale.tilt,
        };
    }

    pub(crate) fn tell_blindness(&mut self) {
        let blind = self.follower.blind();
        if blind == std::mem::replace(&mut self.blind, blind) {
            return;
        }
        let remark = match blind {
            Some(why) if self.driving.rig.drive.kind.is_open_loop() => {
                format!("{}; the job goes on, and nobody watches where its light falls", why.words())
            }
            Some(why) => format!("{}; the job goes on by its encoders", why.words()),
            None => "the camera sees again".to_owned(),
        };
        self.remark(remark);
    }

    pub(crate) fn remark(&mut self, remark: String) {
        self.remark_of(self.now_s(), &remark);
    }

    /// Likewise of something that was then, s.
    pub(crate) fn remark_of(&mut self, t_s: f64, remark: &str) {
        let remark = format!("after {t_s:.1} s: {remark}");
        self.task.say(&format!("note: {remark}"));
        self.figures.remarks.push(remark);
    }

    /// Nobody leaves a gate open.
    fn darken(&mut self) {
        let _ = self.session.request(Request::Stop);
        if self.session.told().actuation.lights() {
            self.step();
        }
    }

    /// So many ticks in which nothing new is sent.
    pub(crate) fn rest(&mut self, ticks: u32) {
        for _ in 0..ticks {
            self.step();
        }
    }
}

/// Whether a fault is one after which a head only needs to be found again.
pub(crate) const fn may_be_found_again(fault: Fault) -> bool {
    matches!(
        fault,
        Fault::EncoderJumped
            | Fault::EncoderSlipping
            | Fault::EncoderNoisy
            | Fault::EncoderDead
            | Fault::EstimateDiverged
            | Fault::Bumped
    )
}
