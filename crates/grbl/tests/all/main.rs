//! A head on a Grbl board, driven by a session: what is drawn, how long it takes, and what becomes of it when somebody or something interferes.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, in its helpers too")]
#![allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")]
#![allow(clippy::print_stdout, reason = "a test shows figures")]

mod board;
mod driving;
