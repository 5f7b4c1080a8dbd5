//! A lap with somebody at the wall, who may pause, stop, hurry or slow it, and let it go on.

use tracelight_eye::power::{PowerWatch, check_homed, lost_power};
use tracelight_rig::Fault;
use tracelight_session::{Event, Job, Refused, Request, Session, Snapshot, State, seconds};
use tracelight_sim::{AFTERMATH_TICKS, Run, Simulated, SimulatedRig, Tick, job_of};
use tracelight_stroke::Place;
use tracelight_task::{Failure, Task};
use tracelight_trajectory::Plan;

use crate::keep::Keep;
use crate::lap::GOODBYE_TICKS;

/// Ticks at rest that are kept in memory; the log has all.
pub(crate) const REST_TICKS: u32 = 500;

/// What somebody at the wall asks for.
#[derive(Clone, Debug, PartialEq)]
pub enum Ask {
    /// Of the session.
    Request(Request),
    /// Another stroke, where strokes are drawn one at a time.
    Step(Step),
}

/// Which stroke comes next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// This one is done, and the one after it comes.
    Next,
    /// The one before it.
    Previous,
    /// This one is left as it is, and the one after it comes.
    Skip,
    /// The one of that number, from 0.
    To(u32),
}

/// Somebody at the wall while a lap runs.
pub trait Hands {
    /// Told after each tick, and may wait, so that a simulated rig keeps real time. Returns what is asked, if anything is.
    fn tick(&mut self, now: &Snapshot) -> Option<Ask>;

    /// Told what happened.
    fn event(&mut self, event: &Event);

    /// Told why a request was refused.
    fn refused(&mut self, why: &Refused);

    /// Told that a stroke or a point was left, by its number from 0, and whether it is done.
    fn left(&mut self, _number: u32, _done: bool) {}

    /// Told that the head sets off to a point, by its number from 0 of so many.
    fn goes_to(&mut self, _point: &Place, _number: u32, _of: u32) {}

    /// Whether anything may still be asked; otherwise a lap that is stopped, or that a fault ended, is over.
    fn is_there(&self) -> bool;
}

/// A lap, and what became of it.
pub(crate) struct LapByHand {
    pub(crate) run: Run,
    /// Why it ended if its rig lost power.
    pub(crate) failure: Option<Failure>,
    /// Pauses and other speeds.
    pub(crate) notes: Vec<String>,
}

/// One lap, every tick kept as it happens. Whatever ends it darkens first.
pub(crate) fn run_lap_by_hand(
    rig: &mut SimulatedRig,
    plan: &Plan,
    dry: bool,
    (keep, hands): (&mut dyn Keep, &mut dyn Hands),
    task: Task<'_>,
) -> Result<LapByHand, Failure> {
    let mut lap = Lap { plan, task, run: Run::default(), rests: 0, diary: Diary::default() };
    let ended = drive(rig, job_of(plan, dry), &mut lap, (keep, hands), task)?;
    Ok(LapByHand { run: lap.run, failure: ended.failure, notes: lap.diary.notes })
}

/// What a session does with somebody at the wall, and what is kept of it.
pub(crate) trait Course {
    /// Keeps a tick; `laps` is how often a job that is done again and again had been done before it.
    fn keep(&mut self, keep: &mut dyn Keep, tick: Tick, now: &Snapshot, laps: u32) -> Result<(), Failure>;

    /// Sees what happened; false where nobody needs to be told.
    fn see(&mut self, event: &Event, now: &Snapshot) -> bool;

    /// Does what is asked.
    fn ask(
        &mut self,
        ask: Ask,
        wall: &mut Session<&mut SimulatedRig>,
        hands: &mut dyn Hands,
        task: Task<'_>,
    ) -> Result<(), Refused>;

    /// Whether nothing is to come any more.
    fn is_over(&self) -> bool {
        false
    }
}

/// How a session ended.
pub(crate) struct Ended {
    /// Why, if its rig lost power.
    pub(crate) failure: Option<Failure>,
    /// The fault that is latched.
    pub(crate) fault: Option<Fault>,
    pub(crate) state: State,
}

/// Arms a rig for a job, as who calls for it has done both acts, and lets it run to its end, or to where nobody is there to go on with it. Whatever ends it darkens
/// first.
pub(crate) fn drive(
    rig: &mut SimulatedRig,
    job: Job,
    course: &mut dyn Course,
    (keep, hands): (&mut dyn Keep, &mut dyn Hands),
    task: Task<'_>,
) -> Result<Ended, Failure> {
    let wall = &mut Session::new(rig);
    let first = step(wall)?;
    check_homed(&first.telemetry)?;
    course.keep(keep, first, &wall.snapshot(), 0)?;
    begin(wall, job).map_err(|why| Failure::failed("session", why.to_string()))?;
    let mut power = PowerWatch::default();
    let (mut goodbye, mut aftermath) = (GOODBYE_TICKS, AFTERMATH_TICKS);
    while !course.is_over() && wall.state() != State::Done && goodbye > 0 && aftermath > 0 {
        // the tick in which a lap ends belongs to that one
        let laps = wall.snapshot().laps;
        let tick = step(wall)?;
        if power.is_lost(&tick.telemetry) {
            return Ok(Ended { failure: Some(lost_power()), fault: None, state: wall.state() });
        }
        let now = wall.snapshot();
        if let Err(why) = course.keep(keep, tick, &now, laps) {
            darken(wall)?;
            return Err(why);
        }
        while let Some(event) = wall.event() {
            if course.see(&event, &now) {
                hands.event(&event);
            }
        }
        let ended = matches!(now.state, State::Fault | State::Stopped | State::Ready);
        aftermath -= u32::from(ended && !hands.is_there());
        if task.stop.is_wanted() {
            let _ = wall.request(Request::Stop);
            goodbye -= 1;
        } else if let Some(ask) = hands.tick(&now)
            && let Err(why) = course.ask(ask, wall, hands, task)
        {
            hands.refused(&why);
        }
    }
    if wall.told().actuation.lights() {
        let laps = wall.snapshot().laps;
        let tick = darken(wall)?;
        course.keep(keep, tick, &wall.snapshot(), laps)?;
    }
    Ok(Ended { failure: None, fault: wall.told().fault, state: wall.state() })
}

fn step(wall: &mut Session<&mut SimulatedRig>) -> Result<Tick, Failure> {
    wall.tick_by(|rig| Some(rig.step()), |tick| &tick.telemetry).ok_or_else(lost_power)
}

fn darken(wall: &mut Session<&mut SimulatedRig>) -> Result<Tick, Failure> {
    let _ = wall.request(Request::Stop);
    step(wall)
}

fn begin(wall: &mut Session<&mut SimulatedRig>, job: Job) -> Result<(), Refused> {
    if !job.dry {
        wall.request(Request::Arm)?;
    }
    wall.request(Request::Trace(job))
}

struct Lap<'a> {
    plan: &'a Plan,
    task: Task<'a>,
    run: Run,
    /// Ticks since it rests.
    rests: u32,
    diary: Diary,
}

impl Course for Lap<'_> {
    fn keep(&mut self, keep: &mut dyn Keep, tick: Tick, now: &Snapshot, _: u32) -> Result<(), Failure> {
        keep.tick(self.plan, &tick)?;
        let is_resting =
            matches!(now.state, State::Paused | State::Stopped | State::Armed | State::Fault) && !tick.light;
        self.rests = if is_resting { self.rests.saturating_add(1) } else { 0 };
        if self.rests <= REST_TICKS {
            self.run.ticks.push(tick);
        }
        self.diary.watch(now);
        if tick.telemetry.tick.is_multiple_of(256) {
            self.task.at(u64::from(tick.telemetry.plan_tick));
        }
        Ok(())
    }

    fn see(&mut self, event: &Event, now: &Snapshot) -> bool {
        self.diary.write(event, now);
        true
    }

    fn ask(
        &mut self,
        ask: Ask,
        wall: &mut Session<&mut SimulatedRig>,
        _: &mut dyn Hands,
        _: Task<'_>,
    ) -> Result<(), Refused> {
        match ask {
            Ask::Request(request) => wall.request(request),
            // strokes come one after the other by themselves
            Ask::Step(_) => Ok(()),
        }
    }
}

/// What somebody at the wall did, as sentences for the report.
#[derive(Default)]
struct Diary {
    notes: Vec<String>,
    /// When the job came to rest, s, and how.
    rests: Option<(f64, String)>,
    speed: Option<f32>,
}

impl Diary {
    /// Writes down another speed than the last one.
    fn watch(&mut self, now: &Snapshot) {
        let before = self.speed.replace(now.speed).unwrap_or(1.0);
        if before != now.speed {
            let percent = 100.0 * now.speed;
            self.notes
                .push(format!("from {:.1} s on at {percent:.0} % of the planned speed", seconds(now.tick)));
        }
    }

    fn write(&mut self, event: &Event, now: &Snapshot) {
        let &Event::State { tick, to, .. } = event else { return };
        let how = match to {
            State::Paused => "paused",
            State::Stopped => "stopped",
            _ => "",
        };
        let at_s = seconds(tick);
        if !how.is_empty() && self.rests.is_none() {
            let stroke = now.stroke.map_or(now.strokes, |stroke| stroke + 1);
            self.rests =
                Some((at_s, format!("{how} after {at_s:.1} s at stroke {stroke} of {}", now.strokes)));
        } else if to == State::Tracing
            && let Some((since_s, how)) = self.rests.take()
        {
            self.notes.push(format!("{how}, for {:.1} s", at_s - since_s));
        }
    }
}
