//! Where the poles of the closed loop go as the open loop's gain rises.

mod figure;
mod view;

use tracelight_linear::{Breakaway, Complex, DampedGains, LocusCrossing, RootLocus, TransferFunction};
use tracelight_task::{Failure, Task};

use crate::finding::Experiment;
use crate::named::Named;
use crate::numbers::four;
use crate::plane::Plane;
use crate::systems::bounded;

/// Open loops whose gain rises.
#[derive(Clone, Debug)]
pub struct Request {
    /// The loops, and how much of the plane is shown.
    pub plane: Plane,
    /// Which closed poles are marked.
    pub marked: Marked,
    /// How many gains at least.
    pub points: u32,
    /// Whether a damping that no largest factor leaves is a failure; otherwise that is told, and the rest is found all the same.
    pub must_have_gain: bool,
}

/// The factor on the open loop whose closed poles are marked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Marked {
    /// This one.
    Gain(f64),
    /// The largest that leaves every closed pole at least so damped, 0 to 1.
    Damping(f64),
}

/// Where each loop's poles go.
pub struct Finding {
    of: Request,
    entries: Vec<Entry>,
}

/// A loop and where its poles go.
struct Entry {
    named: Named,
    locus: RootLocus,
    chosen: Chosen,
    crossings: Vec<LocusCrossing>,
    breakaways: Vec<Breakaway>,
}

/// The gain whose closed poles are marked.
enum Chosen {
    /// This one, with its closed poles.
    Gain(f64, Vec<Complex>),
    /// There is none, and why.
    None(String),
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, task: Task<'_>) -> Result<Finding, Failure> {
        let systems = self.plane.systems.systems()?;
        let order =
            |named: &Named| named.system.denominator().degree().max(named.system.numerator().degree());
        bounded(self.points, systems.iter().map(order).sum())?;
        let mut entries = Vec::new();
        for named in systems {
            task.check()?;
            let entry = self.entry(named);
            if let (true, Chosen::None(why)) = (self.must_have_gain, &entry.chosen) {
                return Err(Failure::failed("no-such-gain", format!("{}: {why}", entry.named.name)));
            }
            entries.push(entry);
        }
        Ok(Finding { of: self, entries })
    }
}

impl Request {
    fn entry(&self, named: Named) -> Entry {
        let system = &named.system;
        let gain = match self.marked {
            Marked::Gain(gain) => Ok(gain),
            Marked::Damping(damping) => damped_gain(system, damping),
        };
        let chosen = match gain {
            Ok(gain) => Chosen::Gain(gain, system.closed_at(gain).root_values()),
            Err(why) => Chosen::None(why),
        };
        Entry {
            locus: system.root_locus(system.telling_gains(self.points as usize)),
            crossings: system.locus_crossings(),
            breakaways: system.breakaways(),
            chosen,
            named,
        }
    }
}

/// The gain that leaves a damping, or why there is none.
fn damped_gain(system: &TransferFunction, damping: f64) -> Result<f64, String> {
    match system.damped_gains(damping) {
        DampedGains::UpTo(gain) => Ok(gain),
        DampedGains::None => Err(format!("no factor leaves every closed pole with a damping of {damping}")),
        DampedGains::Beyond(from) => Err(format!(
            "every factor above {} leaves every closed pole with a damping of {damping}, so there is no largest; choose one with --gain",
            four(from)
        )),
    }
}
