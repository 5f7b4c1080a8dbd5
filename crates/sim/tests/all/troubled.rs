//! Runs in which something goes wrong at a moment, and what their light did.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use tracelight_rig::Fault;
use tracelight_sim::{RigConfig, Run, SimulatedRig, Tick, Trouble, run};
use tracelight_trajectory::Plan;

use crate::shapes::{POSE, circle, house, lit_ticks, plan_of, plan_of_all, star};

/// Light further off its point than that is wrong, mm.
pub(crate) const WRONG_MM: f64 = 3.0;

/// How a run went.
pub(crate) struct Outcome {
    /// Whether it ended as if nothing were.
    pub(crate) finished: bool,
    pub(crate) fault: Option<Fault>,
    /// Light off its point at most, mm; infinite where it missed the wall.
    pub(crate) furthest_mm: f64,
    /// Ticks of wrong light.
    pub(crate) wrong_ticks: usize,
    /// The most of them without a gap.
    pub(crate) longest_ticks: usize,
}

impl Outcome {
    fn of(ran: &Run) -> Self {
        let off = |t: &Tick| match (t.spot, t.asked) {
            (Some(spot), Some(asked)) => 1e3 * spot.distance(asked),
            _ => f64::INFINITY,
        };
        let is_wrong = |t: &Tick| t.light && off(t) > WRONG_MM;
        Self {
            finished: ran.is_done(),
            fault: ran.fault(),
            furthest_mm: ran.ticks.iter().filter(|t| t.light).map(off).fold(0.0, f64::max),
            wrong_ticks: ran.ticks.iter().filter(|t| is_wrong(t)).count(),
            longest_ticks: ran.ticks.split(|t| !is_wrong(t)).map(<[Tick]>::len).max().unwrap_or(0),
        }
    }
}

/// A run that something happens to once, where its plan's clock reads `when`.
pub(crate) fn run_with(config: &RigConfig, plan: &Plan, seed: u64, when: u32, trouble: Trouble) -> Outcome {
    let mut rig = SimulatedRig::new(config, POSE, seed);
    let mut troubled = false;
    let ran = run(&mut rig, plan, false, |rig, tick| {
        if !troubled && tick.telemetry.plan_tick >= when {
            troubled = true;
            rig.suffer(trouble);
        }
        ControlFlow::Continue(())
    });
    Outcome::of(&ran)
}

/// A circle, a house and a star.
pub(crate) fn three_plans(config: &RigConfig) -> [Plan; 3] {
    [plan_of(config, circle(0.2)), plan_of_all(config, house()), plan_of(config, star(0.2))]
}

/// Of many runs.
#[derive(Default)]
pub(crate) struct Tally {
    pub(crate) runs: usize,
    /// Those that ended as if nothing were,
    pub(crate) finished: usize,
    /// and those of them that had wrong light.
    pub(crate) unseen: usize,
    pub(crate) furthest_mm: f64,
    pub(crate) longest_ticks: usize,
    /// How often each fault ended one, by its name.
    faults: BTreeMap<String, usize>,
}

impl Tally {
    pub(crate) fn add(&mut self, one: &Outcome) {
        self.runs += 1;
        self.finished += usize::from(one.finished);
        self.unseen += usize::from(one.finished && one.wrong_ticks > 0);
        self.furthest_mm = self.furthest_mm.max(one.furthest_mm);
        self.longest_ticks = self.longest_ticks.max(one.longest_ticks);
        if let Some(fault) = one.fault {
            *self.faults.entry(format!("{fault:?}")).or_default() += 1;
        }
    }

    /// Of what happens at so many moments of each of three plans.
    pub(crate) fn of(config: &RigConfig, plans: &[Plan], moments: usize, trouble: Trouble) -> Self {
        let mut tally = Self::default();
        for plan in plans {
            let lit = lit_ticks(plan);
            for moment in 0..moments {
                let when = lit[lit.len() * moment / moments + 17] as u32;
                tally.add(&run_with(config, plan, moment as u64, when, trouble));
            }
        }
        tally
    }
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{} runs, {} ended as if nothing were, {} of them with light over {WRONG_MM} mm off; furthest {:.1} mm, longest {} ms; {:?}",
            self.runs, self.finished, self.unseen, self.furthest_mm, self.longest_ticks, self.faults
        )
    }
}
