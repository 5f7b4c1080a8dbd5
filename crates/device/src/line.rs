//! Packets to a board.

use tracelight_rig::wire::{MOST_PACKET, ToBoard};

/// What goes to the board, in packets of a connection.
pub(crate) struct Line<'a> {
    pub(crate) connection: u8,
    pub(crate) out: &'a mut Vec<u8>,
}

impl Line<'_> {
    /// Says something.
    pub(crate) fn say(&mut self, said: ToBoard<'_>) {
        let mut packet = [0; MOST_PACKET];
        let length = said.packed(self.connection, &mut packet);
        self.out.extend_from_slice(&packet[..length]);
    }
}
