//! Columns of the fault table: detection time, effect on the motors, how the fault is cleared.

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

/// What a fault measures, for words.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Measure {
    /// Unit in which it is told.
    pub unit: &'static str,
    /// What it is; no sentence.
    pub what: &'static str,
    /// How many of that unit are one of the base unit: ticks, radians, counts or shares.
    pub factor: f32,
    /// Digits after the point.
    pub digits: u8,
}

impl Measure {
    /// Of faults that are no number's.
    pub const NONE: Self = Self { unit: "", what: "", factor: 1.0, digits: 0 };

    /// Counts of an encoder.
    pub(super) const fn counts(what: &'static str) -> Self {
        Self { unit: "counts", what, factor: 1.0, digits: 1 }
    }

    /// Whole ticks, told in ms.
    pub(super) const fn ticks(what: &'static str) -> Self {
        Self { unit: "ms", what, factor: 1.0, digits: 0 }
    }

    /// Radians, told in degrees.
    pub(super) const fn angle(what: &'static str) -> Self {
        Self { unit: "degrees", what, factor: 180.0 / core::f32::consts::PI, digits: 2 }
    }

    /// A share, told in percent.
    pub(super) const fn share(what: &'static str) -> Self {
        Self { unit: "%", what, factor: 100.0, digits: 1 }
    }
}
