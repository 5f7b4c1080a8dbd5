//! What a host and a board hear: bytes of the line as they come, and bodies in whole packets, so that what a checksum would stop gets further.
//!
//! The bytes are read as pieces: a byte that says for whom and how, one that says how long, and so many.

use tracelight_board::{Board, Identity};
use tracelight_device::Host;
use tracelight_rig::wire::{Ask, FromBoard, MOST_PACKET, Packets, Reset, ToBoard, packed};
use tracelight_rig::{Capabilities, Command, Measurement, PanTilt, Sensed};
use tracelight_sim::RigConfig;

/// Kinds of pieces.
pub const TO_BOARD: u8 = 0;
/// A body for the board.
pub const BODY_TO_BOARD: u8 = 1;
/// Bytes for the host.
pub const TO_HOST: u8 = 2;
/// A body for the host.
pub const BODY_TO_HOST: u8 = 3;

/// Most pieces of an input: a tick each.
const MOST_PIECES: usize = 512;

fn board() -> Board<8, 64> {
    let capabilities = Capabilities { absolute: true, stamps: true, ..Capabilities::default() };
    Board::new(Identity::emulated(capabilities, Reset::PowerUp))
}

/// Whether any packet in these bytes may let light out.
fn lights(packets: &mut Packets, bytes: &[u8]) -> bool {
    let is_light = |(said, _): (ToBoard<'_>, u8)| match said {
        ToBoard::Order(order) => matches!(order.ask, Ask::Arm { .. } | Ask::Command(Command::Point(_))),
        _ => false,
    };
    bytes.iter().fold(false, |lights, &byte| {
        lights | packets.push(byte).and_then(ToBoard::read).is_some_and(is_light)
    })
}

/// Whatever comes, a board and a host go on, a board is dark until something came that may light it, and what either says is read by the other's reader.
pub fn check(data: &[u8]) {
    let mut board = board();
    let mut host = Host::new(RigConfig::report().control_config(), 1);
    let (mut heard, mut said, mut may_light) = (Packets::new(), Packets::new(), false);
    let mut rest = data;
    for piece in 0..MOST_PIECES {
        let [kind, length, left @ ..] = rest else { break };
        let (bytes, left) = left.split_at(usize::from(*length).min(left.len()));
        rest = left;
        let mut packet = [0; MOST_PACKET];
        let bytes = match kind & 1 {
            0 => bytes,
            _ => {
                let length = packed(bytes, &mut packet);
                &packet[..length]
            }
        };
        let now_us = 1000 * piece as u64;
        if kind & 2 == 0 {
            may_light |= lights(&mut heard, bytes);
            board.take(bytes, 0);
        } else {
            host.take(bytes, now_us);
        }
        let count = piece as i32 / 7;
        let measured = Measurement { count, edge_age_ticks: (piece % 3 == 0).then_some(0.5) };
        let sensed = Sensed { encoders: PanTilt::new(measured, measured), ..Sensed::default() };
        let actuation = board.tick(&sensed);
        assert!(may_light || !actuation.lights(), "lit, and nothing came that may light it");
        let volts = actuation.command_v;
        assert!(volts.pan.is_finite() && volts.tilt.is_finite(), "{volts:?}");
        let mut out = [0; 4 * MOST_PACKET];
        let length = board.give(&mut out);
        for &byte in &out[..length] {
            if let Some(body) = said.push(byte) {
                assert!(FromBoard::read(body).is_some(), "the board says what nobody reads: {body:?}");
            }
        }
        assert_eq!(said.spoilt(), 0, "the board spoils its own packets");
        host.take(&out[..length], now_us);
        let mut answer = Vec::new();
        host.give(now_us, &mut answer);
        let mut packets = Packets::new();
        for &byte in &answer {
            if let Some(body) = packets.push(byte) {
                assert!(ToBoard::read(body).is_some(), "the host says what nobody reads: {body:?}");
            }
        }
    }
}

/// What a board hears of a host that configures it, arms it and draws a little: pieces for [`check`].
pub fn session() -> Vec<u8> {
    let mut board = board();
    let mut host = Host::new(RigConfig::report().control_config(), 1);
    let mut pieces = Vec::new();
    for tick in 0..60_u64 {
        let _ = host.send(Command::KeepAlive);
        if tick == 10 {
            let _ = host.send(Command::Arm { acknowledges: 0 });
            let _ = host.send(Command::Finish);
        }
        let mut bytes = Vec::new();
        host.give(1000 * tick, &mut bytes);
        board.take(&bytes, 0);
        for bytes in bytes.chunks(255) {
            pieces.extend([TO_BOARD, bytes.len() as u8]);
            pieces.extend(bytes);
        }
        board.tick(&Sensed::default());
        let mut out = [0; 4 * MOST_PACKET];
        let length = board.give(&mut out);
        host.take(&out[..length], 1000 * tick);
    }
    pieces
}
