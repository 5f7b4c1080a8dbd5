//! Poles and zeros in the complex plane.

mod view;

use tracelight_task::{Failure, Task};

use crate::finding::Experiment;
use crate::named::Named;
use crate::plane::Plane;

/// Systems, and how much of the plane is shown.
#[derive(Clone, Debug)]
pub struct Request(pub Plane);

/// The systems that the formulas are.
pub struct Finding {
    of: Plane,
    systems: Vec<Named>,
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        let systems = self.0.systems.systems()?;
        Ok(Finding { of: self.0, systems })
    }
}
