use tracelight_rig::Joint;

/// Why friction cannot be told.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FrictionError {
    /// The joint did not turn, or hardly.
    #[error(
        "{joint} turned in {turned} of {trials} trials, and at least {least} in one direction are needed, each above {speed_rad_s} \
         rad/s for {time_s} s: give more volts, in smaller steps"
    )]
    TooFew {
        /// Which.
        joint: Joint,
        /// Trials in which it did.
        turned: usize,
        /// All trials.
        trials: usize,
        /// Fewest.
        least: usize,
        /// Speed that is worth something.
        speed_rad_s: f64,
        /// For so long.
        time_s: f64,
    },
    /// No joint has such an inertia.
    #[error(
        "{joint}: its inertia would be {inertia_kg_m2:e} kg m², which no joint has: its volts and counts may have opposite signs, or the \
         rig file's torque per volt is wrong"
    )]
    Impossible {
        /// Which.
        joint: Joint,
        /// kg m².
        inertia_kg_m2: f64,
    },
    /// What was seen does not tell inertia, friction and weight apart.
    #[error(
        "{joint}: all its trials are alike, so friction and speed cannot be told apart: give other volts"
    )]
    Alike {
        /// Which.
        joint: Joint,
    },
}
