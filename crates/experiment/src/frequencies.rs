//! Frequencies over which systems are asked.

use tracelight_linear::logspace;
use tracelight_task::Failure;

use crate::systems::{Named, Systems, bounded};

/// Systems over frequencies.
#[derive(Clone, Debug)]
pub struct Frequencies {
    /// The systems.
    pub systems: Systems,
    /// From this one, rad/s; if not given, a decade below the slowest pole or zero.
    pub from_rad_s: Option<f64>,
    /// To this one, rad/s; if not given, a decade above the fastest.
    pub to_rad_s: Option<f64>,
    /// How many, evenly on a logarithmic scale.
    pub points: u32,
}

impl Frequencies {
    /// All systems, and frequencies for them together, rad/s.
    pub(crate) fn read(&self) -> Result<(Vec<Named>, Vec<f64>), Failure> {
        let systems = self.systems.systems()?;
        bounded(self.points, systems.len())?;
        let (low, high) = systems
            .iter()
            .map(|named| named.system.band())
            .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
            .unwrap_or((0.1, 10.0));
        // a bound that is typed moves the other, if that is not typed
        let (from, to) = match (self.from_rad_s, self.to_rad_s) {
            (Some(from), Some(to)) => (from, to),
            (Some(from), None) => {
                let end =
                    systems.iter().map(|n| n.system.time().nyquist_rad_s()).fold(f64::INFINITY, f64::min);
                (from, high.max(100.0 * from).min(end))
            }
            (None, Some(to)) => (low.min(to / 100.0), to),
            (None, None) => (low, high),
        };
        if from >= to {
            return Err(Failure::usage("usage", format!("--from {from} rad/s is not below --to {to} rad/s")));
        }
        Ok((systems, logspace((from, to), self.points as usize)))
    }
}
