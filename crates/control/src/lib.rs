//! The controller that runs every tick.
//!
//! Counts and segments in, volts and the laser's gate out, a thousand times a second:
//!
//! ```text
//! Measurement ─► Observer ─► estimate ─┐
//!                                      ├─► Law (feedback + feedforward) ─► volts
//! Segment ─────► Player ───► setpoint ─┤
//!                                      └─► Supervisor + interlock ───────► gate, clock
//!                                          light budget
//! ```
//!
//! `no_std`, `f32`, no allocation, no panic, constant work a tick: the simulated controller is bit for bit the flashed
//! one. The crate does not know the plant beyond its [`Config`], nor what is drawn, nor what time it is.
//! Configuration ([`Controller`]) and state ([`State`]) are two types; a tick reads one and rewrites the other.

#![no_std]

mod axis;
mod bounds;
mod config;
mod controller;
mod creep;
mod crossed;
mod elementary;
mod estimate;
mod finding;
mod law;
mod light_budget;
mod limit;
mod model;
mod observer;
mod player;
mod quirks;
mod recent_light;
mod return_path;
mod servo;
mod squares;
mod state;
mod supervisor;
mod switch_test;
mod test_move;
mod watch;

pub use axis::AxisConfig;
pub use config::{Config, Drive, Gentle};
pub use controller::Controller;
pub use creep::Creep;
pub use estimate::{Effort, Estimate, Learned};
pub use law::{Biquad, Feedback, Feedforward, LawConfig, LeadLag, Pid, StateFeedback};
pub use light_budget::LightBudget;
pub use model::{FrictionModel, HeadModel};
pub use observer::Observer;
pub use observer::config::{LONGEST_INTERVAL_TICKS, ObserverConfig};
pub use observer::tuning::{KalmanTuning, Unknown};
pub use player::QUEUE_LENGTH;
pub use quirks::{Cable, Quirks, Ripple};
pub use servo::{Reference, Servo};
pub use state::{Carried, State};
pub use watch::{Foot, MotorRating, Sway};
