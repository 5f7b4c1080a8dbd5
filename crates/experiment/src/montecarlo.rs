//! The same drawn on many heads that differ: how exact it is on the middle one, on 95 of 100, on the worst.

mod view;

use std::ops::ControlFlow;

use tracelight_lab::{LAPS_WORTH, identify};
use tracelight_pipeline::Driving;
use tracelight_rig::{Fault, Phase, Telemetry};
use tracelight_sim::{LawName, RigConfig, Run, SimulatedRig, Spread, Tracking, score};
use tracelight_task::{Failure, Task, on_all_cores};
use tracelight_trajectory::Plan;

use crate::finding::Experiment;
use crate::numbers::why_unfinished;
use crate::shape::Shape;

/// A shape, and how many heads draw it.
#[derive(Clone, Debug)]
pub struct Request {
    /// What is drawn.
    pub shape: Shape,
    /// By what, and how; the heads differ from its rig.
    pub driving: Driving,
    /// How many heads.
    pub plants: u32,
    /// Laps each of them draws, identified between them; the figures are the last lap's.
    pub laps: u32,
    /// Of the first head; the next have the seeds after it.
    pub seed: u64,
}

/// What became of the heads.
pub struct Finding {
    shape: String,
    /// What the heads are like.
    rig: String,
    law: LawName,
    laps: u32,
    /// Of the first head.
    seed: u64,
    trials: Vec<Trial>,
}

/// What became of one head.
#[derive(Clone, Copy, Debug)]
struct Trial {
    finished: bool,
    fault: Option<Fault>,
    /// Ticks in which it had left its stroke, or had to show that its encoders follow its motors once it had lit something.
    late_ticks: usize,
    tracking: Tracking,
}

impl Experiment for Request {
    type Finding = Finding;

    /// Every head, on all cores; what comes out does not depend on how many there are.
    fn run(self, task: Task<'_>) -> Result<Finding, Failure> {
        let Self { shape, driving, plants, laps, seed } = self;
        let name = shape.name().to_owned();
        let plan = shape.on_target()?.plan(&driving)?;
        task.stage("heads", u64::from(plants));
        let work = |number: usize| trial(&driving, &plan, laps, seed + number as u64);
        let trials = on_all_cores(plants as usize, task, work);
        task.check()?;
        let (rig, law) = (driving.rig.name, driving.rig.control.law);
        Ok(Finding { shape: name, rig, law, laps, seed, trials })
    }
}

fn trial(driving: &Driving, plan: &Plan, laps: u32, seed: u64) -> Trial {
    let head = Spread::USUAL.draw(&driving.rig, seed);
    let draw = |rig: &RigConfig| {
        let mut simulated = SimulatedRig::new(rig, driving.pose, seed);
        tracelight_sim::run(&mut simulated, plan, false, |_, _| ControlFlow::Continue(()))
    };
    let mut run = draw(&head);
    let mut records: Vec<Vec<Telemetry>> = Vec::new();
    for _ in 1..laps {
        records.push(run.telemetry());
        if records.len() > LAPS_WORTH {
            records.remove(0);
        }
        // a head that shows too little goes on as it is believed to be
        let rig = identify(&head, &records).map_or_else(|_| head.clone(), |found| found.rig);
        run = draw(&rig);
    }
    Trial {
        finished: run.is_done(),
        fault: run.fault(),
        late_ticks: held_ticks(&run),
        tracking: score(plan, &run, plan.set_speed_m_s),
    }
}

/// Ticks in which a head that has lit something held its plan's clock, and was dark.
fn held_ticks(run: &Run) -> usize {
    let lit = run.ticks.iter().skip_while(|tick| !tick.telemetry.actuation.lights());
    lit.filter(|tick| matches!(tick.telemetry.phase, Phase::Holding | Phase::Testing)).count()
}

impl Finding {
    /// What to say of heads that did not finish; none if all did.
    #[must_use]
    pub fn unfinished(&self) -> Option<Failure> {
        let missing = self.trials.len() - self.finished().count();
        let mut names: Vec<&str> = self
            .trials
            .iter()
            .filter(|trial| !trial.finished)
            .map(|trial| why_unfinished(trial.fault))
            .collect();
        names.sort_unstable();
        names.dedup();
        let message = format!(
            "{missing} of {} heads did not finish ({}); their errors are not in the figures",
            self.trials.len(),
            names.join(", ")
        );
        (missing > 0).then(|| Failure::failed("unfinished", message))
    }

    /// Those that drew all of it: the others have no error to speak of.
    fn finished(&self) -> impl Iterator<Item = &Trial> {
        self.trials.iter().filter(|trial| trial.finished)
    }

    /// How many of these left their stroke and came back.
    fn held(&self) -> usize {
        self.finished().filter(|trial| trial.late_ticks > 0).count()
    }
}
