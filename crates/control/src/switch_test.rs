//! Tests each of the laser's two switches alone, in the dark, before the first light.

use tracelight_rig::Sensed;

use crate::config::Config;
use crate::watch::LaserWatch;

/// Where a test of the laser's switches stands. It only says what they are to be told, and waits until they must have followed: the watch on
/// the laser looks at what is seen meanwhile, as it does at any time. So a gate's switch that does not close or open again and light that leaves
/// through one switch alone are faults, and a test that gets to its end has passed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum SwitchTest {
    /// Not begun: both are open, or soon will be.
    #[default]
    Waits,
    /// The gate's switch is told to close, the other to stay open.
    Gate,
    /// Both are told to be open.
    Open,
    /// The other switch is told to close, the gate's to stay open.
    Enable,
    /// Both do what they are told.
    Passed,
}

impl SwitchTest {
    /// Whether the switches were tried, or cannot be: of a rig that sees neither the gate's switch nor light nobody knows anything.
    pub(crate) fn is_over(self, sensed: &Sensed) -> bool {
        self == Self::Passed || (sensed.laser_on.is_none() && sensed.light.is_none())
    }

    /// One tick in which the test may go on; what both switches are told, the gate's first.
    pub(crate) fn tick(&mut self, config: &Config, watch: &LaserWatch) -> (bool, bool) {
        if watch.is_settled(config) {
            *self = match self {
                Self::Waits => Self::Gate,
                Self::Gate => Self::Open,
                Self::Open => Self::Enable,
                Self::Enable | Self::Passed => Self::Passed,
            };
        }
        (*self == Self::Gate, matches!(self, Self::Enable | Self::Passed))
    }

    /// One tick in which there may be no light for another reason: what is half tried is tried anew.
    pub(crate) fn pause(&mut self) {
        if *self != Self::Passed {
            *self = Self::Waits;
        }
    }
}
