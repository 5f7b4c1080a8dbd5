//! All integration tests of the crate in one program: linked once.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, in its helpers too")]
#![allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")]

mod any_drawing;
mod machines;
mod mutations;
#[path = "support/plate.rs"]
mod plate;
mod seen;
mod small_and_slow;
mod texts;
