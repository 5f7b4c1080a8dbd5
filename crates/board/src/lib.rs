//! The program of a board that drives a head: everything but its pins.
//!
//! ```text
//! bytes ─► Server ── orders ─► Machine ◄── senses
//! bytes ◄─ Server ◄── rows ─── Machine ──► actuation
//! ```
//!
//! The [`Machine`] is what happens every millisecond: the controller, and which orders it takes before each tick. The [`Server`] speaks with the host. A
//! board's firmware runs the one in its timer's interrupt and the other in its main loop; what passes [`Between`] them does so without waiting. [`Board`] holds
//! both for whoever has one thread. What [`lines`] of a board say is told here in numbers, so that firmware has none of its own. `no_std`, `f32`, no allocation, no panic.
//!
//! Dark is what it is at a reset, without a configuration, with one whose checksum is wrong, and without a host. Nothing but an Arm of a host that is there,
//! by a number that was never used before, ends that.

#![no_std]

mod board;
mod configuration;
mod halves;
mod law;
pub mod lines;
mod machine;
mod orders;
mod ring;
mod server;
mod start;

pub use board::Board;
pub use configuration::{MOST_CONFIGURATION, read_configuration, write_configuration};
pub use halves::{Between, Done, Speaker, Ticker};
pub use law::law_hash;
pub use machine::{Disarm, Inbox, MOST_ORDERS_A_TICK, Machine, May, NewConfiguration, Told};
pub use server::{Identity, Server, version};
pub use start::Start;
