//! All integration tests of the crate in one program: linked once.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, in its helpers too")]
#![allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")]

mod feedback;
mod goldens;
mod mimo;
mod pids;
mod published;
mod regulators;
mod roots;
mod transients;
