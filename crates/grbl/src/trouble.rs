//! What can be wrong with a board, in words.

use std::fmt;

use crate::codes::{alarm_text, error_text};

/// A setting of a board.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Its number.
    pub number: u16,
    /// Its value, if it has one.
    pub value: Option<f64>,
    /// What it counts.
    pub means: &'static str,
}

/// Why a head on a Grbl board cannot be driven, or can no more.
#[derive(Clone, Debug, PartialEq)]
pub enum Trouble {
    /// Nobody answered.
    Silent {
        /// For how long, s.
        waited_s: f64,
    },
    /// Somebody says what no Grbl says.
    Stranger {
        /// What.
        said: String,
    },
    /// The board does something already, or is in a state in which it moves nothing.
    Busy {
        /// What.
        does: &'static str,
    },
    /// A setting has no value that can be one.
    Unset(Setting),
    /// A setting has to be another one.
    Wrong {
        /// Its number.
        number: u16,
        /// What it is.
        value: f64,
        /// What it has to be.
        wanted: f64,
        /// Why.
        why: &'static str,
    },
    /// The board refused a line.
    Refused {
        /// The line.
        line: String,
        /// The number of its reason.
        code: u16,
    },
    /// The board stopped and is locked.
    Alarm {
        /// The number of its reason.
        code: u16,
    },
    /// The board was reset by somebody else, or by itself.
    Reset,
    /// Its door is open.
    Door,
}

impl fmt::Display for Trouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Silent { waited_s } => write!(
                f,
                "the board has not answered for {waited_s:.1} s: see whether it has power, whether the cable holds, and whether its firmware is Grbl 1.1, grblHAL or \
                 FluidNC at 115200 baud"
            ),
            Self::Stranger { said } => write!(f, "no Grbl is there: it says \"{said}\""),
            Self::Busy { does } => {
                write!(f, "the board {does}: end that with the program that began it, or switch the board off and on")
            }
            Self::Unset(Setting { number, value, means }) => {
                let is = value.map_or_else(|| "is not told".to_owned(), |value| format!("is {value}"));
                write!(f, "the board's setting ${number} {is}; give it the {means}")
            }
            Self::Wrong { number, value, wanted, why } => {
                write!(f, "the board's setting ${number} is {value}: set ${number}={wanted} ({why})")
            }
            Self::Refused { line, code } => {
                write!(f, "the board refused the line {line} (error {code}): {}", error_text(*code))
            }
            Self::Alarm { code } => write!(
                f,
                "the board stopped and is dark (alarm {code}): {}; home the head again before it draws",
                alarm_text(*code)
            ),
            Self::Reset => f.write_str(
                "the board was reset while it was driven, and is dark: somebody pressed its button, or its supply broke down; home the head again before it draws",
            ),
            Self::Door => f.write_str(
                "the board's door is open, by its door input, and it is dark: close it, see that nobody is in the way, then go on with tracelight resume",
            ),
        }
    }
}

impl std::error::Error for Trouble {}
