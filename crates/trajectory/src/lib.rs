//! Plans timed joint segments from strokes and motor limits.
//!
//! ```text
//! stroke ─► legs (cut at corners) ─► retime (torque, speed) ─► S-curve ─┐
//!                                                                        ├─► ticks ─► segments
//! end of one, start of the next ─► travel (synchronised profile, dark) ─┘
//! ```
//!
//! Limits come from the motors: amplifier volts, what they give as torque, and what friction and gravity leave of it.
//! The crate knows neither images nor encoder counts, and computes torque only to stay under it: what the motors are
//! told is the controller's.

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")
)]

mod binding;
mod compress;
mod corner;
mod course;
mod error;
mod headroom;
mod leg;
mod machine;
mod mark;
mod motion;
mod move_point;
mod plan;
mod planner;
mod profile;
mod request;
mod retime;
mod rounding;
mod steer;
mod swing;
mod tour;
mod travel;
mod travel_time;
mod turn;

pub use binding::Binding;
pub use course::{Course, CourseError, CoursePoint, Pace};
pub use error::PlanError;
pub use machine::{AccelerationDemand, Machine};
pub use motion::JointMotion;
pub use move_point::MovePoint;
pub use plan::{LONGEST_S, LegEnd, Plan, PlanPoint, Tightest};
pub use planner::{plan, plan_from, plan_waiting};
pub use profile::limits::{MoveLimits, Peaks};
pub use profile::{Profile, Ramps, Shape};
pub use request::{DarkMove, LitSpeed, PlanRequest, Wait};
pub use retime::{JointLimits, PathSample, Retimed, Smooth, SmoothError, retime, retime_smooth};
pub use steer::bounds::Bounds;
pub use steer::{SteerError, Steered, steer, steer_no_faster};
pub use swing::rest_to_rest;
pub use travel_time::{Aimed, TravelTime};
pub use turn::turn;
