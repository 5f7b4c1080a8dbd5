//! A control engineer's bench: records in, numbers out.
//!
//! No file is read and no thread started here; what is measured comes as a record of a run, simulated or real.

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")
)]

mod amplifier;
mod backlash;
mod eccentric;
mod encoder;
mod frequency;
mod friction;
mod identify;
mod lesson;
mod linearize;
mod regression;
mod relay;
mod standing;
mod start;
mod statistics;
mod step;
mod tune;
mod velocity;

pub use amplifier::{Amplifier, CurrentPoint, amplifier};
pub use backlash::{Backlash, SpotPoint, backlash};
pub use encoder::{EdgeTime, EncoderTable, Lost, Spin, encoder_table, spin};
pub use frequency::{
    Excitation, Excited, FrequencyPoint, Multisine, excite, frequency_response, frequency_response_of_speeds,
};
pub use friction::{
    Believed, Curves, FrictionError, Line, Part, Plateau, Protocol, Sample, Shuttle, Side, Steady,
    SteadyPoint, Travel, Trial, curves, free_trial, plateau, replayed, saturated, steady, steady_of,
};
pub use identify::{Identification, IdentifyError, JointFit, LAPS_WORTH, identify, identify_one, routine};
pub use lesson::{Ask, Check, Experiment, Graded, Lesson, Quantity};
pub use linearize::{Linearization, Operation};
pub use regression::Uncertain;
pub use relay::{Degrees, Relay, RelayError, RelayPid, Swing, swing};
pub use standing::standing;
pub use statistics::Quantiles;
pub use step::StepFigures;
pub use tune::{Demand, Setting, around, coarse};
pub use velocity::{Peaks, VelocityError, highest, peaks, peaks_seen, velocity_error};
