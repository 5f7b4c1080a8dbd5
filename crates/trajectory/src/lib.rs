//! Strokes and motor limits in, timed joint segments out.
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

mod compress;
mod corner;
mod course;
mod error;
mod leg;
mod machine;
mod mark;
mod plan;
mod planner;
mod profile;
mod retime;
mod steer;
mod swing;
mod tour;
mod travel;
mod travel_time;

pub use course::{Course, CourseError, CoursePoint, Pace};
pub use error::PlanError;
pub use machine::{AccelerationDemand, Machine};
pub use plan::{JointMotion, LegEnd, Plan, PlanPoint, Tightest};
pub use planner::{DarkMove, LitSpeed, PlanRequest, plan};
pub use profile::{MoveLimits, MovePoint, Peaks, Profile, Ramps, Shape};
pub use retime::{Binding, JointLimits, PathSample, Retimed, Smooth, SmoothError, retime, retime_smooth};
pub use steer::{Bounds, SteerError, Steered, steer, steer_no_faster};
pub use swing::rest_to_rest;
pub use travel_time::{Aimed, TravelTime};
