//! Reasons for darkness in a tick, and the table that lists them all.

/// One row of [`Darkness::TABLE`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct DarknessRow {
    /// Which it is.
    pub reason: Darkness,
    /// Its bit in a [`DarknessSet`]; that of a reason which is no more is never given to another.
    pub bit: u8,
    /// Stable code for logs and `explain`.
    pub code: &'static str,
    /// When it holds, one sentence.
    pub what: &'static str,
    /// Description in the past tense, for `explain` and reports.
    pub words: &'static str,
    /// What a user can do about it, for `explain`.
    pub advice: &'static str,
}

/// Makes the enum of its rows, so that each reason has exactly one and the compiler refuses a bit that is given twice.
macro_rules! darknesses {
    ($($name:ident = $bit:literal { what: $what:literal, $($field:ident: $value:expr,)* })*) => {
        /// A reason why the gate is shut in this tick.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[repr(u8)]
        pub enum Darkness {
            $(#[doc = $what] $name = $bit,)*
        }

        impl Darkness {
            /// Every reason, in bit order.
            pub const ALL: [Darkness; [$($bit),*].len()] = [$(Darkness::$name),*];

            /// What is known of each of them, in that order.
            pub const TABLE: [DarknessRow; Darkness::ALL.len()] = [$(DarknessRow {
                reason: Darkness::$name,
                bit: $bit,
                what: $what,
                $($field: $value,)*
            }),*];

            /// Its row of [`Darkness::TABLE`].
            pub const fn row(self) -> &'static DarknessRow {
                const TABLE: &[DarknessRow] = &Darkness::TABLE;
                let mut at = 0;
                // the last row needs no look: it is the one that is left
                while at + 1 < TABLE.len() && TABLE[at].bit != self as u8 {
                    at += 1;
                }
                &TABLE[at]
            }
        }
    };
}

darknesses! {
    Planned = 0 {
        what: "The plan wants no light here.",
        code: "planned",
        words: "The plan wants no light here.",
        advice: "Nothing: the head is on its way between strokes.",
    }
    Disarmed = 1 {
        what: "Nobody armed the rig.",
        code: "disarmed",
        words: "Nobody armed the rig.",
        advice: "Arm it.",
    }
    FollowingError = 2 {
        what: "A joint's following error is over its segment's tolerance.",
        code: "following-error",
        words: "A joint was further from its setpoint than the stroke allows.",
        advice: ASTRAY,
    }
    SpotError = 3 {
        what: "The two following errors together put the spot too far from its setpoint.",
        code: "spot-error",
        words: "Both joints together put the spot too far from its stroke.",
        advice: ASTRAY,
    }
    Holding = 4 {
        what: "The plan's clock stands still until the head is back on its stroke.",
        code: "holding",
        words: "The plan waited until the head was back on its stroke.",
        advice: "Nothing, if it is rare: the head goes back to where it left and on from there. If not, look at the darkening before it.",
    }
    OutOfBounds = 5 {
        what: "A setpoint lies outside the joint limits.",
        code: "out-of-bounds",
        words: "A setpoint lay outside the joint limits.",
        advice: "Make the picture smaller or shift it; range_min and range_max in the rig file set the bound.",
    }
    Stale = 6 {
        what: "No valid setpoint for this tick.",
        code: "stale",
        words: "There was no valid setpoint for this tick.",
        advice: "Nothing before the first and after the last stroke. Within a job the host was too slow.",
    }
    Faulted = 7 {
        what: "A [`Fault`](crate::Fault) is latched.",
        code: "faulted",
        words: "A fault is latched.",
        advice: "Look up the fault's own code.",
    }
    Doubtful = 8 {
        what: "An encoder has shown no edge where its joint should have passed several, or does not fit what its motor does, or a count was put back a moment ago: it may be dead or slip or lose counts, or somebody holds the head.",
        code: "doubtful",
        words: "An encoder showed no edge where its joint should have passed several, does not fit what its motor does, or lost a count.",
        advice: "See whether somebody holds the head; if not, an encoder is going dead or loses counts: look at its cable and its disc.",
    }
    Unhomed = 9 {
        what: "The rig was powered up and not told since where its joints stand: nobody knows where light would fall.",
        code: "unhomed",
        words: "The rig was powered up and not homed since: nobody knew where light would fall.",
        advice: "Encoders count from where they are powered up. Have a camera find where it stands: tracelight calibrate head --home --camera …",
    }
    Standing = 10 {
        what: "As much light had fallen in this place as may.",
        code: "standing",
        words: "As much light had fallen in this place as may.",
        advice: "Draw faster, or larger: a lit spot that stands, or comes back to its place again and again, is dark in time. safety.standing in the rig file sets the bound, by laser.power.",
    }
    HostSilent = 11 {
        what: "No host said of late that it is there.",
        code: "host-silent",
        words: "No host had said of late that it is there.",
        advice: "Nothing, if it is rare: the plan waits, and goes on once the host is heard. If it comes again and again, see whether the host has other work to do and whether the connection holds. control.host_silence sets the bound.",
    }
    Untested = 12 {
        what: "An encoder was not seen to follow its motor yet, or something spoke against it since: a little move in the dark is to tell. Or the laser's two switches were not tried yet, where something watches them.",
        code: "untested",
        words: "An encoder had not been seen to follow its motor, or something spoke against it since; or the laser's switches had not been tried.",
        advice: "Nothing, if it is rare: before the first light the switches are tried in some hundredths of a second, and then as after a surprise such as a push, the head makes a little move in the dark and goes on. If it comes again and again, see encoder-slipping.",
    }
    Jolted = 13 {
        what: "What the head stands on turns, by the gyroscope that is fixed to it, or was not seen to stand still yet.",
        code: "jolted",
        words: "What the head stands on turned, or had not been seen to stand still yet.",
        advice: "Nothing, if it is rare: once it stands still, and where it stood, the head goes on; if it stands elsewhere, that is the fault bumped. If it comes again and again, set the head on something firmer, or say in the rig file how that gives way: model.foot. safety.jolt sets the bound.",
    }
}

const ASTRAY: &str = "See whether somebody or something pushes the head, whether --speed or --distance is more than it can hold, and whether the friction and gains in the rig file are its own. control.tolerance sets the bound.";

impl Darkness {
    /// Stable code for logs and `explain`.
    pub const fn code(self) -> &'static str {
        self.row().code
    }

    /// The reason of that code, if there is one.
    pub fn from_code(code: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|reason| reason.code() == code)
    }

    /// Description of the reason in the past tense.
    pub const fn words(self) -> &'static str {
        self.row().words
    }
}

/// The reasons that hold at once; empty means the gate is open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DarknessSet(u16);

impl DarknessSet {
    /// Adds a reason when `holds` is true.
    pub fn insert_if(&mut self, holds: bool, reason: Darkness) {
        if holds {
            self.0 |= 1 << reason as u16;
        }
    }

    /// Whether a reason is in the set.
    pub const fn contains(self, reason: Darkness) -> bool {
        self.0 & (1 << reason as u16) != 0
    }

    /// Whether nothing speaks against light.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// One bit a reason, [`Darkness::ALL`] order.
    pub const fn bits(self) -> u16 {
        self.0
    }

    /// Of these bits; those of no reason are kept.
    pub const fn from_bits(bits: u16) -> Self {
        Self(bits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What logs and scripts know. A row may be added at the end; none may change.
    const GOLDEN: &[(u8, &str)] = &[
        (0, "planned"),
        (1, "disarmed"),
        (2, "following-error"),
        (3, "spot-error"),
        (4, "holding"),
        (5, "out-of-bounds"),
        (6, "stale"),
        (7, "faulted"),
        (8, "doubtful"),
        (9, "unhomed"),
        (10, "standing"),
        (11, "host-silent"),
        (12, "untested"),
        (13, "jolted"),
    ];

    #[test]
    fn bits_and_codes_are_those_that_logs_and_scripts_know() {
        let now = Darkness::TABLE.map(|row| (row.bit, row.code));
        assert_eq!(now, GOLDEN);
    }

    #[test]
    fn every_reason_has_one_row_with_a_bit_and_a_code_of_its_own() {
        for reason in Darkness::ALL {
            assert_eq!((reason.row().reason, reason.row().bit), (reason, reason as u8));
            assert!(reason.row().bit < 16, "{reason:?} has no bit in the set");
            assert_eq!(Darkness::from_code(reason.code()), Some(reason));
        }
    }
}
