//! Quantities as people type them: a number with its unit.
//!
//! `24in`, `0.6m`, `1ft/s`, `15deg`: each quantity has a type that parses its units and nothing else, holds SI, and
//! prints SI. A bare number is an error that says which units fit. Signs and words are read too: `24"`, `5'6"`, `15°`, `3 feet`, and
//! fractions: `5 1/2in`.

mod written;

use std::fmt;
use std::str::FromStr;

/// Why a text is no quantity.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum UnitError {
    /// A number without unit.
    #[error("{text} has no unit; write it with one of {units}, such as {text}{first}")]
    Bare {
        /// As typed.
        text: String,
        /// What fits.
        units: String,
        /// One of them, for an example.
        first: &'static str,
    },
    /// A unit of something else, or of nothing.
    #[error("{text}: the unit {unit} does not fit here; use one of {units}")]
    Unit {
        /// As typed.
        text: String,
        /// What was taken for a unit.
        unit: String,
        /// What fits.
        units: String,
    },
    /// A comma where numbers here have a point.
    #[error("{text}: numbers have a point here, no comma; write {point}")]
    Comma {
        /// As typed.
        text: String,
        /// The same with a point.
        point: String,
    },
    /// No number in front.
    #[error("{text} is no number with a unit; write it as 1{first}, with one of {units}")]
    Number {
        /// As typed.
        text: String,
        /// What fits.
        units: String,
        /// One of them, for an example.
        first: &'static str,
    },
    /// Two numbers were wanted.
    #[error("{text} is no pair; write two lengths with a comma between, such as 10cm,-2in")]
    Pair {
        /// As typed.
        text: String,
    },
}

/// A unit's name and what one of it is in SI.
pub type Unit = (&'static str, f64);

const DEG: f64 = std::f64::consts::PI / 180.0;

/// The first of each list is the SI unit the quantity prints in.
pub const LENGTHS: &[Unit] = &[("m", 1.0), ("mm", 1e-3), ("cm", 1e-2), ("in", 0.0254), ("ft", 0.3048)];
/// Lengths in a picture.
pub const PIXELS: &[Unit] = &[("px", 1.0)];
/// See [`LENGTHS`].
pub const ANGLES: &[Unit] =
    &[("rad", 1.0), ("mrad", 1e-3), ("deg", DEG), ("arcmin", DEG / 60.0), ("arcsec", DEG / 3600.0)];
/// See [`LENGTHS`].
pub const SPEEDS: &[Unit] =
    &[("m/s", 1.0), ("mm/s", 1e-3), ("cm/s", 1e-2), ("in/s", 0.0254), ("ft/s", 0.3048)];
/// Speeds as machine tools have them, too.
pub const FEEDS: &[Unit] = &[
    ("m/s", 1.0),
    ("mm/s", 1e-3),
    ("cm/s", 1e-2),
    ("in/s", 0.0254),
    ("ft/s", 0.3048),
    ("mm/min", 1e-3 / 60.0),
    ("m/min", 1.0 / 60.0),
    ("in/min", 0.0254 / 60.0),
];
/// See [`LENGTHS`].
pub const ACCELERATIONS: &[Unit] =
    &[("m/s2", 1.0), ("mm/s2", 1e-3), ("cm/s2", 1e-2), ("in/s2", 0.0254), ("ft/s2", 0.3048)];
/// See [`LENGTHS`].
pub const TIMES: &[Unit] = &[("s", 1.0), ("ms", 1e-3), ("min", 60.0)];
/// See [`LENGTHS`].
pub const VOLTAGES: &[Unit] = &[("V", 1.0), ("mV", 1e-3)];
/// See [`LENGTHS`].
pub const CURRENTS: &[Unit] = &[("A", 1.0), ("mA", 1e-3)];
/// See [`LENGTHS`].
pub const TORQUE_CONSTANTS: &[Unit] = &[("Nm/A", 1.0), ("mNm/A", 1e-3)];
/// See [`LENGTHS`].
pub const TORQUES: &[Unit] = &[("Nm", 1.0), ("mNm", 1e-3)];
/// See [`LENGTHS`].
pub const ANGULAR_SPEEDS: &[Unit] = &[("rad/s", 1.0), ("deg/s", DEG)];
/// Frequencies, as angular ones: 1 Hz is 2π rad/s.
pub const FREQUENCIES: &[Unit] =
    &[("rad/s", 1.0), ("Hz", std::f64::consts::TAU), ("kHz", 1e3 * std::f64::consts::TAU), ("deg/s", DEG)];
/// Times as logs have them, which count milliseconds or microseconds since a board woke up.
pub const STAMPS: &[Unit] = &[("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("min", 60.0)];
/// Speeds of shafts as logs have them.
pub const SHAFT_SPEEDS: &[Unit] = &[
    ("rad/s", 1.0),
    ("deg/s", DEG),
    ("rpm", std::f64::consts::TAU / 60.0),
    ("turn/s", std::f64::consts::TAU),
    ("turn/min", std::f64::consts::TAU / 60.0),
];
/// Angles of shafts as logs have them.
pub const SHAFT_ANGLES: &[Unit] =
    &[("rad", 1.0), ("mrad", 1e-3), ("deg", DEG), ("turn", std::f64::consts::TAU)];
/// See [`LENGTHS`].
pub const ANGULAR_ACCELERATIONS: &[Unit] = &[("rad/s2", 1.0), ("deg/s2", DEG)];
/// See [`LENGTHS`].
pub const ANGULAR_JERKS: &[Unit] = &[("rad/s3", 1.0), ("deg/s3", DEG)];

/// Splits a text into number and unit and converts to SI.
pub fn parse(text: &str, units: &'static [Unit]) -> Result<f64, UnitError> {
    const LONGEST: usize = 64; // no quantity is longer, and splitting takes the square of the length
    let text = text.trim();
    let names = || units.iter().map(|u| u.0).collect::<Vec<_>>().join(", ");
    let first = usual(units);
    if text.chars().count() > LONGEST {
        let text = text.chars().take(LONGEST).chain("…".chars()).collect();
        return Err(UnitError::Number { text, units: names(), first });
    }
    if let Some(feet) = units.iter().find(|u| u.0 == "in").zip(written::feet_and_inches(text)) {
        return Ok(feet.1 * feet.0.1);
    }
    let plain = || {
        let (number, unit) = split(text);
        number.parse::<f64>().ok().map(|value| (value, unit))
    };
    let Some((value, unit)) = written::fraction(text).or_else(plain) else {
        return Err(UnitError::Number { text: text.into(), units: names(), first });
    };
    if !value.is_finite() {
        return Err(UnitError::Number { text: text.into(), units: names(), first });
    }
    if unit.is_empty() {
        return Err(UnitError::Bare { text: text.into(), units: names(), first: likely(value, units) });
    }
    if let Some(factor) = factor(unit, units) {
        return Ok(value * factor);
    }
    Err(match written::with_point(text) {
        Some(point) => UnitError::Comma { text: text.into(), point },
        None => UnitError::Unit { text: text.into(), unit: unit.into(), units: names() },
    })
}

/// What one of a unit is in SI, however it is written; `None` if it is none of these.
#[must_use]
pub fn factor(unit: &str, units: &[Unit]) -> Option<f64> {
    let named = |name: &str| units.iter().find(|u| u.0 == name).map(|u| u.1);
    named(unit).or_else(|| {
        let (name, share) = written::meant(unit)?;
        named(&name).map(|one| one * share)
    })
}

/// The unit to show in an example of a number that has none: of lengths, the one in which people give so many.
fn likely(value: f64, units: &[Unit]) -> &'static str {
    let name = match value.abs() {
        _ if usual(units) != "in" => return usual(units),
        v if v < 1.0 => "m",
        v if v < 10.0 => "ft",
        v if v < 100.0 => "in",
        _ => "mm",
    };
    units.iter().map(|u| u.0).find(|&u| u == name).unwrap_or_else(|| usual(units))
}

/// The unit to show in an example: the one people type most.
fn usual(units: &[Unit]) -> &'static str {
    const USUAL: [&str; 3] = ["in", "deg", "ft/s"];
    let known = units.iter().map(|u| u.0);
    known.clone().find(|u| USUAL.contains(u)).or(known.clone().next()).unwrap_or("")
}

/// Cuts after the longest prefix that is a number: `1e3m` is a thousand metres, `1em` is one of the unit `em`.
fn split(text: &str) -> (&str, &str) {
    let ends = text.char_indices().map(|(i, c)| i + c.len_utf8()).rev();
    let numbers = ends.filter(|&end| text[..end].parse::<f64>().is_ok());
    // `inf` and `nan` parse as numbers, but `1inch` must not be read as 1 and `infinity…`: digits come first
    let end = numbers.into_iter().next().unwrap_or(0);
    let (number, unit) = text.split_at(end);
    (number.trim(), unit.trim())
}

/// Defines a quantity: its type, its units, its doc.
macro_rules! quantity {
    ($(#[$doc:meta])* $name:ident, $units:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
        pub struct $name(pub f64);

        impl FromStr for $name {
            type Err = UnitError;

            fn from_str(text: &str) -> Result<Self, UnitError> {
                parse(text, $units).map(Self)
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{}{}", self.0, $units[0].0)
            }
        }
    };
}

quantity!(
    /// Metres.
    Length,
    LENGTHS
);
quantity!(
    /// Radians.
    Angle,
    ANGLES
);
quantity!(
    /// Metres per second.
    Speed,
    SPEEDS
);
quantity!(
    /// Radians per second.
    AngularSpeed,
    ANGULAR_SPEEDS
);
quantity!(
    /// Radians per second squared.
    AngularAcceleration,
    ANGULAR_ACCELERATIONS
);

/// A rate of a length or of an angle: one of [`SPEEDS`] or [`ANGULAR_SPEEDS`], [`ACCELERATIONS`] or
/// [`ANGULAR_ACCELERATIONS`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rate {
    /// m/s or m/s².
    Linear(f64),
    /// rad/s or rad/s².
    Angular(f64),
}

impl Rate {
    /// A rate of either kind; what fits neither is said of both.
    pub fn parse(text: &str, linear: &'static [Unit], angular: &'static [Unit]) -> Result<Self, String> {
        match (parse(text, linear), parse(text, angular)) {
            (Ok(value), _) => Ok(Rate::Linear(value)),
            (_, Ok(value)) => Ok(Rate::Angular(value)),
            (Err(error), _) => {
                let angular: Vec<_> = angular.iter().map(|unit| unit.0).collect();
                Err(format!("{error}; or, for an angle, {}", angular.join(", ")))
            }
        }
    }

    /// As a rate of a length, where a radian is so many metres long.
    pub fn linear(self, metres_per_rad: f64) -> f64 {
        match self {
            Rate::Linear(value) => value,
            Rate::Angular(value) => value * metres_per_rad,
        }
    }

    /// The number alone, SI.
    pub const fn value(self) -> f64 {
        match self {
            Rate::Linear(value) | Rate::Angular(value) => value,
        }
    }
}

/// Two lengths: right and up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Offset(pub Length, pub Length);

impl FromStr for Offset {
    type Err = UnitError;

    fn from_str(text: &str) -> Result<Self, UnitError> {
        let (x, y) = text.split_once(',').ok_or_else(|| UnitError::Pair { text: text.into() })?;
        Ok(Self(x.parse()?, y.parse()?))
    }
}

/// The examples of `README.md`, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests {
    use super::*;

    fn length(text: &str) -> f64 {
        text.parse::<Length>().unwrap().0
    }

    #[test]
    fn lengths_have_the_units_of_the_contract() {
        for (text, metres) in [
            ("24in", 0.6096),
            ("0.6m", 0.6),
            ("610mm", 0.61),
            ("3ft", 0.9144),
            ("12 cm", 0.12),
            ("1e3mm", 1.0),
        ] {
            assert!((length(text) - metres).abs() < 1e-12, "{text}");
        }
        assert!(("1ft/s".parse::<Speed>().unwrap().0 - 0.3048).abs() < 1e-15);
        assert!(("15deg".parse::<Angle>().unwrap().0 - 0.261_799_387_799_149_4).abs() < 1e-15);
    }

    #[test]
    fn units_may_be_written_as_people_write_them() {
        for (text, metres) in [
            ("24\"", 0.6096),
            ("24″", 0.6096),
            ("24inches", 0.6096),
            ("1 inch", 0.0254),
            ("24IN", 0.6096),
            ("3'", 0.9144),
            ("3 feet", 0.9144),
            ("5'6\"", 1.6764),
            ("-5'6\"", -1.6764),
            ("5' 6 in", 1.6764),
            ("5ft6in", 1.6764),
            ("5'6.5", 1.6891),
            ("2 metres", 2.0),
            ("250µm", 2.5e-4),
            ("250um", 2.5e-4),
            ("1/2in", 0.0127),
            ("5 1/2in", 0.1397),
            ("5-1/2\"", 0.1397),
            ("-3/4 ft", -0.2286),
            ("5'6 1/2\"", 1.6891),
            ("5' 1/2 in", 1.5367),
        ] {
            assert!((length(text) - metres).abs() < 1e-12, "{text}");
        }
        for text in [
            "5'13\"", "5ft6", "5.5'6\"", "5'6m", "5'6'", "1\"2'", "'", "\"", "5''6", "1/0in", "1/2", "1/in",
            "/2in", "5/1 2in", "1/2/3in",
        ] {
            assert!(text.parse::<Length>().is_err(), "{text}");
        }
        assert!(("15°".parse::<Angle>().unwrap().0 - 15.0 * DEG).abs() < 1e-15);
        assert!(("2 feet/sec".parse::<Speed>().unwrap().0 - 0.6096).abs() < 1e-15);
        assert!(("90°/s".parse::<AngularSpeed>().unwrap().0 - 90.0 * DEG).abs() < 1e-12);
        assert!(("90°/s²".parse::<AngularAcceleration>().unwrap().0 - 90.0 * DEG).abs() < 1e-12);
        // of something else still
        assert!("15\"".parse::<Angle>().is_err() && "15°".parse::<Length>().is_err());
    }

    #[test]
    fn a_decimal_comma_is_answered_with_a_point() {
        for (text, wanted) in [
            ("2,4m", "write 2.4m"),
            ("-2,45 m", "write -2.45 m"),
            ("1,000mm", "write 1.000mm, or 1000mm for thousands"),
            ("2,4", "write 2.4"),
        ] {
            let message = text.parse::<Length>().unwrap_err().to_string();
            assert!(message.ends_with(wanted), "{text}: {message}");
        }
    }

    #[test]
    fn an_example_is_of_the_size_that_is_likely() {
        for (text, wanted) in [("0.6", "0.6m"), ("3", "3ft"), ("24", "24in"), ("600", "600mm")] {
            let message = text.parse::<Length>().unwrap_err().to_string();
            assert!(message.ends_with(&format!("such as {wanted}")), "{message}");
        }
        assert!("24".parse::<Angle>().unwrap_err().to_string().ends_with("such as 24deg"));
    }

    #[test]
    fn a_bare_number_says_which_units_fit() {
        let message = "24".parse::<Length>().unwrap_err().to_string();
        assert!(message.contains("no unit") && message.contains("mm, cm, in, ft"), "{message}");
    }

    #[test]
    fn a_unit_of_something_else_is_named() {
        let message = "24deg".parse::<Length>().unwrap_err().to_string();
        assert!(message.contains("the unit deg does not fit"), "{message}");
    }

    #[test]
    fn nonsense_is_refused() {
        for text in ["", "in", "1e400m", "nanm", "infm", "--3m", "1,5m", "0x10m"] {
            assert!(text.parse::<Length>().is_err(), "{text}");
        }
    }

    #[test]
    fn a_rate_is_of_a_length_or_an_angle() {
        let speed = |text| Rate::parse(text, SPEEDS, ANGULAR_SPEEDS);
        assert_eq!(speed("24rad/s"), Ok(Rate::Angular(24.0)));
        assert_eq!(speed("2m/s").unwrap().linear(7.0), 2.0);
        assert_eq!(speed("2rad/s").unwrap().linear(0.5), 1.0);
        for text in ["24", "24V", "rad/s", ""] {
            let message = speed(text).unwrap_err();
            assert!(message.contains("ft/s") && message.contains("rad/s"), "{message}");
        }
    }

    #[test]
    fn an_offset_is_two_lengths() {
        let offset: Offset = "10cm,-2in".parse().unwrap();
        assert!((offset.0.0 - 0.1).abs() < 1e-12 && (offset.1.0 + 0.0508).abs() < 1e-12);
        assert!("10cm".parse::<Offset>().is_err());
    }
}
