//! Who keeps what happens.

use tracelight_sim::Tick;
use tracelight_task::Failure;
use tracelight_trajectory::Plan;

use crate::points::PointDone;

/// Ticks at rest that are kept in memory; the log has all.
pub(crate) const REST_TICKS: u32 = 500;

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
