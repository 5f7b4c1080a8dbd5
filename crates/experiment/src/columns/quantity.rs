use tracelight_units::{
    CURRENTS, LENGTHS, SHAFT_ANGLES, SHAFT_SPEEDS, STAMPS, TORQUES, Unit, VOLTAGES, factor,
};

/// What a column of a log may hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// When a row was written, s.
    Time,
    /// At the amplifier's input, V.
    Volt,
    /// What an encoder counted, in counts of the rig's encoder.
    Count,
    /// Angle of the joint, rad.
    Angle,
    /// Speed of the joint, rad/s.
    Speed,
    /// Through the motor, A.
    Ampere,
    /// On the joint, N m.
    Torque,
    /// 1 or −1: which way a joint came to its place.
    Way,
    /// Where the spot is, m.
    Spot,
    /// Which joint: pan or tilt.
    Axis,
}

impl Quantity {
    /// All of them; their numbers are their places here.
    pub(super) const ALL: [Self; 10] = [
        Self::Time,
        Self::Volt,
        Self::Count,
        Self::Angle,
        Self::Speed,
        Self::Ampere,
        Self::Torque,
        Self::Way,
        Self::Spot,
        Self::Axis,
    ];

    /// As it is typed.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Volt => "volt",
            Self::Count => "count",
            Self::Angle => "angle",
            Self::Speed => "speed",
            Self::Ampere => "ampere",
            Self::Torque => "torque",
            Self::Way => "way",
            Self::Spot => "spot",
            Self::Axis => "axis",
        }
    }

    /// What this program calls its column, with the unit it has there.
    pub(super) const fn own_names(self) -> &'static [&'static str] {
        match self {
            Self::Time => &["time_s", "t_s"],
            Self::Volt => &["volt"],
            Self::Count => &["count"],
            Self::Angle => &["angle_rad"],
            Self::Speed => &["velocity_rad_s"],
            Self::Ampere => &["ampere"],
            Self::Torque => &["torque_nm"],
            Self::Way => &["way"],
            Self::Spot => &["spot_m"],
            Self::Axis => &["axis"],
        }
    }

    /// Units it may have, SI first; of none where it is a number.
    pub(super) const fn units(self) -> &'static [Unit] {
        match self {
            Self::Time => STAMPS,
            Self::Volt => VOLTAGES,
            Self::Angle => SHAFT_ANGLES,
            Self::Speed => SHAFT_SPEEDS,
            Self::Ampere => CURRENTS,
            Self::Torque => TORQUES,
            Self::Spot => LENGTHS,
            Self::Count | Self::Way | Self::Axis => &[],
        }
    }

    /// Its unit in SI.
    pub(super) fn si(self) -> &'static str {
        self.units().first().map_or("", |unit| unit.0)
    }

    pub(super) fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|quantity| quantity.name() == name)
    }

    /// All names, for people.
    pub(super) fn names() -> String {
        Self::ALL.map(Self::name).join(", ")
    }

    /// Names of the units it may have, for people.
    pub(super) fn unit_names(self) -> String {
        self.units().iter().map(|unit| unit.0).collect::<Vec<_>>().join(", ")
    }

    /// A unit by any of its spellings: its name here and what one of it is in SI.
    pub(super) fn unit(self, spelled: &str) -> Option<(&'static str, f64)> {
        let spelled = spelled.trim();
        let plain = spelled.to_lowercase().replace(' ', "");
        let usual = SPELLINGS.iter().find(|(ways, _)| ways.contains(&plain.as_str())).map(|(_, name)| *name);
        let named = |name: &str| self.units().iter().find(|unit| unit.0 == name).copied();
        let own = |name: &str| {
            let worth = factor(name, self.units())?;
            // the name of what is worth the same, so that it is said by a name that can be typed
            self.units().iter().find(|unit| (unit.1 - worth).abs() < 1e-12 * worth).copied()
        };
        named(spelled).or_else(|| usual.and_then(named)).or_else(|| own(spelled))
    }
}

/// Units as headers and people spell them, in small letters, and their names here.
const SPELLINGS: &[(&[&str], &str)] = &[
    (&["ms", "msec", "msecs", "millis", "millisecond", "milliseconds"], "ms"),
    (&["us", "µs", "μs", "usec", "usecs", "micros", "microsecond", "microseconds"], "us"),
    (&["s", "sec", "secs", "second", "seconds"], "s"),
    (&["rpm", "r/min", "u/min", "rev/min", "1/min", "min-1", "min^-1"], "rpm"),
    (&["rps", "rev/s", "turns/s", "hz"], "turn/s"),
    (&["rad/s", "rad/sec", "rad.s-1", "rads"], "rad/s"),
    (&["deg/s", "deg/sec", "dps", "°/s", "degrees/s"], "deg/s"),
    (&["turn", "turns", "rev", "revs", "revolutions", "rotations"], "turn"),
    (&["deg", "degs", "°", "degree", "degrees"], "deg"),
    (&["rad", "radian", "radians"], "rad"),
    (&["v", "volt", "volts"], "V"),
    (&["mv", "millivolt", "millivolts"], "mV"),
    (&["a", "amp", "amps", "ampere", "amperes"], "A"),
    (&["ma", "milliamp", "milliamps"], "mA"),
    (&["nm", "n.m", "n·m", "n*m"], "Nm"),
    (&["mnm", "mn.m", "mn·m"], "mNm"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_known_by_any_usual_spelling() {
        for (quantity, spelled, name, worth) in [
            (Quantity::Time, "ms", "ms", 1e-3),
            (Quantity::Time, "µs", "us", 1e-6),
            (Quantity::Speed, "RPM", "rpm", std::f64::consts::TAU / 60.0),
            (Quantity::Speed, "°/s", "deg/s", std::f64::consts::PI / 180.0),
            (Quantity::Angle, "Degrees", "deg", std::f64::consts::PI / 180.0),
            (Quantity::Ampere, "mA", "mA", 1e-3),
            (Quantity::Volt, "mV", "mV", 1e-3),
        ] {
            let (found, factor) = quantity.unit(spelled).unwrap();
            assert_eq!(found, name);
            assert!((factor / worth - 1.0).abs() < 1e-12, "{spelled}");
        }
        assert_eq!(Quantity::Volt.unit("rpm"), None);
        assert_eq!(Quantity::Count.unit("turn"), None);
    }
}
