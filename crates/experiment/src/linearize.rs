//! The head near a pose as a linear system: state space, transfer functions, poles.

mod view;

use tracelight_lab::Linearization;
use tracelight_linear::{Complex, LinearError, StateSpace, TransferFunction};
use tracelight_rig::{Joint, PanTilt};
use tracelight_task::{Failure, Task};

use crate::finding::Experiment;
use crate::head::{Head, HeadChoice};

/// The head that is linearized.
#[derive(Clone, Debug)]
pub struct Request(pub HeadChoice);

/// Its linear system.
pub struct Finding {
    head: Head,
    linear: Linearization,
    both: PanTilt<Own>,
}

/// A joint's transfer function and what was left out of it.
struct Own {
    transfer: TransferFunction,
    cancelled: Vec<Complex>,
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        let head = self.0.head();
        let linear = head.linearize()?;
        let own = |joint| own(&linear, joint, self.0.keep_cancellations);
        let failed = |e: LinearError| Failure::failed("no-linear-model", e);
        let both = PanTilt::new(own(Joint::Pan).map_err(failed)?, own(Joint::Tilt).map_err(failed)?);
        Ok(Finding { head, linear, both })
    }
}

impl Finding {
    /// Angles of pan and tilt from their torques.
    #[must_use]
    pub const fn system(&self) -> &StateSpace {
        &self.linear.system
    }
}

fn own(linear: &Linearization, joint: Joint, keep: bool) -> Result<Own, LinearError> {
    if keep {
        return Ok(Own { transfer: linear.transfer(joint)?, cancelled: Vec::new() });
    }
    let (transfer, cancelled) = linear.own_transfer(joint)?;
    Ok(Own { transfer, cancelled })
}
