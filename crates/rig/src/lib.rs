//! Types shared by a pan/tilt laser head, its controller and its host.
//!
//! This crate holds types and the two seams, nothing else: no control, no physics, no allocation, no clock.
//! Everything that crosses from the host's planner to the controller ([`Segment`], [`Command`]), from the
//! controller to the motors ([`Actuation`]), from the encoders back ([`Measurement`]) and from the controller to
//! whoever watches ([`Telemetry`]) is named here once, in `f32` and integer ticks, so that a simulated head and a
//! real one are told the same things with the same bits.
//!
//! | seam | one side | other side |
//! |---|---|---|
//! | [`Head`] | the controller's tick | motors, encoders and laser: boards or equations |
//! | [`Rig`] | the host program | a controller with its head, over a wire or in this process |

#![no_std]

mod capabilities;
mod darkness;
mod exchange;
mod fault;
mod fault_record;
mod head;
mod inputs;
mod joint;
mod pace;
mod segment;
mod setpoint;
mod telemetry;
pub mod wire;

pub use capabilities::Capabilities;
pub use darkness::{Darkness, DarknessRow, DarknessSet};
pub use exchange::{Actuation, Measurement, Sensed};
pub use fault::{Clears, Fault, FaultRow, Measure, Motors, Soon};
pub use fault_record::{Evidence, Exceeded, FaultRecord, Told};
pub use head::{Head, Rig};
pub use inputs::{Input, InputState, Inputs};
pub use joint::{Joint, JointLimits, PanTilt};
pub use pace::{RateLimit, SPEED_RANGE, ease_per_s, ease_within};
pub use segment::{Command, Segment};
pub use setpoint::Setpoint;
pub use telemetry::{Phase, Telemetry};

/// Length of one control tick, s. The law is discretized for it; other rates need other gains.
pub const TICK_S: f32 = 1e-3;

/// [`TICK_S`] for code that computes in `f64`: exactly one millisecond.
pub const TICK_F64_S: f64 = 1e-3;

/// [`TICK_S`] as boards tell it, ns.
pub const TICK_NS: u32 = 1_000_000;
