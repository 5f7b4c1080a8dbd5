//! A control engineer's bench: records in, numbers out.
//!
//! No file is read and no thread started here; what is measured comes as a record of a run, simulated or real.

mod identify;
mod linearize;
mod statistics;
mod step;
mod velocity;

pub use identify::{Identification, IdentifyError, JointFit, LAPS_WORTH, identify, routine};
pub use linearize::{Linearization, Operation};
pub use statistics::Quantiles;
pub use step::StepFigures;
pub use velocity::{Peaks, VelocityError, highest, peaks, peaks_seen, velocity_error};
