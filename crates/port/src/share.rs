//! A port that a program holds for others: one drives at a time, any number watch.

use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tracelight_rig::Inputs;
use tracelight_rig::wire::{FromBoard, MOST_PACKET, Packets, ToBoard};
use tracelight_task::{Failure, Task};

use crate::port::Port;
use crate::seen::Seen;
use crate::shared::Shared;

/// For how long it waits for the board's bytes before it looks what others want.
const WAIT: Duration = Duration::from_millis(1);
/// A connection that no host has: each has an odd number.
const NOBODYS: u8 = 0;
/// How often a board is told to be dark: a packet may be lost.
const TIMES: usize = 3;

/// What came of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SharedFor {
    /// For how long it was shared, s.
    pub lasted_s: f64,
    /// How many programs drove the board, one after the other.
    pub drivers: u32,
    /// Bytes that passed to the board.
    pub to_board: u64,
    /// Bytes that passed from it.
    pub from_board: u64,
}

impl SharedFor {
    /// For people.
    #[must_use]
    pub fn text(&self) -> String {
        let Self { lasted_s, drivers, to_board, from_board } = self;
        format!(
            "shared for {lasted_s:.1} s: {drivers} programs drove it, {to_board} bytes went to the board, {from_board} came"
        )
    }

    /// For scripts.
    #[must_use]
    pub fn json(&self) -> Value {
        let Self { lasted_s, drivers, to_board, from_board } = self;
        json!({ "lasted_s": lasted_s, "drivers": drivers, "to_board_bytes": to_board, "from_board_bytes": from_board })
    }
}

/// Holds the port of a board for other programs of this computer, until it is stopped or that long is over, s.
///
/// # Errors
/// `port`: it cannot be opened, or is gone; or no socket can be made.
pub fn share(path: &Path, lasts_s: Option<f64>, task: Task<'_>) -> Result<SharedFor, Failure> {
    let mut port = Port::open_alone(path)?;
    let at = path.display();
    let mut shared = Shared::new(path, true)
        .map_err(|e| Failure::failed("port", format!("{at}: it cannot be shared: {e}")))?;
    task.say(&format!(
        "the board at {at} is shared: other programs drive it by --rig {at}, one at a time; Ctrl-C ends it"
    ));
    let (began, mut packets, mut inputs) = (Instant::now(), Packets::new(), Inputs::default());
    let (mut told, mut was_driven, mut bytes) = (SharedFor::default(), false, Vec::new());
    while !task.stop.is_wanted() && lasts_s.is_none_or(|lasts_s| began.elapsed().as_secs_f64() < lasts_s) {
        let mut wanted = shared.hear();
        if wanted.disarm {
            // what its driver says is not wanted any more, nor he
            wanted.bytes = disarm();
            shared.send_away();
        }
        let is_driven = shared.is_driven();
        told.drivers += u32::from(is_driven && !was_driven);
        was_driven = is_driven;
        bytes.clear();
        let gone =
            |e: std::io::Error| Failure::failed("port", format!("{at}: the line to the board is gone: {e}"));
        port.write(&wanted.bytes).map_err(gone)?;
        port.read(&mut bytes, WAIT).map_err(gone)?;
        told.to_board += wanted.bytes.len() as u64;
        told.from_board += bytes.len() as u64;
        shared.pass(&bytes);
        for &byte in &bytes {
            match packets.push(byte).and_then(FromBoard::read) {
                Some((FromBoard::Hello(board), _)) => inputs = board.capabilities.inputs,
                Some((FromBoard::Rows(rows), _)) => {
                    rows.rows(inputs).for_each(|(tick, row)| shared.tell(&Seen::passing(tick, &row)));
                }
                _ => {}
            }
        }
    }
    Ok(SharedFor { lasted_s: began.elapsed().as_secs_f64(), ..told })
}

/// What disarms a board, whoever drives it.
fn disarm() -> Vec<u8> {
    let mut out = [0; MOST_PACKET];
    let length = ToBoard::Disarm { before: 0, number: 0 }.packed(NOBODYS, &mut out);
    // whatever was on the way before it is no part of it
    std::iter::once(0).chain(out[..length].repeat(TIMES)).collect()
}
