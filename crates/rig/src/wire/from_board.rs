//! What a board says.

use super::bytes::{Body, MOST_BODY, Rest};
use super::packet::{MOST_PACKET, packed};
use super::row::{Row, RowBytes};
use super::{MAGIC, head};
use crate::{Capabilities, Exceeded, Fault, FaultRecord, Inputs, Joint, PanTilt};

/// What a board says in a packet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FromBoard<'a> {
    /// What it is: the answer to a greeting, and unasked after a reset.
    Hello(Greeting),
    /// What became of the configuration that was sent.
    Configured(Result<Configured, WrongConfiguration>),
    /// A keep-alive came.
    Pong {
        /// What the host's clock was when it said so, µs.
        host_us: u64,
        /// The board's tick when it came.
        tick: u32,
        /// How far in that tick, µs.
        tick_us: u16,
    },
    /// What it sensed and did, tick by tick.
    Rows(Rows<'a>),
    /// A fault was latched. Told again and again until it was [seen](super::ToBoard::Seen).
    Fault(FaultRecord),
    /// A remark for people.
    Log(&'a str),
}

/// What a board is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Greeting {
    /// [Version](super::VERSION) that it speaks.
    pub version: (u8, u8),
    /// The greeting's that it answers; 0 unasked.
    pub session: u32,
    /// Version of its program.
    pub firmware: [u8; 3],
    /// First bytes of the hash of its program's source.
    pub source: [u8; 8],
    /// Kind of board.
    pub board: u16,
    /// Number of this one.
    pub id: [u8; 8],
    /// Length of its ticks, ns.
    pub tick_ns: u32,
    /// Segments that it holds ahead.
    pub segments: u16,
    /// Rows that it can tell again.
    pub rows: u16,
    /// What it has.
    pub capabilities: Capabilities,
    /// [Checksum](super::crc32) of the configuration in force; `None` without one.
    pub configuration: Option<u32>,
    /// Why it started.
    pub reset: Reset,
    /// Ticks since then.
    pub tick: u32,
    /// Number of the last Arm that it took.
    pub nonce: u32,
}

impl Greeting {
    /// Kind of a board that is emulated, head and all: nobody can buy it.
    pub const EMULATED: u16 = 0;
    /// Kind of a Raspberry Pi Pico 2.
    pub const PICO_2: u16 = 1;
    /// Kind of a test double of a Pico 2, for an emulator: its processor is too slow for the law, and a host drives it at a pseudo-terminal only.
    pub const DOUBLE: u16 = 2;
    /// Number of boards that are emulated, of whatever kind they say that they are.
    pub const EMULATED_ID: [u8; 8] = *b"emulated";

    /// Whether board and head are emulated: nothing moves, no light falls.
    pub fn is_emulated(&self) -> bool {
        matches!(self.board, Self::EMULATED | Self::DOUBLE) || self.id == Self::EMULATED_ID
    }

    /// Whether a person must arm its head: one that does not say that it is emulated, and one that is there to practise with.
    pub const fn wants_a_person(&self) -> bool {
        !matches!(self.board, Self::EMULATED | Self::DOUBLE)
    }
}

/// Why a board started.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Reset {
    /// The supply came.
    PowerUp = 0,
    /// Somebody pressed its button.
    Button = 1,
    /// The program hung.
    Watchdog = 2,
    /// The supply was too low for a moment.
    BrownOut = 3,
    /// Somebody told it to, as after another program was loaded.
    Told = 4,
    /// Nobody knows.
    Unknown = 5,
}

impl Reset {
    /// Every cause.
    pub const ALL: [Self; 6] =
        [Self::PowerUp, Self::Button, Self::Watchdog, Self::BrownOut, Self::Told, Self::Unknown];
}

/// A configuration that is in force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Configured {
    /// Its [checksum](super::crc32).
    pub crc: u32,
    /// Tick with which the controller begins anew: of this one on there are rows.
    pub tick: u32,
    /// Hash of what the law does, by this configuration, with senses that are always the same: that of the host's own law, or one of both is another.
    pub law: u32,
    /// Counts at which the head was told to stand, before the first tick, if it kept its homing.
    pub home: Option<PanTilt<i32>>,
    /// Heat of the motors, of a head that another configuration drove before; where that lit is not known.
    pub heat: Option<PanTilt<f32>>,
    /// How long ago its gate fell then, ticks; `u32::MAX` if it was never open.
    pub shut_ticks: u32,
}

/// Why a configuration is not in force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WrongConfiguration {
    /// Its bytes are not those whose checksum was told; this is the checksum of what came.
    Checksum(u32),
    /// Too short or too long: this many bytes are needed.
    Length(u16),
    /// This word of it, counted from 0, has a value that it cannot have.
    Word {
        /// Its number.
        word: u16,
        /// What it is.
        bits: u32,
    },
    /// The rig is armed.
    Armed,
}

/// Rows of ticks that follow each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rows<'a> {
    /// What comes before them.
    pub header: RowsHeader,
    /// How many rows.
    pub count: u8,
    /// Their bytes, one after the other.
    bytes: &'a [u8],
}

impl<'a> Rows<'a> {
    /// The rows, of a rig that has these inputs; ends early if one is none.
    pub fn rows(&self, inputs: Inputs) -> impl Iterator<Item = (u32, Row)> + use<'a> {
        let mut rest = Rest(self.bytes);
        let rows = core::iter::from_fn(move || Row::read(&mut rest, inputs));
        (0..u32::from(self.count)).zip(rows).map({
            let first_tick = self.header.first_tick;
            move |(at, row)| (first_tick.wrapping_add(at), row)
        })
    }

    /// As the body of a packet: as many rows from the first on as fit, and how many those are.
    pub fn body<'r>(
        connection: u8,
        header: &RowsHeader,
        rows: impl IntoIterator<Item = &'r RowBytes> + Clone,
    ) -> (Body, u8) {
        let (mut count, mut length) = (0, HEAD);
        for row in rows.clone() {
            length += row.bytes().len();
            if length > MOST_BODY {
                break;
            }
            count += 1;
        }
        let mut body = Body::new();
        header.write(&mut body, connection, count);
        rows.into_iter().take(count.into()).for_each(|row| body.slice(row.bytes()));
        (body, count)
    }
}

/// What rows begin with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RowsHeader {
    /// Tick of the first one.
    pub first_tick: u32,
    /// Sequence number of the order that comes next.
    pub wanted: u16,
    /// Segments that there is room for.
    pub free: u16,
    /// Number of the last Disarm that acted.
    pub disarm: u16,
    /// How many faults were latched since power-up: what an Arm acknowledges.
    pub fault_number: u32,
}

impl RowsHeader {
    fn write(&self, body: &mut Body, connection: u8, count: u8) {
        let Self { first_tick, wanted, free, disarm, fault_number } = *self;
        head(body, kind::ROWS, connection, 0);
        body.u32(first_tick);
        body.u16(wanted);
        body.u16(free);
        body.u16(disarm);
        body.u32(fault_number);
        body.u8(count);
    }

    fn read(rest: &mut Rest<'_>) -> Option<Self> {
        Some(Self {
            first_tick: rest.u32()?,
            wanted: rest.u16()?,
            free: rest.u16()?,
            disarm: rest.u16()?,
            fault_number: rest.u32()?,
        })
    }
}

/// Bytes before the first row.
const HEAD: usize = 19;

mod kind {
    pub(super) const HELLO: u8 = 0x81;
    pub(super) const CONFIGURED: u8 = 0x82;
    pub(super) const ROWS: u8 = 0x90;
    pub(super) const FAULT: u8 = 0x92;
    pub(super) const LOG: u8 = 0x93;
    pub(super) const PONG: u8 = 0xA0;
}

impl<'a> FromBoard<'a> {
    /// As the body of a packet of a connection.
    pub fn body(&self, connection: u8) -> Body {
        let mut body = Body::new();
        let head = |body: &mut Body, kind: u8, sequence: u16| head(body, kind, connection, sequence);
        match self {
            Self::Hello(greeting) => greeting.write(&mut body),
            Self::Configured(Ok(configured)) => {
                head(&mut body, kind::CONFIGURED, 0);
                body.u8(0);
                configured.write(&mut body);
            }
            Self::Configured(Err(wrong)) => {
                head(&mut body, kind::CONFIGURED, 0);
                wrong.write(&mut body);
            }
            Self::Pong { host_us, tick, tick_us } => {
                head(&mut body, kind::PONG, 0);
                body.u64(*host_us);
                body.u32(*tick);
                body.u16(*tick_us);
            }
            Self::Rows(rows) => {
                rows.header.write(&mut body, connection, rows.count);
                body.slice(rows.bytes);
            }
            Self::Fault(record) => {
                head(&mut body, kind::FAULT, 0);
                write_fault(record, &mut body);
            }
            Self::Log(text) => {
                head(&mut body, kind::LOG, 0);
                body.slice(text.as_bytes());
            }
        }
        body
    }

    /// As a packet of a connection; how long it is.
    pub fn packed(&self, connection: u8, out: &mut [u8; MOST_PACKET]) -> usize {
        packed(self.body(connection).bytes(), out)
    }

    /// What a body says, and in which connection; `None` if that is nothing that is known, or anything about it is not as it should be.
    pub fn read(body: &'a [u8]) -> Option<(Self, u8)> {
        let mut rest = Rest(body);
        let (kind, connection, sequence) = (rest.u8()?, rest.u8()?, rest.u16()?);
        let said = match kind {
            kind::HELLO => Self::Hello(Greeting::read(&mut rest)?),
            kind::CONFIGURED => Self::Configured(match rest.u8()? {
                0 => Ok(Configured::read(&mut rest)?),
                why => Err(WrongConfiguration::read(why, &mut rest)?),
            }),
            kind::PONG => Self::Pong { host_us: rest.u64()?, tick: rest.u32()?, tick_us: rest.u16()? },
            kind::ROWS => {
                let (header, count) = (RowsHeader::read(&mut rest)?, rest.u8()?);
                let bytes = rest.all();
                if RowBytes::count_in(bytes) != Some(count.into()) {
                    return None;
                }
                Self::Rows(Rows { header, count, bytes })
            }
            kind::FAULT => Self::Fault(read_fault(&mut rest)?),
            kind::LOG => Self::Log(core::str::from_utf8(rest.all()).ok()?),
            _ => return None,
        };
        (rest.is_empty() && sequence == 0).then_some((said, connection))
    }
}

impl Greeting {
    fn write(&self, body: &mut Body) {
        head(body, kind::HELLO, 0, 0);
        body.slice(&MAGIC);
        body.u8(self.version.0);
        body.u8(self.version.1);
        body.u32(self.session);
        body.slice(&self.firmware);
        body.slice(&self.source);
        body.u16(self.board);
        body.slice(&self.id);
        body.u32(self.tick_ns);
        body.u16(self.segments);
        body.u16(self.rows);
        body.u32(self.capabilities.bits());
        body.u8(u8::from(self.configuration.is_some()));
        body.u32(self.configuration.unwrap_or_default());
        body.u8(self.reset as u8);
        body.u32(self.tick);
        body.u32(self.nonce);
    }

    fn read(rest: &mut Rest<'_>) -> Option<Self> {
        let magic: [u8; 4] = rest.bytes()?;
        if magic != MAGIC {
            return None;
        }
        let (version, session) = ((rest.u8()?, rest.u8()?), rest.u32()?);
        let (firmware, source) = (rest.bytes()?, rest.bytes()?);
        let (board, id, tick_ns) = (rest.u16()?, rest.bytes()?, rest.u32()?);
        let (segments, rows) = (rest.u16()?, rest.u16()?);
        let capabilities = Capabilities::from_bits(rest.u32()?)?;
        let (is_configured, crc, reset) = (rest.flag()?, rest.u32()?, rest.u8()?);
        Some(Self {
            version,
            session,
            firmware,
            source,
            board,
            id,
            tick_ns,
            segments,
            rows,
            capabilities,
            configuration: is_configured.then_some(crc),
            reset: Reset::ALL.into_iter().find(|&cause| cause as u8 == reset)?,
            tick: rest.u32()?,
            nonce: rest.u32()?,
        })
    }
}

impl Configured {
    fn write(&self, body: &mut Body) {
        body.u32(self.crc);
        body.u32(self.tick);
        body.u32(self.law);
        body.u8(u8::from(self.home.is_some()));
        let home = self.home.unwrap_or_default();
        body.i32(home.pan);
        body.i32(home.tilt);
        body.u8(u8::from(self.heat.is_some()));
        let heat = self.heat.unwrap_or_default();
        body.f32(heat.pan);
        body.f32(heat.tilt);
        body.u32(self.shut_ticks);
    }

    fn read(rest: &mut Rest<'_>) -> Option<Self> {
        let (crc, tick, law, keeps) = (rest.u32()?, rest.u32()?, rest.u32()?, rest.flag()?);
        let home = PanTilt { pan: rest.i32()?, tilt: rest.i32()? };
        let (is_hot, heat) = (rest.flag()?, PanTilt { pan: rest.f32()?, tilt: rest.f32()? });
        let shut_ticks = rest.u32()?;
        Some(Self { crc, tick, law, home: keeps.then_some(home), heat: is_hot.then_some(heat), shut_ticks })
    }
}

impl WrongConfiguration {
    fn write(self, body: &mut Body) {
        let (why, word, bits) = match self {
            Self::Checksum(crc) => (1, 0, crc),
            Self::Length(bytes) => (2, 0, u32::from(bytes)),
            Self::Word { word, bits } => (3, word, bits),
            Self::Armed => (4, 0, 0),
        };
        body.u8(why);
        body.u16(word);
        body.u32(bits);
    }

    fn read(why: u8, rest: &mut Rest<'_>) -> Option<Self> {
        let (word, bits) = (rest.u16()?, rest.u32()?);
        match why {
            1 => Some(Self::Checksum(bits)),
            2 => Some(Self::Length(u16::try_from(bits).ok()?)),
            3 => Some(Self::Word { word, bits }),
            4 => Some(Self::Armed),
            _ => None,
        }
    }
}

fn write_fault(record: &FaultRecord, body: &mut Body) {
    body.u32(record.number);
    body.u8(record.fault.number());
    body.u8(match record.joint {
        None => 0,
        Some(Joint::Pan) => 1,
        Some(Joint::Tilt) => 2,
    });
    body.u32(record.tick);
    body.u8(u8::from(record.exceeded.is_some()));
    let exceeded = record.exceeded.unwrap_or(Exceeded { value: 0.0, bound: 0.0 });
    body.f32(exceeded.value);
    body.f32(exceeded.bound);
}

fn read_fault(rest: &mut Rest<'_>) -> Option<FaultRecord> {
    let (number, fault) = (rest.u32()?, Fault::from_number(rest.u8()?)?);
    let joint = match rest.u8()? {
        0 => None,
        1 => Some(Joint::Pan),
        2 => Some(Joint::Tilt),
        _ => return None,
    };
    let (tick, is_measured) = (rest.u32()?, rest.flag()?);
    let exceeded = Exceeded { value: rest.f32()?, bound: rest.f32()? };
    Some(FaultRecord { fault, number, tick, joint, exceeded: is_measured.then_some(exceeded) })
}
