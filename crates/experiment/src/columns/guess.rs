//! What a column holds by what it is called.

use super::expression::{Expression, title};
use super::quantity::Quantity;

/// Words that name a quantity, in small letters.
const WORDS: &[(Quantity, &[&str])] = &[
    (
        Quantity::Time,
        &[
            "time",
            "t",
            "timestamp",
            "ts",
            "millis",
            "micros",
            "ms",
            "us",
            "datetime",
            "stamp",
            "seconds",
            "sec",
            "elapsed",
            "zeit",
            "tiempo",
            "temps",
            "tempo",
            "tid",
        ],
    ),
    (Quantity::Volt, &["volt", "volts", "voltage", "spannung", "voltaje", "tensao", "tension"]),
    (Quantity::Count, &["count", "counts", "encoder", "enc", "ticks", "tick", "pulses"]),
    (Quantity::Angle, &["angle", "position", "pos", "theta", "winkel", "angulo"]),
    (
        Quantity::Speed,
        &[
            "speed",
            "velocity",
            "vel",
            "omega",
            "rpm",
            "rps",
            "geschwindigkeit",
            "drehzahl",
            "velocidad",
            "velocidade",
            "vitesse",
        ],
    ),
    (Quantity::Ampere, &["current", "ampere", "amperes", "amps", "amp", "strom", "corriente", "corrente"]),
    (Quantity::Torque, &["torque", "drehmoment"]),
    (Quantity::Axis, &["axis", "joint"]),
];

/// Words of what is wanted or meant, not measured.
const NOT_MEASURED: &[&str] = &[
    "target",
    "setpoint",
    "set",
    "sp",
    "ref",
    "reference",
    "desired",
    "goal",
    "demand",
    "wanted",
    "soll",
    "error",
    "err",
    "cmd",
    "command",
    "commanded",
];
/// Words of voltages that are not the amplifier's input.
const NOT_THE_DRIVE: &[&str] = &["battery", "batt", "bat", "vbat", "supply", "bus", "encoder", "sensor"];
/// Words of a drive that is no voltage yet.
const DRIVES: &[&str] =
    &["pwm", "duty", "dutycycle", "command", "cmd", "motorcommand", "drive", "power", "throttle"];

/// The column that holds a quantity by its name: `None` if none does.
///
/// # Errors
/// Several could, or its unit is not told; what to say is named.
pub(super) fn guess(
    quantity: Quantity,
    names: &[String],
    units: &[String],
) -> Result<Option<Expression>, String> {
    if let Some(place) = names.iter().position(|name| quantity.own_names().contains(&name.as_str())) {
        let si = quantity.units().first().copied();
        return Ok(Some(Expression::column(place, names, si)));
    }
    let holds = |(place, name): (usize, &String)| {
        let name = Name::of(name, units.get(place));
        let unit = name.unit(quantity);
        name.tells(quantity, unit.is_some()).then_some((place, unit))
    };
    let found: Vec<_> = names.iter().enumerate().filter_map(holds).collect();
    match found.as_slice() {
        [] => Ok(None),
        &[(place, unit)] => Ok(Some(Expression::column(place, names, unit))),
        several => {
            let titles: Vec<String> = several.iter().map(|(place, _)| title(names, *place)).collect();
            let example = names[several[0].0].as_str();
            Err(format!(
                "{} could be {}: say which, such as --columns {}={example}",
                quantity.name(),
                titles.join(" or "),
                quantity.name(),
            ))
        }
    }
}

/// The unit that a column's name or the row below it tells of a quantity.
pub(super) fn unit(
    quantity: Quantity,
    names: &[String],
    units: &[String],
    place: usize,
) -> Option<(&'static str, f64)> {
    Name::of(names.get(place)?, units.get(place)).unit(quantity)
}

/// A column that drives the motor, but in no volts.
pub(super) fn drive(names: &[String]) -> Option<usize> {
    names.iter().position(|name| {
        let words = Name::of(name, None).words;
        words.iter().any(|word| DRIVES.contains(&word.as_str())) && !words.iter().any(|word| word == "speed")
    })
}

/// What a column is called, taken apart.
struct Name {
    words: Vec<String>,
    /// What follows the last mark in it.
    tail: Option<String>,
    /// What stands in brackets at its end, or in the row of units.
    bracket: Option<String>,
}

impl Name {
    fn of(name: &str, below: Option<&String>) -> Self {
        let open = name.rfind(['(', '[']).filter(|_| name.ends_with([')', ']']));
        let (plain, inside) = open
            .map_or((name, None), |at| (&name[..at], Some(name[at + 1..name.len() - 1].trim().to_owned())));
        let below = below.map(|unit| unit.trim_matches(['(', ')', '[', ']']).to_owned());
        let tail = plain.rsplit_once(|c: char| !c.is_alphanumeric()).map(|(_, tail)| tail.to_owned());
        Self { words: words(plain), tail, bracket: inside.or(below).filter(|unit| !unit.is_empty()) }
    }

    /// Its unit, if it is one of the quantity's.
    fn unit(&self, quantity: Quantity) -> Option<(&'static str, f64)> {
        if let Some(bracket) = &self.bracket {
            return quantity.unit(bracket);
        }
        if let [.., above, below] = self.words.as_slice()
            && let Some(found) = quantity.unit(&format!("{above}/{below}"))
        {
            return Some(found);
        }
        // small and large letters of a unit are no words: mV, mNm
        if let Some(found) = self.tail.as_deref().and_then(|tail| quantity.unit(tail)) {
            return Some(found);
        }
        let [.., last] = self.words.as_slice() else { return None };
        // a single letter by itself is a name
        quantity.unit(last).filter(|_| self.words.len() > 1 || last.len() > 1)
    }

    /// Whether it names the quantity.
    fn tells(&self, quantity: Quantity, has_unit: bool) -> bool {
        /// Words so short are names by themselves only, but parts of many.
        const SHORT: usize = 3;
        let has = |of: &[&str]| self.words.iter().any(|word| of.contains(&word.as_str()));
        let alone = self.words.len() == 1;
        let of_its = |words: &[&str]| match quantity {
            Quantity::Axis => alone && has(words),
            Quantity::Time => {
                has(&words.iter().copied().filter(|word| alone || word.len() > SHORT).collect::<Vec<_>>())
            }
            _ => has(words),
        };
        let named = WORDS.iter().any(|(of, words)| *of == quantity && of_its(words));
        let measured =
            matches!(quantity, Quantity::Time | Quantity::Axis | Quantity::Volt) || !has(NOT_MEASURED);
        let drive =
            quantity != Quantity::Volt || !(has(NOT_THE_DRIVE) || has(&["target", "ref", "setpoint"]));
        // volts of an encoder are no counts
        let counts = ["count", "counts", "ticks", "edges", "pulses", "steps"];
        let fits = match (&self.bracket, quantity.units().is_empty()) {
            (Some(unit), true) => counts.contains(&unit.to_lowercase().as_str()),
            (Some(_), false) => has_unit,
            (None, _) => true,
        };
        named && measured && drive && fits
    }
}

/// Words of a name, in small letters: `leftSpeedRpm` and `left_speed_rpm` have the same.
fn words(name: &str) -> Vec<String> {
    let mut all = vec![String::new()];
    let mut small = false;
    for c in name.chars() {
        if !c.is_alphanumeric() || (c.is_uppercase() && small) {
            all.push(String::new());
        }
        if c.is_alphanumeric()
            && let Some(word) = all.last_mut()
        {
            word.extend(c.to_lowercase());
        }
        small = c.is_lowercase() || c.is_numeric();
    }
    all.retain(|word| !word.is_empty());
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::expression::Source;

    fn table(text: &str) -> Vec<String> {
        text.split(',').map(|name| name.trim().to_owned()).collect()
    }

    fn told(quantity: Quantity, header: &str) -> Option<(usize, Option<&'static str>)> {
        let found = guess(quantity, &table(header), &[]).unwrap()?;
        let Source::Column(place) = found.source else { return None };
        Some((place, found.unit.map(|unit| unit.0)))
    }

    #[test]
    fn common_headers_tell_what_they_hold() {
        for (quantity, header, wanted) in [
            (Quantity::Time, "Timestamp(ms),Motor_Speed(RPM),Commanded_PWM", Some((0, Some("ms")))),
            (Quantity::Speed, "Timestamp(ms),Motor_Speed(RPM),Commanded_PWM", Some((1, Some("rpm")))),
            (Quantity::Volt, "Timestamp(ms),Motor_Speed(RPM),Commanded_PWM", None),
            (Quantity::Count, "Timestamp,Target,MotorPWM,Encoder", Some((3, None))),
            (Quantity::Speed, "time, targetSpeed, leftSpeed, leftCommand", Some((2, None))),
            (Quantity::Volt, "time, batteryVoltage, motorCommand", None),
            (Quantity::Speed, "time_ms,pwm,rpm", Some((2, Some("rpm")))),
            (Quantity::Time, "time_ms,pwm,rpm", Some((0, Some("ms")))),
            (Quantity::Time, "t,u,y", Some((0, None))),
            (Quantity::Speed, "t_s,omega_rad_s,voltage_V", Some((1, Some("rad/s")))),
            (Quantity::Volt, "t_s,omega_rad_s,voltage_V", Some((2, Some("V")))),
            (Quantity::Ampere, "index,time_s,current_A,encoder_V", Some((2, Some("A")))),
            (Quantity::Volt, "micros,voltage_mV,encoder", Some((1, Some("mV")))),
            (Quantity::Time, "micros,voltage_mV,encoder", Some((0, Some("us")))),
            (Quantity::Count, "index,time_s,current_A,encoder (V)", None),
            (Quantity::Speed, "axis,torque_nm,velocity_rad_s", Some((2, Some("rad/s")))),
            (Quantity::Time, "Zeit [s];Drehzahl [U/min]", Some((0, Some("s")))),
        ] {
            let header = header.replace(';', ",");
            assert_eq!(told(quantity, &header), wanted, "{quantity:?} in {header}");
        }
    }

    #[test]
    fn what_could_be_two_columns_is_refused_with_both() {
        let error = guess(Quantity::Speed, &table("time,leftSpeedRpm,rightSpeedRpm"), &[]).unwrap_err();
        assert!(error.contains("\"leftSpeedRpm\" or \"rightSpeedRpm\""), "{error}");
        assert!(error.contains("--columns speed=leftSpeedRpm"), "{error}");
    }

    #[test]
    fn a_drive_without_volts_is_found() {
        assert_eq!(drive(&table("time,leftSpeed,leftCommand")), Some(2));
        assert_eq!(drive(&table("t,u,y")), None);
    }

    #[test]
    fn names_are_taken_apart_however_they_are_joined() {
        for name in ["leftSpeedRpm", "left_speed_rpm", "Left Speed RPM", "left-speed.rpm"] {
            assert_eq!(words(name), ["left", "speed", "rpm"], "{name}");
        }
    }
}
