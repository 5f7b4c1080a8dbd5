//! A lap with somebody at the wall, who may pause, stop, hurry or slow it, and let it go on.

use tracelight_session::{Event, Refused, Session, Snapshot, State};
use tracelight_sim::{Run, SimulatedRig, Tick, job_of};
use tracelight_task::{Failure, Task};
use tracelight_trajectory::Plan;

use crate::course::Course;
use crate::diary::Diary;
use crate::frame::drive_framed;
use crate::hands::{Ask, Hands};
use crate::keep::{Keep, REST_TICKS};
use crate::looped::Looped;

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
