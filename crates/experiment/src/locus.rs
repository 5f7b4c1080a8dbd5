//! Where the poles of the closed loop go as the open loop's gain rises.

mod view;

use tracelight_linear::{Complex, DampedGains, RootLocus};
use tracelight_task::{Failure, Task};

use crate::finding::Experiment;
use crate::numbers::four;
use crate::plane::Plane;
use crate::systems::{Named, bounded};

/// Open loops whose gain rises.
#[derive(Clone, Debug)]
pub struct Request {
    /// The loops, and how much of the plane is shown.
    pub plane: Plane,
    /// Which closed poles are marked.
    pub marked: Marked,
    /// How many gains at least.
    pub points: u32,
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
    /// The gain whose poles are marked, and those.
    gain: f64,
    closed: Vec<Complex>,
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
            entries.push(self.entry(named)?);
        }
        Ok(Finding { of: self, entries })
    }
}

impl Request {
    fn entry(&self, named: Named) -> Result<Entry, Failure> {
        let gain = match self.marked {
            Marked::Gain(gain) => gain,
            Marked::Damping(damping) => damped_gain(&named, damping)?,
        };
        let locus = named.system.root_locus(named.system.locus_gains(self.points as usize));
        let closed = named.system.closed_at(gain).root_values();
        Ok(Entry { named, locus, gain, closed })
    }
}

fn damped_gain(named: &Named, damping: f64) -> Result<f64, Failure> {
    let name = &named.name;
    let message = match named.system.damped_gains(damping) {
        DampedGains::UpTo(gain) => return Ok(gain),
        DampedGains::None => {
            format!("{name}: no factor leaves every closed pole with a damping of {damping}")
        }
        DampedGains::Beyond(from) => format!(
            "{name}: every factor above {} leaves every closed pole with a damping of {damping}, so there is no largest; choose one \
             with --gain",
            four(from)
        ),
    };
    Err(Failure::failed("no-such-gain", message))
}
