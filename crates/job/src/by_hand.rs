//! A lap with somebody at the wall, who may pause, stop, hurry or slow it, and let it go on.

use tracelight_eye::power::{PowerWatch, check_homed, lost_power};
use tracelight_session::{Event, Refused, Request, Session, Snapshot, State, seconds};
use tracelight_sim::{AFTERMATH_TICKS, Run, Simulated, SimulatedRig, Tick, job_of};
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

    /// Told that a stroke was left, by its number from 0, and whether it is done.
    fn left(&mut self, _stroke: u32, _done: bool) {}

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
    let mut wall = Session::new(rig);
    let first = step(&mut wall)?;
    check_homed(&first.telemetry)?;
    keep.tick(plan, &first)?;
    let begun = begin(&mut wall, plan, dry);
    begun.map_err(|why| Failure::failed("session", why.to_string()))?;
    let mut lap = Lap { run: Run { ticks: vec![first] }, rests: 0, diary: Diary::default() };
    let mut power = PowerWatch::default();
    let (mut goodbye, mut aftermath) = (GOODBYE_TICKS, AFTERMATH_TICKS);
    while wall.state() != State::Done && goodbye > 0 && aftermath > 0 {
        let tick = step(&mut wall)?;
        if power.is_lost(&tick.telemetry) {
            return Ok(lap.ended(Some(lost_power())));
        }
        if let Err(why) = keep.tick(plan, &tick) {
            darken(&mut wall)?;
            return Err(why);
        }
        lap.push(tick, wall.state());
        lap.diary.watch(&wall.snapshot());
        while let Some(event) = wall.event() {
            lap.diary.write(&event, &wall.snapshot());
            hands.event(&event);
        }
        if tick.telemetry.tick.is_multiple_of(256) {
            task.at(u64::from(tick.telemetry.plan_tick));
        }
        let ended = matches!(wall.state(), State::Fault | State::Stopped | State::Ready);
        aftermath -= u32::from(ended && !hands.is_there());
        if task.stop.is_wanted() {
            let _ = wall.request(Request::Stop);
            goodbye -= 1;
        } else if let Some(Ask::Request(request)) = hands.tick(&wall.snapshot())
            && let Err(why) = wall.request(request)
        {
            hands.refused(&why);
        }
    }
    if wall.told().actuation.lights() {
        let tick = darken(&mut wall)?;
        keep.tick(plan, &tick)?;
        lap.push(tick, wall.state());
    }
    Ok(lap.ended(None))
}

pub(crate) fn step(wall: &mut Session<&mut SimulatedRig>) -> Result<Tick, Failure> {
    wall.tick_by(|rig| Some(rig.step()), |tick| &tick.telemetry).ok_or_else(lost_power)
}

pub(crate) fn darken(wall: &mut Session<&mut SimulatedRig>) -> Result<Tick, Failure> {
    let _ = wall.request(Request::Stop);
    step(wall)
}

/// Arms and traces: who calls for a lap has done both acts.
fn begin(wall: &mut Session<&mut SimulatedRig>, plan: &Plan, dry: bool) -> Result<(), Refused> {
    if !dry {
        wall.request(Request::Arm)?;
    }
    wall.request(Request::Trace(job_of(plan, dry)))
}

struct Lap {
    run: Run,
    /// Ticks since it rests.
    rests: u32,
    diary: Diary,
}

impl Lap {
    fn push(&mut self, tick: Tick, state: State) {
        let is_resting =
            matches!(state, State::Paused | State::Stopped | State::Armed | State::Fault) && !tick.light;
        self.rests = if is_resting { self.rests.saturating_add(1) } else { 0 };
        if self.rests <= REST_TICKS {
            self.run.ticks.push(tick);
        }
    }

    fn ended(self, failure: Option<Failure>) -> LapByHand {
        LapByHand { run: self.run, failure, notes: self.diary.notes }
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
