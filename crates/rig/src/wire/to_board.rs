//! What a host says.

use super::bytes::{Body, Rest};
use super::packet::{MOST_PACKET, packed};
use super::{MAGIC, head};
use crate::{Command, PanTilt, RateLimit, Segment};

/// What a host says in a packet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ToBoard<'a> {
    /// Greets, first of all and after any silence; sequence numbers begin at 0 with it. The rig is disarmed by it.
    Hello {
        /// [Version](super::VERSION) that it speaks.
        version: (u8, u8),
        /// A number of this connection, drawn anew for each.
        session: u32,
        /// Its program's version, ended by zeros.
        program: [u8; 8],
    },
    /// A piece of the configuration, from this byte on.
    Configure {
        /// Place of the first byte.
        offset: u16,
        /// At most 200 of them.
        bytes: &'a [u8],
    },
    /// All of the configuration was sent: it is in force from now on, the controller begins anew, dark. Refused while it is armed.
    Commit {
        /// Bytes of it.
        length: u16,
        /// Their [checksum](super::crc32).
        crc: u32,
    },
    /// A command that waits for its turn.
    Order(Order),
    /// The host is there: [`Command::KeepAlive`].
    KeepAlive {
        /// The host's clock, µs; comes back in the answer.
        host_us: u64,
    },
    /// [`Command::Disarm`], at once. Of the commands before that number those that let light out and did not come yet are void.
    Disarm {
        /// Number of the command that the host sends next.
        before: u16,
        /// Number of this Disarm, one more than that of the one before it: rows say which was the last that acted.
        number: u16,
    },
    /// Asks for rows again.
    Again {
        /// Tick of the first one.
        from: u32,
        /// How many.
        count: u16,
    },
    /// A fault was read; it need not be told again.
    Seen {
        /// Its number.
        number: u32,
    },
}

/// A command that waits for its turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    /// Its number: one more than that of the command before it.
    pub sequence: u16,
    /// What to do.
    pub ask: Ask,
}

/// What an order asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ask {
    /// [`Command::Arm`], void unless the number is greater than that of all before it, since power-up: a packet that is said again does not arm.
    Arm {
        /// The number.
        nonce: u32,
        /// Latest fault that was read.
        acknowledges: u32,
    },
    /// Any other command, but for those that wait for nobody.
    Command(Command),
}

impl Ask {
    /// Whether it lets light out: void after a Disarm that was sent later.
    pub const fn lights(&self) -> bool {
        matches!(self, Self::Arm { .. } | Self::Command(Command::Point(_)))
    }

    /// What a controller is told that obeys it.
    pub const fn command(&self) -> Command {
        match *self {
            Self::Arm { acknowledges, .. } => Command::Arm { acknowledges },
            Self::Command(command) => command,
        }
    }
}

mod kind {
    pub(super) const HELLO: u8 = 0x01;
    pub(super) const CONFIGURE: u8 = 0x02;
    pub(super) const COMMIT: u8 = 0x03;
    pub(super) const APPEND: u8 = 0x10;
    pub(super) const FINISH: u8 = 0x11;
    pub(super) const ARM: u8 = 0x12;
    pub(super) const HOME: u8 = 0x13;
    pub(super) const UNHOME: u8 = 0x14;
    pub(super) const POINT: u8 = 0x15;
    pub(super) const SPEED: u8 = 0x16;
    pub(super) const PAUSE: u8 = 0x17;
    pub(super) const ABANDON: u8 = 0x18;
    pub(super) const ACKNOWLEDGE: u8 = 0x19;
    pub(super) const KEEP_ALIVE: u8 = 0x20;
    pub(super) const DISARM: u8 = 0x21;
    pub(super) const AGAIN: u8 = 0x23;
    pub(super) const SEEN: u8 = 0x24;
}

impl<'a> ToBoard<'a> {
    /// As the body of a packet of a connection.
    pub fn body(&self, connection: u8) -> Body {
        let mut body = Body::new();
        let head = |body: &mut Body, kind: u8, sequence: u16| head(body, kind, connection, sequence);
        match *self {
            Self::Hello { version: (major, minor), session, program } => {
                super::head(&mut body, kind::HELLO, 0, 0);
                body.slice(&MAGIC);
                body.u8(major);
                body.u8(minor);
                body.u32(session);
                body.slice(&program);
            }
            Self::Configure { offset, bytes } => {
                head(&mut body, kind::CONFIGURE, 0);
                body.u16(offset);
                body.slice(bytes);
            }
            Self::Commit { length, crc } => {
                head(&mut body, kind::COMMIT, 0);
                body.u16(length);
                body.u32(crc);
            }
            Self::Order(order) => order.write(&mut body, connection),
            Self::KeepAlive { host_us } => {
                head(&mut body, kind::KEEP_ALIVE, 0);
                body.u64(host_us);
            }
            Self::Disarm { before, number } => {
                head(&mut body, kind::DISARM, before);
                body.u16(number);
            }
            Self::Again { from, count } => {
                head(&mut body, kind::AGAIN, 0);
                body.u32(from);
                body.u16(count);
            }
            Self::Seen { number } => {
                head(&mut body, kind::SEEN, 0);
                body.u32(number);
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
            kind::HELLO => {
                let magic: [u8; 4] = rest.bytes()?;
                if magic != MAGIC {
                    return None;
                }
                let version = (rest.u8()?, rest.u8()?);
                Self::Hello { version, session: rest.u32()?, program: rest.bytes()? }
            }
            kind::CONFIGURE => Self::Configure { offset: rest.u16()?, bytes: rest.all() },
            kind::COMMIT => Self::Commit { length: rest.u16()?, crc: rest.u32()? },
            kind::KEEP_ALIVE => Self::KeepAlive { host_us: rest.u64()? },
            kind::DISARM => Self::Disarm { before: sequence, number: rest.u16()? },
            kind::AGAIN => Self::Again { from: rest.u32()?, count: rest.u16()? },
            kind::SEEN => Self::Seen { number: rest.u32()? },
            _ => Self::Order(Order { sequence, ask: ask(kind, &mut rest)? }),
        };
        let numbered = matches!(said, Self::Order(_) | Self::Disarm { .. });
        (rest.is_empty() && (numbered || sequence == 0)).then_some((said, connection))
    }
}

impl Order {
    fn write(&self, body: &mut Body, connection: u8) {
        let mut begin = |kind: u8| head(body, kind, connection, self.sequence);
        match self.ask {
            Ask::Arm { nonce, acknowledges } => {
                begin(kind::ARM);
                body.u32(nonce);
                body.u32(acknowledges);
            }
            Ask::Command(Command::Append(segment)) => {
                begin(kind::APPEND);
                write_segment(&segment, body);
            }
            Ask::Command(Command::Finish) => begin(kind::FINISH),
            Ask::Command(Command::Home(PanTilt { pan, tilt })) => {
                begin(kind::HOME);
                body.i32(pan);
                body.i32(tilt);
            }
            Ask::Command(Command::Unhome) => begin(kind::UNHOME),
            Ask::Command(Command::Point(ticks)) => {
                begin(kind::POINT);
                body.u16(ticks);
            }
            Ask::Command(Command::Speed(rate)) => {
                begin(kind::SPEED);
                body.f32(rate);
            }
            Ask::Command(Command::Pause) => begin(kind::PAUSE),
            Ask::Command(Command::Abandon) => begin(kind::ABANDON),
            Ask::Command(Command::Acknowledge { fault }) => {
                begin(kind::ACKNOWLEDGE);
                body.u32(fault);
            }
            // these have packets of their own
            Ask::Command(Command::Arm { .. } | Command::Disarm | Command::KeepAlive) => {}
        }
    }
}

fn ask(kind: u8, rest: &mut Rest<'_>) -> Option<Ask> {
    let command = match kind {
        kind::ARM => return Some(Ask::Arm { nonce: rest.u32()?, acknowledges: rest.u32()? }),
        kind::APPEND => Command::Append(read_segment(rest)?),
        kind::FINISH => Command::Finish,
        kind::HOME => Command::Home(PanTilt { pan: rest.i32()?, tilt: rest.i32()? }),
        kind::UNHOME => Command::Unhome,
        kind::POINT => Command::Point(rest.u16()?),
        kind::SPEED => Command::Speed(rest.f32()?),
        kind::PAUSE => Command::Pause,
        kind::ABANDON => Command::Abandon,
        kind::ACKNOWLEDGE => Command::Acknowledge { fault: rest.u32()? },
        _ => return None,
    };
    Some(Ask::Command(command))
}

fn write_segment(segment: &Segment, body: &mut Body) {
    let Segment { start_tick, ticks, coefficients, tolerance_rad, gate, rate_limit } = segment;
    body.u32(*start_tick);
    body.u16(*ticks);
    body.u8(u8::from(*gate));
    let PanTilt { pan, tilt } = coefficients;
    pan.iter().chain(tilt).for_each(|&value| body.f32(value));
    [tolerance_rad.pan, tolerance_rad.tilt, rate_limit.start, rate_limit.end]
        .into_iter()
        .for_each(|value| body.f32(value));
}

fn read_segment(rest: &mut Rest<'_>) -> Option<Segment> {
    let (start_tick, ticks, gate) = (rest.u32()?, rest.u16()?, rest.flag()?);
    let mut quintic = || {
        let mut coefficients = [0.0; 6];
        for value in &mut coefficients {
            *value = rest.f32()?;
        }
        Some(coefficients)
    };
    let coefficients = PanTilt { pan: quintic()?, tilt: quintic()? };
    let tolerance_rad = PanTilt { pan: rest.f32()?, tilt: rest.f32()? };
    let rate_limit = RateLimit { start: rest.f32()?, end: rest.f32()? };
    Some(Segment { start_tick, ticks, coefficients, tolerance_rad, gate, rate_limit })
}
