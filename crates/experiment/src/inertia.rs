//! What each joint's inertia is, from how fast voltages speed it up.

mod view;

use tracelight_lab::{Curves, Uncertain};
use tracelight_sim::RigConfig;
use tracelight_task::{Failure, Task};

use crate::finding::{Experiment, Improved};
use crate::trials::{Seen, Subject, Trials};

/// What joints did under voltages, to tell their inertia from.
pub struct Request(pub Seen);

/// Inertia of each joint.
pub struct Finding {
    trials: Trials,
    /// What was taken for what in logs, a line each.
    said: Vec<String>,
    /// Each joint, and its inertia, kg m².
    joints: Vec<(Subject, Uncertain)>,
    better: RigConfig,
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        let Seen { of: trials, subjects, said } = self.0;
        let curves = subjects.iter().map(Subject::curves).collect::<Result<Vec<_>, Failure>>()?;
        let joints = subjects
            .into_iter()
            .zip(&curves)
            .map(|(subject, curves)| told(&subject, curves).map(|inertia| (subject, inertia)))
            .collect::<Result<Vec<_>, Failure>>()?;
        let mut better = trials.rig.clone();
        for (subject, inertia) in &joints {
            better.model.set_own_inertia(subject.joint, inertia.value);
        }
        Ok(Finding { trials, said, joints, better })
    }
}

fn told(subject: &Subject, curves: &Curves) -> Result<Uncertain, Failure> {
    curves.inertia_kg_m2.ok_or_else(|| {
        let message = format!(
            "{}: its speed hardly changes in what was seen, so nothing tells its inertia: give voltages that speed it up",
            subject.joint
        );
        Failure::failed("friction", message)
    })
}

impl Improved for Finding {
    fn rig(&self) -> &RigConfig {
        &self.trials.rig
    }

    // the rig with the inertia that was found: bodies keep theirs, the rotor gets the rest
    fn better(&self) -> &RigConfig {
        &self.better
    }
}
