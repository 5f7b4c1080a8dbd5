//! The loop closed: a rig description and a job in, one seeded run out.
//!
//! Plant and controller meet here, and only through the seams of [`tracelight_rig`]. Same inputs, same bytes: the
//! crate reads no clock, starts no thread and draws nothing that its seed does not decide.

mod config;
mod join;
mod presets;
mod run;
mod score;

pub use config::{ControlSettings, Model, MotionSettings, RigConfig, Truth};
pub use run::{Feeder, Run, SimulatedRig, Tick, run};
pub use score::{Tracking, score};
