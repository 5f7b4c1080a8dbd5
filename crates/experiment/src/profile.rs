//! One joint moved from rest to rest, motors left out: durations and peaks of every profile.

mod view;

use tracelight_task::{Failure, Task};
use tracelight_trajectory::{MoveLimits, Profile, Ramps};

use crate::finding::Experiment;
use crate::profile_name::ProfileName;

/// A move, and profiles to plot of it.
#[derive(Clone, Debug)]
pub struct Request {
    /// How far, rad.
    pub distance_rad: f64,
    /// What it may do: rad/s, rad/s².
    pub limits: MoveLimits,
    /// The S-curve's ramps.
    pub ramps: Ramps,
    /// Which are plotted; the first of them is the one of the table.
    pub profiles: Vec<ProfileName>,
}

/// The move by every profile.
pub struct Finding {
    of: Request,
    /// By every profile that needs no motors.
    all: Vec<Move>,
    /// By those that were asked for, the first of them apart.
    first: Move,
    others: Vec<Move>,
}

/// A profile and the move by it.
type Move = (ProfileName, Profile);

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        let made = |name: ProfileName| {
            Some((name, Profile::new(name.shape(self.ramps)?, self.distance_rad, &self.limits)))
        };
        let all = ProfileName::ALL.into_iter().filter_map(made).collect();
        let chosen: Option<Vec<Move>> = self.profiles.iter().map(|&name| made(name)).collect();
        let mut chosen = chosen.unwrap_or_default().into_iter();
        let first = chosen.next().ok_or_else(no_optimum)?;
        let others = chosen.collect();
        Ok(Finding { of: self, all, first, others })
    }
}

/// Without motors there is nothing to be optimal about.
fn no_optimum() -> Failure {
    let message = "--profile optimal is as fast as the motors can, and this command knows none: under limits of speed and \
                   acceleration alone the trapezoid is the fastest. `tracelight lab move` has both";
    Failure::usage("usage", message)
}

impl Finding {
    /// Those that were asked for.
    fn chosen(&self) -> impl Iterator<Item = &Move> {
        std::iter::once(&self.first).chain(&self.others)
    }
}
