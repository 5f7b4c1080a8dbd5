//! What a job is run by.

use tracelight_sim::Observed;

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

    /// The one that is given, or that one.
    pub(crate) fn or<'b>(
        &'b mut self,
        simulated: &'b mut (dyn Observed + 'b),
    ) -> &'b mut (dyn Observed + 'b) {
        match self {
            Self::Simulated => simulated,
            Self::Given(rig) => &mut **rig,
        }
    }
}
