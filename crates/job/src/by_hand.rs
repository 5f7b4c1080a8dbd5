//! A lap with somebody at the wall, who may pause, stop, hurry or slow it, and let it go on.

use tracelight_session::{Event, Refused, Session, Snapshot, State, seconds};
use tracelight_sim::{Run, SimulatedRig, Tick, job_of};
use tracelight_task::{Failure, Task};
use tracelight_trajectory::Plan;

use crate::course::Course;
use crate::frame::drive_framed;
use crate::hands::{Ask, Hands};
use crate::keep::Keep;
use crate::looped::Looped;

/// Ticks at rest that are kept in memory; the log has all.
pub(crate) const REST_TICKS: u32 = 500;

/// A lap, and what became of it.
pub(crate) struct LapByHand {
    pub(crate) run: Run,
    /// Why it ended if its rig lost power.
    pub(crate) failure: Option<Failure>,
    /// Pauses and other speeds.
    pub(crate) notes: Vec<String>,
}

/// One lap, after the frame where there is one, every tick kept as it happens. Whatever ends it darkens first.
pub(crate) fn run_lap_by_hand(
    rig: &mut SimulatedRig,
    (plan, frame): (&Plan, Option<&Looped>),
    dry: bool,
    (keep, hands): (&mut dyn Keep, &mut dyn Hands),
    task: Task<'_>,
) -> Result<LapByHand, Failure> {
    let mut lap = Lap { plan, task, run: Run::default(), rests: 0, diary: Diary::default() };
    let ended = drive_framed(rig, (job_of(plan, dry), &mut lap), frame, (keep, hands), task)?;
    Ok(LapByHand {
        run: lap.run,
        failure: ended.failure.or(ended.fault.map(Failure::fault)),
        notes: lap.diary.notes,
    })
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
