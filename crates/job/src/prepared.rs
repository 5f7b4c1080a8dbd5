//! A job from request to run.

use tracelight_eye::figures::EyeFigures;
use tracelight_eye::room::{Furnished, left};
use tracelight_eye::seen::SeenLight;
use tracelight_picture::{Raster, Source};
use tracelight_pipeline::{
    Before, Check, Driving, Placed, Schedule, Sketch, place, preflight, schedule, schedule_as_it_is,
    schedule_rest, schedule_whole, sketch,
};
use tracelight_rig::{Joint, PanTilt};
use tracelight_sim::{LightFrom, Observed as _, Origin, RigConfig, Run, SimulatedRig, slowest_speed};
use tracelight_stroke::Drawing;
use tracelight_task::{Failure, Stop, Task, counted};
use tracelight_trajectory::Plan;

use crate::frame::frame_of;
use crate::hands::{Hands, Nobody};
use crate::head::Head;
use crate::keep::Keep;
use crate::lap::{RanLap, run_lap};
use crate::learned::{Learned, learn};
use crate::looped::{Item, Looped};
use crate::points::PointDone;
use crate::remainder;
use crate::request::{Request, RunRequest};
use crate::seen::Seen;
use crate::steps::{StepRun, run_steps};
use crate::watched::{WatchedJob, WatchedRun, run_watched};

/// What the stages before the run made.
pub struct Prepared {
    /// The strokes on their sheet, and the picture.
    pub sketch: Sketch,
    /// The strokes on the target.
    pub placed: Placed,
    /// The rig, as it is believed to be and to stand.
    pub driving: Driving,
    /// The strokes in order, and in time.
    pub schedule: Schedule,
    /// Remarks for the user.
    pub notes: Vec<String>,
    /// From pixels to strokes, ms.
    pub vision_ms: f64,
    /// From strokes to a plan, ms.
    pub plan_ms: f64,
    how: RunRequest,
    seen: Option<Seen>,
    /// Number of the first stroke, or point, that is left of the drawing, from 0.
    first: u32,
}

/// A job that was run.
pub struct Ran {
    /// Laps before the last.
    pub earlier: Vec<Run>,
    /// The last one.
    pub last: Run,
    /// What the last one came to follow, where that is not what was planned.
    plan: Option<Plan>,
    /// The rig as it was identified between laps, if it was.
    pub identified: Option<RigConfig>,
    /// What a camera saw of it, in figures.
    pub eye: Option<EyeFigures>,
    /// What a camera saw of its spot.
    pub seen: Option<SeenLight>,
    /// Remarks for the user, those of before the run first.
    pub notes: Vec<String>,
    /// Why it ended early: a rig's fault, lost power, or because the user wanted it.
    pub failure: Option<Failure>,
    /// The points that it was to mark, where it was to mark points, and when each was ticked off.
    pub points: Vec<PointDone>,
    /// Whether it did all that it was to do.
    pub finished: bool,
    /// Where what is told of it comes from: whatever shows results says so.
    pub origin: Origin,
    /// How long all laps took to run, ms.
    pub run_ms: f64,
}

impl Ran {
    /// What the last lap followed.
    #[must_use]
    pub fn plan<'a>(&'a self, prepared: &'a Prepared) -> &'a Plan {
        self.plan.as_ref().unwrap_or(&prepared.schedule.plan)
    }
}

/// A picture or a drawing → strokes → target → order → plan.
///
/// # Errors
/// Why there is nothing to be drawn, or no way to draw it.
pub fn prepare(request: &Request<'_>, source: Source, task: Task<'_>) -> Result<Prepared, Failure> {
    let Request { name, tracing, placing, driving, run } = request;
    task.stage("strokes", 1);
    let (sketch, vision_ms) = task.timed(|| sketch(name, source, tracing, placing));
    let sketch = sketch?;
    task.check()?;
    let placed = place(&sketch, placing)?;
    planned((sketch.shown(), vision_ms), placed, driving.clone(), (*run, None), task)
}

/// A drawing on the target, in order and in time.
pub(crate) fn planned(
    (sketch, vision_ms): (Sketch, f64),
    placed: Placed,
    driving: Driving,
    (how, seen): (RunRequest, Option<Seen>),
    task: Task<'_>,
) -> Result<Prepared, Failure> {
    task.stage("plan", 1);
    let (schedule, plan_ms) = task.timed(|| schedule(&placed, &driving));
    let schedule = schedule?;
    task.check()?;
    let notes: Vec<String> = sketch
        .notes()
        .into_iter()
        .chain(placed.notes.iter().cloned())
        .chain(schedule.notes.iter().cloned())
        .chain(driving.remarks(&schedule.plan))
        .collect();
    notes.iter().for_each(|n| task.say(&format!("note: {n}")));
    check_laps(how.laps, &schedule.plan)?;
    // before anything is written of a run that cannot begin
    frame_of(placed.frame.as_ref(), &driving, how.dry)?;
    Ok(Prepared { sketch, placed, driving, schedule, notes, vision_ms, plan_ms, how, seen, first: 0 })
}

/// Longest run of all laps together, s: every tick is kept for the results, at some 200 bytes.
const LONGEST_S: f64 = 1800.0;

/// Refuses more laps than can be kept.
fn check_laps(laps: u32, plan: &Plan) -> Result<(), Failure> {
    let needed_s = f64::from(laps) * plan.duration_s();
    if needed_s <= LONGEST_S {
        return Ok(());
    }
    let message = format!(
        "--laps {laps} would take {needed_s:.0} s together, at most {LONGEST_S:.0} s are run at once"
    );
    Err(Failure::failed("too-long", message))
}

impl Prepared {
    /// The image of the wall in which the figure was found, if a camera saw it.
    #[must_use]
    pub fn camera_image(&self) -> Option<&Raster> {
        self.seen.as_ref().map(|seen| &seen.image)
    }

    /// What to look at before any light, on a day such as 2026-11-23.
    #[must_use]
    pub fn preflight(&self, today: &str) -> Vec<Check> {
        let before = Before { homed: !self.how.powered_up, today };
        preflight(&self.placed, &self.driving, &self.schedule.plan, before)
    }

    /// The simulated room that a camera looks at while the laser draws.
    fn watched(&self) -> Option<(&Seen, &Furnished)> {
        self.seen.as_ref().and_then(|seen| Some((seen, seen.room.as_ref()?)))
    }

    /// A job without the strokes, or points, before that one, from 1, in the order in which they are drawn.
    ///
    /// # Errors
    /// `usage` where it has not so many.
    pub fn from_stroke(mut self, number: u32) -> Result<Self, Failure> {
        let strokes = &self.schedule.ordered.drawing.strokes;
        let points = self.placed.points.len();
        if number <= 1 {
            return Ok(self);
        }
        let (all, of_one, word) = match points {
            0 => (strokes.len(), 1, "stroke"),
            points => (points, strokes.len() / points, "point"),
        };
        if number as usize > all {
            let message = format!("--from-stroke {number}: the drawing has {}", counted(all, word));
            return Err(Failure::usage("usage", message));
        }
        let before = number as usize - 1;
        let rest = Drawing { strokes: strokes[before * of_one..].to_vec() };
        self.placed.points.drain(..before.min(points));
        // a mark is so many strokes
        let schedule = if points > 0 { schedule_as_it_is } else { schedule_whole };
        self.schedule = schedule(rest, &self.driving)?;
        self.first = number - 1;
        Ok(self)
    }

    /// What is left of a job that was drawn up to a tick of its plan, to be begun from zero; `None` where nothing is. Less than half a
    /// millimetre of a stroke is not worth a way there.
    ///
    /// # Errors
    /// Why there is no plan for it.
    pub fn after(self, plan_tick: u32) -> Result<Option<Self>, Failure> {
        let Some((_, rest)) = remainder::left(&self.schedule.plan, &self.schedule.ordered.drawing, plan_tick)
        else {
            return Ok(None);
        };
        let schedule = schedule_rest(rest, &self.driving)?;
        Ok(Some(Self { schedule, ..self }))
    }

    /// Runs the laps, each from power-up on the same head, and has every tick kept. Between two of them the head is identified from
    /// those before, and the controller is told.
    ///
    /// # Errors
    /// Where a tick cannot be kept, or the head was never homed. What ends a lap early is no error: see [`Ran::failure`].
    pub fn run(&self, keep: &mut dyn Keep, task: Task<'_>) -> Result<Ran, Failure> {
        self.run_by_hand(Head::Simulated, (keep, &mut Nobody), task)
    }

    /// Runs the laps, or the only one of a given head, with somebody at the wall, who may pause and stop each of them, and let it go on.
    ///
    /// # Errors
    /// As of [`run`](Self::run).
    pub fn run_by_hand(
        &self,
        head: Head<'_>,
        (keep, hands): (&mut dyn Keep, &mut dyn Hands),
        task: Task<'_>,
    ) -> Result<Ran, Failure> {
        let (laps, run_ms) = task.timed(|| self.run_laps(head, (keep, hands), task));
        let Laps { earlier, last, learned, watched, failure, origin } = laps?;
        learned.notes.iter().for_each(|note| task.say(&format!("note: {note}")));
        let follow = watched.as_ref().map(|watched| watched.figures.clone());
        let eye = self.seen.as_ref().map(|seen| seen.after(&last, follow));
        let words = eye.iter().flat_map(EyeFigures::words);
        let known = known_by(origin, &self.driving);
        let notes = self.notes.iter().chain(&learned.notes).cloned().chain(words).chain(known).collect();
        let failure = failure.or_else(|| ending(&last, task.stop));
        let identified = learned.taken.then_some(learned.rig);
        let (plan, seen) = watched.map(|watched| (watched.plan, watched.seen)).unzip();
        let finished = last.is_done();
        let points = Vec::new();
        Ok(Ran {
            earlier,
            last,
            plan,
            identified,
            eye,
            seen,
            notes,
            failure,
            points,
            finished,
            origin,
            run_ms,
        })
    }

    /// Makes it a job that is gone through one stroke, or point, at a time; `pace_m_s` is the speed of the spot, where it is to be another one. What is looked
    /// at before any light then has that speed.
    ///
    /// # Errors
    /// `standing-light` where the first one is so short, or the pace so slow, that light would stand.
    pub fn by_steps(mut self, pace_m_s: Option<f64>) -> Result<Self, Failure> {
        let dry = self.how.dry;
        let Self { driving, schedule, placed, first, .. } = &mut self;
        if let Some(pace_m_s) = pace_m_s {
            driving.request.speed_m_s = pace_m_s;
            // one that cannot be drawn so is left out on the way; the rest stays as it was planned
            if let Ok(paced) = schedule_as_it_is(schedule.ordered.drawing.clone(), driving) {
                schedule.plan = paced.plan;
            }
        }
        let items = Item::all(&schedule.ordered.drawing, &placed.points, *first);
        items.first().map(|item| Looped::of(item, items.len() as u32, driving, dry)).transpose()?;
        Ok(self)
    }

    /// Goes through the strokes, or the marks of points, one at a time with somebody at the wall: each is drawn again and again, there and back where it is open,
    /// until another one is asked for.
    ///
    /// # Errors
    /// As of [`run`](Self::run) and [`by_steps`](Self::by_steps).
    pub fn run_steps(
        mut self,
        mut head: Head<'_>,
        (keep, hands): (&mut dyn Keep, &mut dyn Hands),
        task: Task<'_>,
    ) -> Result<(Self, Ran), Failure> {
        let dry = self.how.dry;
        let mut simulated = None;
        let rig = head.or(&mut simulated, || self.put_up(&self.driving.rig));
        let origin = rig.origin();
        let Self { driving, schedule, placed, first, .. } = &mut self;
        task.stage("run", 1);
        let items = Item::all(&schedule.ordered.drawing, &placed.points, *first);
        let frame = frame_of(placed.frame.as_ref(), driving, dry)?;
        let whole = (items.as_slice(), &*driving);
        let how = (frame.as_ref(), dry);
        let (ran, run_ms) = task.timed(|| run_steps(rig, whole, how, (keep, hands), task));
        let StepRun { run, plan, drawing, failure, fault, finished, points, notes } = ran?;
        let fault = fault.map(Failure::fault);
        let unfinished = || {
            let stopped = task.stop.is_wanted();
            let word = if points.is_empty() { "strokes" } else { "points" };
            let message = format!("it was ended before all {word} had their turn");
            let why = if stopped { Failure::interrupted() } else { Failure::failed("unfinished", message) };
            (!finished).then_some(why)
        };
        let failure = failure.or(fault).or_else(unfinished);
        let known = known_by(origin, &self.driving);
        let notes: Vec<String> = self.notes.iter().cloned().chain(notes).chain(known).collect();
        (self.schedule.ordered.drawing, self.schedule.plan) = (drawing, plan);
        let ran = Ran {
            earlier: Vec::new(),
            last: run,
            plan: None,
            identified: None,
            eye: None,
            seen: None,
            notes,
            failure,
            points,
            finished,
            origin,
            run_ms,
        };
        Ok((self, ran))
    }

    /// A simulated head, as it is believed to be.
    fn put_up(&self, believed: &RigConfig) -> SimulatedRig {
        let RunRequest { seed, powered_up, .. } = self.how;
        let put_up = if powered_up { left } else { SimulatedRig::new };
        put_up(believed, self.driving.pose, seed)
    }

    fn run_laps(
        &self,
        mut head: Head<'_>,
        (keep, hands): (&mut dyn Keep, &mut dyn Hands),
        task: Task<'_>,
    ) -> Result<Laps, Failure> {
        // one that is given would have to be told what was identified
        let wanted = if head.is_given() { 1 } else { self.how.laps };
        let mut laps: Vec<Run> = Vec::new();
        // what happened in them
        let mut told: Vec<String> = Vec::new();
        let mut learned = Learned { rig: self.driving.rig.clone(), taken: false, notes: Vec::new() };
        if wanted > 1 && self.driving.rig.drive.kind.is_open_loop() {
            let note =
                "nothing is identified between laps: a head without encoders does not show what it does";
            learned.notes.push(note.to_owned());
        }
        let (mut watched, mut failure, mut origin) = (None, None, Origin::SIMULATION);
        while laps.len() < wanted as usize && !task.stop.is_wanted() && failure.is_none() {
            if !laps.is_empty() && !self.driving.rig.drive.kind.is_open_loop() {
                task.stage("identify", 1);
                learned = learn(&self.driving.rig, &laps);
            }
            task.stage("run", self.schedule.plan.points.len() as u64);
            let Some(looks) = self.watched() else {
                // before the first one
                let framed = laps.is_empty();
                let done = self.unwatched_lap(&mut head, (&learned.rig, framed), (keep, hands), task)?;
                told.extend(done.0.notes);
                laps.push(done.0.run);
                (failure, origin) = (done.0.failure, done.1);
                continue;
            };
            let mut done = self.watched_lap(looks, &learned.rig, (keep, hands), task)?;
            told.append(&mut done.notes);
            laps.push(std::mem::take(&mut done.run));
            failure = done.failure.take();
            watched = Some(done);
        }
        learned.notes.append(&mut told);
        let last = laps.pop().unwrap_or_default();
        Ok(Laps { earlier: laps, last, learned, watched, failure, origin })
    }

    /// One lap that no camera follows, after the frame if there is to be one, of a rig that is believed to be this; and where what is told of it comes from.
    fn unwatched_lap(
        &self,
        head: &mut Head<'_>,
        (believed, framed): (&RigConfig, bool),
        (keep, hands): (&mut dyn Keep, &mut dyn Hands),
        task: Task<'_>,
    ) -> Result<(RanLap, Origin), Failure> {
        let dry = self.how.dry;
        let frame = self.placed.frame.as_ref().filter(|_| framed);
        let frame = frame_of(frame, &self.driving, dry)?;
        let drawn = (&self.schedule.plan, frame.as_ref());
        let mut simulated = None;
        let rig = head.or(&mut simulated, || self.put_up(believed));
        let origin = rig.origin();
        // nobody slows it who is not there
        let may_slow = hands.is_there() && !dry;
        let slowest = if may_slow { slowest_speed(believed, &self.schedule.plan) } else { 0.0 };
        let mut done = run_lap(rig, drawn, (dry, slowest), (keep, hands), task)?;
        let lost = simulated.map(|rig| rig.lost_steps());
        done.notes.extend(lost.and_then(|lost| lost_note(believed, self.driving.pose.distance_m, lost)));
        Ok((done, origin))
    }

    /// One lap that a camera follows, of a rig that is believed to be this.
    fn watched_lap(
        &self,
        (seen, room): (&Seen, &Furnished),
        believed: &RigConfig,
        (keep, hands): (&mut dyn Keep, &mut dyn Hands),
        task: Task<'_>,
    ) -> Result<WatchedRun, Failure> {
        let mut driving = self.driving.clone();
        driving.rig = believed.clone();
        let job = WatchedJob {
            plan: &self.schedule.plan,
            drawing: &self.schedule.ordered.drawing,
            driving: &driving,
            seen,
            dry: self.how.dry,
        };
        run_watched(&job, room.watched(believed, driving.pose), (keep, hands), task)
    }
}

/// What to say of figures of a spot that nobody saw.
fn known_by(origin: Origin, driving: &Driving) -> Option<String> {
    (origin.light_from != LightFrom::Simulation).then(|| {
        format!(
            "nobody saw the light. Where the spot was is what {} say, on a target {:.3} m from a head that is built as the rig {} says; a beam, bearings or a stand that \
             are off are in none of these figures",
            if origin.light_from == LightFrom::Commands { "the commands" } else { "the encoders" },
            driving.pose.distance_m,
            driving.rig.name
        )
    })
}

/// What to say of a lap after which stepper motors are behind their pulses.
fn lost_note(rig: &RigConfig, distance_m: f64, lost: PanTilt<i64>) -> Option<String> {
    let of = |j: Joint| {
        let (steps, name) = (lost[j], j.name());
        let off_mm = 1e3 * distance_m * steps.unsigned_abs() as f64 * rig.drive.stepper.full_step_rad();
        let way = if steps > 0 { "behind" } else { "ahead of" };
        (steps != 0).then(|| {
            format!(
                "{name} ends {} full steps {way} its pulses, {off_mm:.1} mm at {distance_m:.3} m",
                steps.unsigned_abs()
            )
        })
    };
    let told: Vec<String> = Joint::BOTH.into_iter().filter_map(of).collect();
    (!told.is_empty()).then(|| {
        format!(
            "steps were lost: {}. Only a simulation can tell; a real head goes on and knows nothing. Give the motors less to do (motion.torque_share, speeds, \
             accelerations), or look for what holds the joints",
            told.join("; ")
        )
    })
}

/// Every lap that was run.
struct Laps {
    earlier: Vec<Run>,
    last: Run,
    learned: Learned,
    /// What a camera saw of the last one, and the plan that it came to.
    watched: Option<WatchedRun>,
    /// Why the last one ended before its time, if the user did not end it.
    failure: Option<Failure>,
    origin: Origin,
}

/// Whether the last lap ended as it should.
fn ending(run: &Run, stop: &Stop) -> Option<Failure> {
    if let Some(record) = run.latched() {
        return Some(Failure::fault(record));
    }
    if stop.is_wanted() {
        return Some(Failure::interrupted());
    }
    (!run.is_done()).then(|| {
        let message = "the run was given up: the head left its stroke again and again, and the laser was dark most of \
                       the time. One encoder count is more on a target that is further away: step nearer \
                       (--distance), or allow more (control.tolerance in the rig file)";
        Failure::failed("unfinished", message)
    })
}
