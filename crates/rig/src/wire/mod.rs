//! What a host and a board say to each other, as bytes. `docs/wire-format.md` describes them with an example of each, which a test reads.
//!
//! ```text
//! host                                                                 board
//! ToBoard ─► Body ─► packed ─► bytes ─► Packets ─► body ─► ToBoard::read
//! FromBoard::read ◄─ body ◄─ Packets ◄─ bytes ◄─ packed ◄─ Body ◄─ FromBoard
//! ```
//!
//! - A **packet** is a body and its CRC-32, stuffed so that it has no zero byte (COBS), with a zero at the end.
//! - **Commands** carry a sequence number. The board takes them in order and says which it wants next; what is lost is sent again. The rows of
//!   its report say how many it took before each tick, so that a host knows what the controller knew in every tick.
//! - **Disarm and keep-alive** need no turn: they act when they arrive.
//! - Whatever is wrong with a packet, it is as if it had not come. Silence darkens.

mod bytes;
mod cobs;
mod crc;
mod from_board;
mod packet;
mod row;
mod to_board;

pub use bytes::{Body, MOST_BODY};
pub use crc::crc32;
pub use from_board::{Configured, FromBoard, Greeting, Reset, Rows, RowsHeader, WrongConfiguration};
pub use packet::{MOST_PACKET, Packets, packed};
pub use row::{LAST_STAMP, Row, RowBytes, STAMPS_A_TICK, as_told};
pub use to_board::{Ask, Order, ToBoard};

/// Version of this protocol. Who speaks another major one is refused; the smaller minor one counts.
pub const VERSION: (u8, u8) = (1, 0);

/// First bytes of either's greeting.
const MAGIC: [u8; 4] = *b"TLHT";

/// Commands that may be on their way at once.
pub const WINDOW: u16 = 16;

/// Whether a sequence number is that of a command before another one, of two no further apart than half of all numbers.
pub const fn is_before(number: u16, other: u16) -> bool {
    number.wrapping_sub(other) >= 1 << 15
}

/// First bytes of a body: kind, connection, sequence number.
fn head(body: &mut Body, kind: u8, connection: u8, sequence: u16) {
    body.u8(kind);
    body.u8(connection);
    body.u16(sequence);
}

/// The byte by which packets of a connection are known: the last of its [number](ToBoard::Hello). A greeting has 0, its number is within.
pub const fn connection_of(session: u32) -> u8 {
    session.to_le_bytes()[0]
}
