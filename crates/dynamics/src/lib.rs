//! Equations of motion of a pan/tilt head.
//!
//! Pan turns about the vertical z, tilt about the pan-carried y; at zero the beam points along +x, and positive tilt
//! turns it down. Two rigid bodies, two geared motors:
//!
//! ```text
//! M(q) q̈ + C(q, q̇) + G(q) + F(q̇) = τ
//! ```
//!
//! The crate holds parameters and the terms of that equation, in `f64` and SI. It knows nothing of sampling, of
//! controllers or of light: whoever steps it in time chooses how.

mod body;
mod friction;
mod lumped;
mod motor;
mod sets;

pub use body::{Body, HeadBodies, Inertia};
pub use friction::Friction;
pub use lumped::{BiasSlopes, Lumped, MassMatrix};
pub use motor::Motor;
