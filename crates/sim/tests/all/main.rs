//! All integration tests of the crate in one program: linked once.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, in its helpers too")]
#![allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")]

mod amplifiers;
mod belts;
mod bridges;
mod by_hand;
mod closed_loop;
mod dice;
mod disturbances;
mod evidence;
mod faults;
mod homing;
mod inputs;
mod jolts;
mod observed;
mod open_loop;
mod paces;
mod recovery;
mod scenarios;
mod segments;
mod session;
mod shapes;
mod silence;
mod slips;
mod standing;
mod sweep;
mod switches;
mod tracking;
mod troubled;
mod turned;
mod wired;
