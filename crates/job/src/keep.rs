//! Who keeps what happens.

use tracelight_session::State;
use tracelight_sim::Tick;
use tracelight_task::Failure;
use tracelight_trajectory::Plan;

use crate::points::PointDone;

/// Ticks at rest that are kept in memory; the log has all.
pub(crate) const REST_TICKS: u32 = 500;

/// Which ticks are kept in memory: of those before a job begins the last, none on the way to another stroke, and of each rest so many.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Memory {
    /// It has begun.
    begun: bool,
    /// Ticks since it rests.
    rests: u32,
}

impl Memory {
    /// Keeps one more tick, of a session in that state, or does not.
    pub(crate) fn keep(&mut self, ticks: &mut Vec<Tick>, tick: Tick, state: State) {
        self.begun |= state.is_on();
        if !self.begun {
            ticks.clear();
            ticks.push(tick);
            return;
        }
        let rests = !state.is_on() && !tick.light;
        self.rests = if rests { self.rests.saturating_add(1) } else { 0 };
        if state != State::Parking && self.rests <= REST_TICKS {
            ticks.push(tick);
        }
    }
}

/// Told of every tick of a run as it happens: a log, a page, an array.
pub trait Keep {
    /// One more tick, and the plan that it follows.
    ///
    /// # Errors
    /// Why it cannot be kept: then the run ends, as nothing that was measured may be lost.
    fn tick(&mut self, plan: &Plan, tick: &Tick) -> Result<(), Failure>;

    /// One more tick that is not of the job itself, such as of its frame, and the plan that it follows.
    ///
    /// # Errors
    /// As of [`tick`](Self::tick).
    fn aside(&mut self, plan: &Plan, tick: &Tick) -> Result<(), Failure> {
        self.tick(plan, tick)
    }

    /// A point was ticked off: all of them, as they stand now.
    ///
    /// # Errors
    /// As of [`tick`](Self::tick).
    fn points(&mut self, points: &[PointDone]) -> Result<(), Failure> {
        let _ = points;
        Ok(())
    }
}

/// Nobody: who wants the run alone finds it in [`Ran`](crate::Ran).
#[derive(Clone, Copy, Debug, Default)]
pub struct KeepNothing;

impl Keep for KeepNothing {
    fn tick(&mut self, _: &Plan, _: &Tick) -> Result<(), Failure> {
        Ok(())
    }
}
