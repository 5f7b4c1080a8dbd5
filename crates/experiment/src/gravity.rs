//! What gravity does to tilt, from how voltages turn it against its weight.

mod view;

use tracelight_lab::{Curves, Uncertain};
use tracelight_rig::Joint;
use tracelight_sim::RigConfig;
use tracelight_task::{Failure, Task};

use crate::finding::{Experiment, Improved};
use crate::trials::{Seen, Subject, Trials};

/// What tilt did under voltages (see [`of_tilt`]), to tell its weight from.
pub struct Request(pub Seen);

/// What tilt weighs.
pub struct Finding {
    trials: Trials,
    /// What was taken for what in logs, a line each.
    said: Vec<String>,
    subject: Subject,
    curves: Curves,
    weight: Weight,
    better: RigConfig,
}

/// Weight with the beam level, and upright, and what cables pull.
struct Weight {
    nm: [Uncertain; 2],
    spring_nm_per_rad: Option<Uncertain>,
}

/// The trials of tilt alone, the head on its feet.
///
/// # Errors
/// `usage`: in a fixture gravity turns nothing; or pan alone was asked for.
pub fn of_tilt(trials: Trials) -> Result<Trials, Failure> {
    if trials.fixture {
        return Err(Failure::usage("usage", "in a --fixture gravity turns nothing: leave it out"));
    }
    trials.of_joint(Joint::Tilt)
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        let Seen { of: trials, subjects, said } = self.0;
        let subject = subjects
            .into_iter()
            .find(|subject| subject.joint == Joint::Tilt)
            .ok_or_else(|| Failure::usage("usage", "gravity turns tilt alone"))?;
        let curves = subject.curves()?;
        let nm =
            curves.gravity_nm.ok_or_else(|| Failure::failed("friction", "tilt: nothing tells its weight"))?;
        let weight = Weight { nm, spring_nm_per_rad: curves.spring_nm_per_rad };
        let mut better = trials.rig.clone();
        better.model.set_weight(weight.nm.map(|u| u.value));
        better.model.set_own_inertia(Joint::Tilt, subject.believed.inertia_kg_m2);
        Ok(Finding { trials, said, subject, curves, weight, better })
    }
}

impl Improved for Finding {
    fn rig(&self) -> &RigConfig {
        &self.trials.rig
    }

    // the rig with the weight that was found: what tilt carries is moved until it weighs so, its mass kept
    fn better(&self) -> &RigConfig {
        &self.better
    }
}
