//! Faults, and the table that lists them all.

pub(crate) mod row;
#[cfg(test)]
mod tests;

pub use row::{Clears, Measure, Motors, Soon};

/// One row of [`Fault::TABLE`]: all that is known of a fault but how it is looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    /// What is measured of it.
    pub measure: Measure,
    /// What becomes of the motors. The laser is dark from the tick on in which any fault is seen.
    pub motors: Motors,
    /// Whether counts may have been lost or made up: where the head stands is not known any more.
    pub loses_counts: bool,
    /// What makes an end of it.
    pub clears: Clears,
    /// What it means and what to look at, for `explain`.
    pub words: &'static str,
}

/// Makes the enum of its rows, so that each fault has exactly one and the compiler refuses a number that is given twice.
macro_rules! faults {
    ($($name:ident = $number:literal { what: $what:literal, $($field:ident: $value:expr,)* })*) => {
        /// A reason that stops a job: the laser is dark and stays dark until somebody arms again.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        #[repr(u8)]
        pub enum Fault {
            $(#[doc = $what] $name = $number,)*
        }

        impl Fault {
            /// Every fault.
            pub const ALL: [Fault; [$($number),*].len()] = [$(Fault::$name),*];

            /// What is known of each of them, in that order.
            pub const TABLE: [FaultRow; Fault::ALL.len()] = [$(FaultRow {
                fault: Fault::$name,
                number: $number,
                what: $what,
                $($field: $value,)*
            }),*];

            /// Its row of [`Fault::TABLE`].
            pub const fn row(self) -> &'static FaultRow {
                const TABLE: &[FaultRow] = &Fault::TABLE;
                let mut at = 0;
                // the last row needs no look: it is the one that is left
                while at + 1 < TABLE.len() && TABLE[at].number != self.number() {
                    at += 1;
                }
                &TABLE[at]
            }
        }
    };
}

faults! {
    EncoderJumped = 1 {
        what: "An encoder's count moved faster than the joint can.",
        code: "encoder-jumped",
        seen: "over one and a half counts beside the count the joint is expected on",
        soon: Soon::InTheTick,
        measure: Measure::counts("from where the joint was expected"),
        motors: Motors::Off,
        loses_counts: true,
        clears: Clears::FoundAndArmed,
        words: "An encoder's count moved faster than the joint can: look for a loose plug, interference or a slipping disc, and home the head before it is armed again.",
    }
    EncoderDead = 2 {
        what: "The model says the joint moved several counts, its encoder says nothing.",
        code: "encoder-dead",
        seen: "four counts of motion predicted, none counted, whether or not the last load still acts",
        soon: Soon::DarkThen(20),
        measure: Measure::counts("that the joint must have gone, and none counted"),
        motors: Motors::Off,
        loses_counts: true,
        clears: Clears::FoundAndArmed,
        words: "The motor was driven but its encoder did not move: look for a broken wire, a slipping disc or a blocked joint.",
    }
    EncoderNoisy = 3 {
        what: "Edges came where the joint was not, again and again.",
        code: "encoder-noisy",
        seen: "surprises of three counts together within some 50 ticks, or three lost counts within some seconds",
        soon: Soon::InTheTick,
        measure: Measure::counts("made up or lost of late"),
        motors: Motors::Off,
        loses_counts: true,
        clears: Clears::FoundAndArmed,
        words: "Edges came where the joint was not: look for interference on an encoder's lines, a loose plug or a missing shield.",
    }
    EncoderSlipping = 4 {
        what: "What an encoder shows and what its motor must have done do not belong together.",
        code: "encoder-slipping",
        seen: "surprises that the model cannot explain add up, or the encoder's scale has changed: dark at once; five test moves in the dark then show the same",
        soon: Soon::Words("dark at once, a fault after five test moves, some 2 s"),
        measure: Measure::share("beside the scale that was found first"),
        motors: Motors::Off,
        loses_counts: true,
        clears: Clears::FoundAndArmed,
        words: "What an encoder shows and what its motor must have done do not belong together: look for a slipping disc or belt, or an amplifier whose gain is not the rig file's.",
    }
    SetpointsStale = 5 {
        what: "Segments ran out in the middle of a job.",
        code: "setpoints-stale",
        seen: "no segment for this tick, and the end of the job was not told",
        soon: Soon::InTheTick,
        measure: Measure::NONE,
        motors: Motors::Held,
        loses_counts: false,
        clears: Clears::Armed,
        words: "Segments ran out in the middle of the job: the host was too slow or the connection broke.",
    }
    SetpointInvalid = 6 {
        what: "A segment leaves the joint limits, does not join the one before it, or says nothing of its tolerance.",
        code: "setpoint-invalid",
        seen: "a segment comes that leaves a joint's limits of angle, speed or acceleration anywhere, lets it stray further than any may, does not join the one before it, or is no number",
        soon: Soon::Words("when it comes, before its time"),
        measure: Measure::NONE,
        motors: Motors::Held,
        loses_counts: false,
        clears: Clears::Armed,
        words: "A segment left the limits of a joint's angle, speed or acceleration somewhere, let it stray further than any may, or did not join the one before it: plan the job again with this rig file.",
    }
    LimitReached = 7 {
        what: "The joint itself left its limits.",
        code: "limit-reached",
        seen: "a joint is believed outside its range, three counts beyond its end",
        soon: Soon::InTheTick,
        measure: Measure::angle("where the joint is believed"),
        motors: Motors::Held,
        loses_counts: false,
        clears: Clears::Armed,
        words: "A joint left its limits: check the zero of the head and the limits in the rig file.",
    }
    HoldTimedOut = 8 {
        what: "The head did not come back to its stroke in time.",
        code: "hold-timed-out",
        seen: "the head is off its stroke, dark, and not back",
        soon: Soon::Words("after control.hold_limit"),
        measure: Measure::ticks("off its stroke"),
        motors: Motors::Held,
        loses_counts: false,
        clears: Clears::Armed,
        words: "The head did not come back to its stroke in time: something holds it, or the gains do not suit this rig.",
    }
    AmplifierSaturated = 9 {
        what: "An amplifier gave all it has for too long.",
        code: "amplifier-saturated",
        seen: "an amplifier is at its limit, one way",
        soon: Soon::Ticks(300),
        measure: Measure::ticks("at its limit"),
        motors: Motors::Off,
        loses_counts: false,
        clears: Clears::Armed,
        words: "An amplifier gave all it has for 0.3 s: something blocks the joint, or the law and its bandwidth do not suit this rig.",
    }
    MotorHot = 10 {
        what: "A motor was driven harder than it can be cooled.",
        code: "motor-hot",
        seen: "I²t over what the motor stands",
        soon: Soon::InTheTick,
        measure: Measure::share("of the heat that full drive makes"),
        motors: Motors::Off,
        loses_counts: false,
        clears: Clears::Armed,
        words: "A motor was driven harder than it can be cooled: let it rest. control.motor_continuous and control.motor_heating in the rig file set the bound.",
    }
    LaserStuck = 11 {
        what: "A switch of the laser does not open.",
        code: "laser-stuck",
        seen: "the gate's switch is watched, and is closed, or light is seen, after a switch that was told to open must have; at any time, armed or not",
        soon: Soon::Ticks(3),
        measure: Measure::NONE,
        motors: Motors::Held,
        loses_counts: false,
        clears: Clears::Armed,
        words: "A switch of the laser did not open, and nobody can be sure that the other one holds: pull the laser's plug, then look for a relay whose contact sticks. safety.park_pan and park_tilt in the rig file say where the head turns then. Before it lights again, both switches are tried in the dark.",
    }
    HostLost = 12 {
        what: "The host stopped saying that it is there.",
        code: "host-lost",
        seen: "a host that has said that it is there says so no more",
        soon: Soon::Words("dark after control.host_silence, a fault after control.host_lost"),
        measure: Measure::ticks("of silence"),
        motors: Motors::Held,
        loses_counts: false,
        clears: Clears::Armed,
        words: "The host stopped saying that it is there: it ended, hangs, or the connection broke. It was dark since control.host_silence; control.host_lost sets when that is a fault.",
    }
    EstimateDiverged = 13 {
        what: "What is believed of a joint's speed does not add up to what its encoder counted.",
        code: "estimate-diverged",
        seen: "six counts between speed believed and counted, over some 20 ticks",
        soon: Soon::InTheTick,
        measure: Measure::counts("between the speed believed and what was counted"),
        motors: Motors::Off,
        loses_counts: true,
        clears: Clears::FoundAndArmed,
        words: "What is believed of a joint's speed does not add up to what its encoder counted: the observer does not suit this rig, or its model is far off.",
    }
    NotANumber = 14 {
        what: "Something that should be a number is none.",
        code: "not-a-number",
        seen: "an edge's stamp, an estimate or a law's result is no number",
        soon: Soon::InTheTick,
        measure: Measure::NONE,
        motors: Motors::Off,
        loses_counts: true,
        clears: Clears::FoundAndArmed,
        words: "A measurement, a setpoint or a law's result was no number: look for a broken edge stamp, and report it if there is none.",
    }
    EmergencyStop = 15 {
        what: "Somebody pressed an emergency stop, or its loop is broken.",
        code: "emergency-stop",
        seen: "the input is open",
        soon: Soon::InTheTick,
        measure: Measure::NONE,
        motors: Motors::Off,
        loses_counts: false,
        clears: Clears::FineAndArmed,
        words: "Somebody pressed an emergency stop, or its loop is broken: see why, release it, and arm again.",
    }
    InterlockOpen = 16 {
        what: "A lid or a door is open.",
        code: "interlock-open",
        seen: "the input is open",
        soon: Soon::InTheTick,
        measure: Measure::NONE,
        motors: Motors::Held,
        loses_counts: false,
        clears: Clears::FineAndArmed,
        words: "A lid or a door is open, or the line of its switch is broken: close it, and arm again.",
    }
    KeyOff = 17 {
        what: "The key switch is off.",
        code: "key-off",
        seen: "the input is open",
        soon: Soon::InTheTick,
        measure: Measure::NONE,
        motors: Motors::Held,
        loses_counts: false,
        clears: Clears::FineAndArmed,
        words: "The key switch is off, or its line is broken: turn the key, and arm again.",
    }
    AmplifierFault = 18 {
        what: "An amplifier says that something is wrong with it or its motor.",
        code: "amplifier-fault",
        seen: "the input of either joint is open",
        soon: Soon::InTheTick,
        measure: Measure::NONE,
        motors: Motors::Off,
        loses_counts: false,
        clears: Clears::FineAndArmed,
        words: "An amplifier says by its own line that something is wrong: look for a short circuit, too much current or heat, and at its lamp; most need their supply switched off and on.",
    }
    SupplyLow = 19 {
        what: "The supply gives less than it should.",
        code: "supply-low",
        seen: "the input is open",
        soon: Soon::InTheTick,
        measure: Measure::NONE,
        motors: Motors::Off,
        loses_counts: false,
        clears: Clears::FineAndArmed,
        words: "The supply gives less than it should: look at its cable, its fuse and what else hangs on it.",
    }
    TooHot = 20 {
        what: "A thermal switch says that laser, amplifiers or motors are too hot.",
        code: "too-hot",
        seen: "the input is open",
        soon: Soon::InTheTick,
        measure: Measure::NONE,
        motors: Motors::Off,
        loses_counts: false,
        clears: Clears::FineAndArmed,
        words: "A thermal switch opened: laser, amplifiers or motors are too hot. Let them cool, look at fans and vents, and arm again.",
    }
    TickLate = 21 {
        what: "A tick came too late for what was reckoned for it.",
        code: "tick-late",
        seen: "the hardware measures it, and a tick took more than one and a half times its length",
        soon: Soon::InTheTick,
        measure: Measure { digits: 2, ..Measure::ticks("that a tick took") },
        motors: Motors::Held,
        loses_counts: false,
        clears: Clears::Armed,
        words: "A tick of the controller came too late: something else held its processor. See what runs beside it; if nothing does, report it.",
    }
    LightStood = 22 {
        what: "A plan went on asking for light where as much has fallen as may.",
        code: "light-stood",
        seen: "a plan asks for light where the light budget is spent, which darkens at once",
        soon: Soon::DarkThen(100),
        measure: Measure::ticks("asked for in vain"),
        motors: Motors::Held,
        loses_counts: false,
        clears: Clears::Armed,
        words: "The job went on asking for light where that had stood as long as it may: draw faster, or with a weaker laser and a longer safety.standing in the rig file.",
    }
    EncoderScale = 23 {
        what: "What an encoder shows is another share of what its motor must have done than the rig file allows.",
        code: "encoder-scale",
        seen: "before the first light, five test moves in the dark show an angle beyond control.scale_tolerance from what the motor must have made",
        soon: Soon::Words("dark from the start, a fault after five test moves, some 2 s"),
        measure: Measure::share("beside what the motor must have made"),
        motors: Motors::Off,
        loses_counts: true,
        clears: Clears::FoundAndArmed,
        words: "Before the first light, an encoder showed more or less of a motion than its motor must have made. Check model.encoder.counts_per_rev (half, double and four times are the usual slips), then the motor's torque and the joint's inertia: tracelight lab identify finds them. control.scale_tolerance sets the bound.",
    }
    Bumped = 24 {
        what: "Somebody bumped into what the head stands on, and it does not stand where it stood.",
        code: "bumped",
        seen: "a gyroscope on the foot says that it has turned further than safety.turned, once it is still again; without one, a joint was thrown aside on a lit stroke by one and a quarter counts or more within some hundredths of a second and is no faster afterwards",
        soon: Soon::Words("dark in the tick with a gyroscope, a fault 0.2 s after it is still; without one, 65 ms after the first surprise"),
        measure: Measure::angle("that the foot has turned"),
        motors: Motors::Held,
        loses_counts: false,
        clears: Clears::Armed,
        words: "The head was bumped and does not stand where it stood, or nothing tells that it does: look where it points before it is armed again, or calibrate it anew; with a camera it is found again by itself. A gyroscope on the foot sees bumps that encoders do not feel.",
    }
    LaserDark = 25 {
        what: "There is no light where there should be.",
        code: "laser-dark",
        seen: "the gate's switch is watched, and is open, or light is watched, and none is seen, after all that was told to close must have",
        soon: Soon::Ticks(3),
        measure: Measure::NONE,
        motors: Motors::Held,
        loses_counts: false,
        clears: Clears::Armed,
        words: "No light came where it was wanted, or the gate's switch did not close: see whether the laser has its supply and the relay's coil is driven, and whether the photodiode that watches the light is covered or broken: nobody would see light that stays on.",
    }
    BoardReset = 26 {
        what: "The board that drives the head was reset.",
        code: "board-reset",
        seen: "a board greets unasked, or knows nothing of its configuration any more",
        soon: Soon::Words("dark at once, a fault when it greets"),
        measure: Measure::NONE,
        motors: Motors::Off,
        loses_counts: true,
        clears: Clears::FoundAndArmed,
        words: "The board that drives the head was reset, by its button, its supply or its watchdog, and does not know where the head stands: look at its supply, and home the head before it is armed again.",
    }
    TwinDiverged = 27 {
        what: "The host's own controller, given what the board sensed, does not do what the board did.",
        code: "twin-diverged",
        seen: "volts, switches or state of a tick differ in any bit",
        soon: Soon::Words("when the row of the tick comes"),
        measure: Measure::NONE,
        motors: Motors::Held,
        loses_counts: true,
        clears: Clears::FoundAndArmed,
        words: "The host's own controller, given what the board sensed, does not do what the board did: one of both has a memory fault, or is another program. Load the board's program of this version; if it comes again, the board is broken.",
    }
    LinkLost = 28 {
        what: "The connection to the board is gone, or rows of it are lost for good.",
        code: "link-lost",
        seen: "the board does not answer for ten seconds, or cannot tell again what was lost",
        soon: Soon::Words("dark after control.host_silence, a fault after 10 s"),
        measure: Measure::NONE,
        motors: Motors::Held,
        loses_counts: true,
        clears: Clears::FoundAndArmed,
        words: "The connection to the board was gone for so long that nobody knows what it did meanwhile: look at the cable, and home the head before it is armed again.",
    }
}

/// Of which faults something is true, a bit each by number: a board asks without keeping the words of the table.
const BLIND: u64 = bits(true);
const LOSES_COUNTS: u64 = bits(false);

/// Those that leave the motors off, or those that lose counts.
const fn bits(off: bool) -> u64 {
    let (table, mut at, mut set) = (Fault::TABLE, 0, 0);
    while at < table.len() {
        let row = &table[at];
        assert!(row.number < 64, "a number that has no bit");
        if if off { matches!(row.motors, Motors::Off) } else { row.loses_counts } {
            set |= 1 << row.number;
        }
        at += 1;
    }
    set
}

impl Fault {
    /// Its number on a wire, from 1.
    pub const fn number(self) -> u8 {
        self as u8
    }

    /// The fault of that number, if there is one.
    pub fn from_number(number: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|fault| fault.number() == number)
    }

    /// Stable code for scripts and `explain`.
    pub const fn code(self) -> &'static str {
        self.row().code
    }

    /// The fault of that code, if there is one.
    pub fn from_code(code: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|fault| fault.code() == code)
    }

    /// What it means and what to look at.
    pub const fn words(self) -> &'static str {
        self.row().words
    }

    /// Whether there is nothing left to control a motor by, or to drive it with, so that it gets no volts.
    pub const fn leaves_motors_blind(self) -> bool {
        BLIND & (1 << self.number()) != 0
    }

    /// Whether counts may have been lost or invented, so that the head's position is unknown.
    pub const fn loses_counts(self) -> bool {
        LOSES_COUNTS & (1 << self.number()) != 0
    }
}
