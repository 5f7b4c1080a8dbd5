//! The whole program of a board, fed by packets: every byte that it says, hashed.

use tracelight_board::{Board, Identity, MOST_CONFIGURATION, write_configuration};
use tracelight_rig::wire::{Ask, MOST_PACKET, Order, Reset, ToBoard, connection_of, crc32};
use tracelight_rig::{Capabilities, Command};

use crate::head::Head;
use crate::strokes::Strokes;
use crate::{Fnv, Meter, report};

/// A board as the firmware has it: so many segments ahead, so many rows to tell again.
pub type Firmware = Board<384, 2048>;

/// Number of the connection.
const SESSION: u32 = 1;
/// Segments that are sent in a tick at most, and room that is left.
const MOST_SEGMENTS: u32 = 4;
const LEAST_ROOM: usize = 300;

/// What such a board is told of itself.
pub const IDENTITY: Identity = Identity {
    firmware: [0, 1, 0],
    source: [0; 8],
    board: 1,
    id: [0; 8],
    capabilities: CAPABILITIES,
    reset: Reset::PowerUp,
};

const CAPABILITIES: Capabilities = Capabilities {
    stamps: true,
    gate_watched: false,
    light_watched: false,
    gyroscope: false,
    times_ticks: false,
    absolute: true,
    inputs: tracelight_rig::Inputs::ABSENT,
};

/// Says something to a board.
fn say(board: &mut Firmware, said: &ToBoard<'_>) {
    let mut out = [0; MOST_PACKET];
    let length = said.packed(connection_of(SESSION), &mut out);
    board.take(out.get(..length).unwrap_or_default(), 0);
}

/// Configures it, arms it, and draws for so many ticks; FNV-1a of all that it says.
pub fn run_wired(board: &mut Firmware, ticks: u32, meter: &mut impl Meter) -> u64 {
    let mut bytes = [0; MOST_CONFIGURATION];
    let length = write_configuration(&report(), &mut bytes).unwrap_or_default();
    let configuration = bytes.get(..length).unwrap_or_default();
    say(board, &ToBoard::Hello { version: (1, 0), session: SESSION, program: [0; 8] });
    for (piece, bytes) in configuration.chunks(200).enumerate() {
        say(board, &ToBoard::Configure { offset: 200 * piece as u16, bytes });
    }
    say(board, &ToBoard::Commit { length: length as u16, crc: crc32(configuration) });
    let (mut head, mut strokes, mut fnv) = (Head::default(), Strokes::default(), Fnv::default());
    let (mut sequence, mut nonce) = (0, 0);
    let mut order = |board: &mut Firmware, ask: Ask| {
        say(board, &ToBoard::Order(Order { sequence, ask }));
        sequence = sequence.wrapping_add(1);
    };
    for tick in 0..ticks {
        if tick % 5 == 0 {
            say(board, &ToBoard::KeepAlive { host_us: tick.into() });
        }
        if tick > 1 && tick % 10_000 == 2 {
            nonce += 1;
            order(board, Ask::Arm { nonce, acknowledges: 0 });
        }
        let room = board.machine().state().map_or(0, |state| state.room());
        for _ in 0..MOST_SEGMENTS {
            if tick < 4 || room < LEAST_ROOM {
                break;
            }
            let Some(segment) = strokes.due(tick - 4) else { break };
            order(board, Ask::Command(Command::Append(segment)));
        }
        let sensed = head.sensed();
        meter.begin();
        let actuation = board.tick(&sensed);
        // a controller that begins takes longer, once and in the dark
        if tick > 0 {
            meter.tick();
        }
        let mut out = [0; 4 * MOST_PACKET];
        let length = board.give(&mut out);
        fnv.bytes(out.get(..length).unwrap_or_default());
        head.exchange(&actuation);
    }
    fnv.0
}
