//! The closed loop: a rig configuration and a job in, one seeded run out.
//!
//! Plant and controller meet here, and only through the seams of [`tracelight_rig`]. Same inputs, same bytes: the
//! crate reads no clock, starts no thread and draws nothing that its seed does not decide.

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")
)]

mod again;
mod alone;
mod array;
mod bench;
mod compensator;
mod config;
mod control_settings;
mod diagram;
mod drive;
mod driven;
mod join;
mod laws;
mod lead_lag;
mod light_settings;
mod linear;
mod link;
mod observed;
mod open_loop;
mod pid_law;
mod presets;
mod replay;
mod room;
mod run;
mod safety_settings;
mod score;
mod spread;
mod standing;
mod step;
mod trouble;
mod truth;
mod wired;

pub use again::looped_job;
pub use alone::{MotorReading, Mounting, READ_TICKS, head_alone, motor_readings};
pub use array::{ArrayError, Between, MotionArray};
pub use bench::BenchTick;
pub use compensator::CompensatorLaw;
pub use config::{Cable, Identified, Model, MotionSettings, Quirks, RigConfig, Ripple, Truth};
pub use control_settings::ControlSettings;
pub use diagram::{Diagram, ScopeTick};
pub use drive::{DriveKind, DriveSettings};
pub use laws::{Compensator, HandTuned, LawName, ObserverName, StepReference};
pub use light_settings::{Day, LaserClass, LightSettings};
pub use link::{Emulation, LinkSettings};
pub use observed::{ByEncoders, LightFrom, Observed, Origin, observed_tick};
pub use pid_law::PidLaw;
pub use replay::replay;
pub use room::{Room, Taken};
pub use run::{
    AFTERMATH_TICKS, Run, ServedRig, Simulated, SimulatedRig, Tick, arm, job_of, run, run_segments, tick,
    tick_trimmed,
};
pub use safety_settings::SafetySettings;
pub use score::{Tracking, score};
pub use spread::Spread;
pub use standing::{LightAhead, Standing, first_standing, slowest_speed};
pub use step::{
    Push, StepResponse, follow_array, push_response, step_response, step_response_by, step_response_by_pid,
};
pub use tracelight_control::{Feedforward, LONGEST_INTERVAL_TICKS};
pub use tracelight_plant::{LooseBelt, Weakening};
pub use trouble::{EyeTrouble, Trouble};
