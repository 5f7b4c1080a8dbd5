use std::fmt;

use tracelight_rig::TICK_NS;
use tracelight_rig::wire::{VERSION, WrongConfiguration};

/// Why a head behind a wire cannot be driven, or can no more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trouble {
    /// Nobody answered.
    Silent {
        /// For how long, µs.
        waited_us: u64,
    },
    /// The board speaks another version of the wire.
    Version {
        /// Its own.
        board: (u8, u8),
    },
    /// The board's ticks are of another length.
    TickLength {
        /// Its own, ns.
        board_ns: u32,
    },
    /// The board holds more segments ahead than a twin can follow.
    Segments {
        /// How many it holds.
        board: u16,
    },
    /// The board computes another law.
    Law {
        /// Hash of the host's.
        host: u32,
        /// Hash of the board's.
        board: u32,
    },
    /// The board refused the configuration.
    Configuration(WrongConfiguration),
    /// The board was reset: it knows neither its configuration nor where it stands.
    Reset,
    /// Rows are lost that it cannot tell again: nobody knows what happened in them.
    LostRows {
        /// Tick of the first one.
        from: u32,
        /// Tick of the next one that it can tell.
        to: u32,
    },
    /// The twin does not do what the board did.
    Diverged(Divergence),
}

/// Where a twin and its board first differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Divergence {
    /// In which tick.
    pub tick: u32,
    /// In what.
    pub what: &'static str,
    /// What the twin has.
    pub host: f64,
    /// What the board has.
    pub board: f64,
}

impl fmt::Display for Trouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Silent { waited_us } => write!(
                f,
                "the board has not answered for {:.1} s: see whether it has power, whether the cable holds, and whether its program is Tracelight's",
                waited_us as f64 * 1e-6
            ),
            Self::Version { board: (major, minor) } => write!(
                f,
                "the board speaks version {major}.{minor} of the wire, this program version {}.{}: load the board's program of this version",
                VERSION.0, VERSION.1
            ),
            Self::TickLength { board_ns } => {
                write!(f, "the board's ticks are {board_ns} ns long; this program's law is made for {TICK_NS} ns")
            }
            Self::Segments { board } => {
                write!(f, "the board holds {board} segments ahead, more than this program follows")
            }
            Self::Law { host, board } => write!(
                f,
                "the board computes another law than this program (hash {board:08x}, here {host:08x}): load the board's program of this version"
            ),
            Self::Configuration(wrong) => match wrong {
                WrongConfiguration::Checksum(crc) => {
                    write!(f, "the configuration came spoilt to the board (checksum {crc:08x}): try again")
                }
                WrongConfiguration::Length(bytes) => {
                    write!(f, "the board needs a configuration of {bytes} bytes: load the board's program of this version")
                }
                WrongConfiguration::Word { word, bits } => write!(
                    f,
                    "the board refuses word {word} of its configuration, {} ({bits:#010x})",
                    f32::from_bits(bits)
                ),
                WrongConfiguration::Armed => f.write_str("the board is armed and takes no configuration: disarm it"),
            },
            Self::Reset => f.write_str(
                "the board was reset, and does not know any more where the head stands: home it again before it draws",
            ),
            Self::LostRows { from, to } => write!(
                f,
                "the board's ticks {from} to {to} are lost, and it cannot tell them again: home the head again before it draws"
            ),
            Self::Diverged(Divergence { tick, what, host, board }) => write!(
                f,
                "in tick {tick} the board's {what} is {board} and this program's own controller has {host}: a memory fault of the board, \
                 or one of both is another program"
            ),
        }
    }
}

impl std::error::Error for Trouble {}
