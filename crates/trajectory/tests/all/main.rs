//! All integration tests of the crate in one program: linked once.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, in its helpers too")]
#![allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")]

mod any_move;
mod any_path;
mod course;
mod lit_speed;
mod plan;
mod retime;
mod smooth;
mod support;
