//! A run's ticks beside the points of the plan they follow.

use tracelight_rig::{Phase, TICK_F64_S};
use tracelight_sim::{Run, Tick};
use tracelight_stroke::Point;
use tracelight_trajectory::{Plan, PlanPoint};

/// A tick of the run beside the point of the plan it follows.
#[derive(Clone, Copy)]
pub(crate) struct Sample<'a> {
    /// Time since the rig's power-up, s.
    pub(crate) t_s: f64,
    /// What happened.
    pub(crate) tick: &'a Tick,
    /// What should have.
    pub(crate) planned: &'a PlanPoint,
}

impl<'a> Sample<'a> {
    /// Joins a tick with its point of the plan.
    pub(crate) fn new(tick: &'a Tick, planned: &'a PlanPoint) -> Self {
        Self { t_s: f64::from(tick.telemetry.tick) * TICK_F64_S, tick, planned }
    }

    /// Where the spot should be, m: as the controller was asked, which after a hold lies between two points of the plan.
    pub(crate) fn asked(&self) -> Point {
        self.tick.asked.unwrap_or(self.planned.spot)
    }

    /// Distance of the true spot from the planned one, mm; `None` when the beam misses the plane.
    pub(crate) fn error_mm(&self) -> Option<f64> {
        let asked = self.asked();
        self.tick.spot.map(|spot| spot.distance(asked) * 1e3)
    }

    /// Whether the plan's clock was running.
    pub(crate) fn is_tracing(&self) -> bool {
        self.tick.telemetry.phase == Phase::Tracing
    }
}

/// The point of the plan that a tick follows: its own, or the rest at the end. `None` for an empty plan.
#[must_use]
pub fn planned(plan: &Plan, plan_tick: u32) -> Option<&PlanPoint> {
    plan.points.get(plan_tick as usize).or(plan.points.last())
}

/// Every tick of a run with its point of the plan; none for an empty plan.
pub(crate) fn samples<'a>(plan: &'a Plan, run: &'a Run) -> impl Iterator<Item = Sample<'a>> + Clone {
    run.ticks
        .iter()
        .filter_map(|tick| planned(plan, tick.telemetry.plan_tick).map(|point| Sample::new(tick, point)))
}

/// How long light left the head, s.
pub(crate) fn lit_s(run: &Run) -> f64 {
    run.ticks.iter().filter(|t| t.light).count() as f64 * TICK_F64_S
}
