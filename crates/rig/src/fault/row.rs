//! What a row of the table of faults says.

use crate::Fault;

/// One row of [`Fault::TABLE`]: all that is known of a fault but how it is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct FaultRow {
    /// Which it is.
    pub fault: Fault,
    /// Its number on a wire, from 1; that of a fault which is no more is never given to another.
    pub number: u8,
    /// Stable code for scripts and `explain`.
    pub code: &'static str,
    /// What it is, one sentence.
    pub what: &'static str,
    /// When it is seen; no sentence.
    pub seen: &'static str,
    /// How soon.
    pub soon: Soon,
    /// What becomes of the motors. The laser is dark from the tick on in which any fault is seen.
    pub motors: Motors,
    /// Whether counts may have been lost or made up: where the head stands is not known any more.
    pub loses_counts: bool,
    /// What makes an end of it.
    pub clears: Clears,
    /// What it means and what to look at, for `explain`.
    pub words: &'static str,
}

/// How soon a fault is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Soon {
    /// In the tick whose senses show it.
    InTheTick,
    /// After so many ticks.
    Ticks(u16),
    /// Dark at once, a fault once that has gone on for so many ticks.
    DarkThen(u16),
    /// As the words say, where it depends on more than time.
    Words(&'static str),
}

/// What becomes of the motors after a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Motors {
    /// They hold the head where the plan's clock stands.
    Held,
    /// They get no volts: there is nothing left to control them by, or nothing to drive them with.
    Off,
}

/// What makes an end of a fault. Whatever it is, nobody but who arms does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Clears {
    /// Somebody arms.
    Armed,
    /// Somebody arms once the input is fine again; arming before that changes nothing.
    FineAndArmed,
    /// The head is homed or found again, then somebody arms.
    FoundAndArmed,
}

impl core::fmt::Display for Soon {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Soon::InTheTick => f.write_str("in the tick"),
            Soon::Ticks(ticks) => write!(f, "after {ticks} ticks"),
            Soon::DarkThen(ticks) => write!(f, "dark at once, a fault after {ticks} ticks of it"),
            Soon::Words(words) => f.write_str(words),
        }
    }
}

impl Motors {
    /// In words, no sentence.
    pub const fn words(self) -> &'static str {
        match self {
            Motors::Held => "motors hold",
            Motors::Off => "motors get no volts",
        }
    }
}

impl Clears {
    /// In words, no sentence.
    pub const fn words(self) -> &'static str {
        match self {
            Clears::Armed => "arm",
            Clears::FineAndArmed => "when the input is fine again, arm",
            Clears::FoundAndArmed => "home or find the head, then arm",
        }
    }
}
