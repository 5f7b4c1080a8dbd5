//! A head behind a wire, as a host drives it.
//!
//! ```text
//! commands ─► Host ── packets ──► bytes ──► board
//!              │  orders that are sent and not yet taken
//!              ▼
//! telemetry ◄─ Twin ◄── rows ─── bytes ◄── board
//! ```
//!
//! [`Host`] speaks with the board and does no I/O: bytes and the time are handed in, bytes and telemetry come out. A board tells of each tick only what it sensed,
//! did and took; the [`Twin`] is the host's own controller, which is given the same and has to do the same, bit for bit. So a host knows all that the controller knows, over
//! a wire that carries 32 bytes a tick, and whatever is another law, another configuration, a memory fault or a lost packet shows within a tick or two: then it is dark.

mod clock;
mod host;
mod line;
mod outbox;
mod times;
mod trouble;
mod twin;

pub use clock::Clock;
pub use host::{Host, Stage};
pub use trouble::{Divergence, Trouble};
pub use twin::Twin;
