//! Boards on a line of this computer.
//!
//! A [`Port`] is a serial port or a pseudo-terminal that is held by one program at a time. [`found()`] lists them, [`examine`] greets the board at one and says what it is.
//! [`Device`] is the head behind it, as a rig that a session drives; [`head()`] as one that a job is run by.
//! While it is open, others [`watch`] it, and anybody may make it dark ([`darken`]); [`share`] holds a port for several programs, of which one drives at a time.
//! [`serve`] emulates a board with its head at a pseudo-terminal, by the clock, for whatever program speaks the wire's language.

mod asked;
#[cfg(unix)]
mod device;
#[cfg(unix)]
mod examine;
#[cfg(unix)]
mod found;
#[cfg(unix)]
mod grbl;
mod greeting;
#[cfg(unix)]
mod head;
#[cfg(unix)]
mod port;
#[cfg(unix)]
mod seen;
#[cfg(unix)]
mod serve;
#[cfg(unix)]
mod session;
#[cfg(unix)]
mod share;
#[cfg(unix)]
mod shared;
#[cfg(unix)]
mod terminal;
#[cfg(unix)]
mod visit;
#[cfg(unix)]
mod wire;

pub use asked::{asked_json, asked_text};
#[cfg(unix)]
pub use device::Device;
#[cfg(unix)]
pub use examine::examine;
#[cfg(unix)]
pub use found::{Found, found};
#[cfg(unix)]
pub use grbl::{Grbl, ask};
pub use greeting::{Examined, examined_json, examined_text};
#[cfg(unix)]
pub use head::{At, Connected, Speaks, head};
#[cfg(unix)]
pub use port::Port;
#[cfg(unix)]
pub use seen::seen_text;
#[cfg(unix)]
pub use serve::{Served, Serving, serve};
#[cfg(unix)]
pub use share::{SharedFor, share};
#[cfg(unix)]
pub use visit::{Darkened, darken, darkened_json, darkened_text, watch};
