//! What a job is run by.

use tracelight_sim::{Observed, SimulatedRig};

/// What a job is run by.
pub enum Head<'a> {
    /// Simulated heads, one for each lap.
    Simulated,
    /// This one, for a lap.
    Given(&'a mut (dyn Observed + 'a)),
}

impl Head<'_> {
    pub(crate) const fn is_given(&self) -> bool {
        matches!(self, Self::Given(_))
    }

    /// The one that is given, or one that is put up.
    pub(crate) fn or<'b>(
        &'b mut self,
        simulated: &'b mut Option<SimulatedRig>,
        put_up: impl FnOnce() -> SimulatedRig,
    ) -> &'b mut (dyn Observed + 'b) {
        match self {
            Self::Simulated => simulated.insert(put_up()),
            Self::Given(rig) => &mut **rig,
        }
    }
}
