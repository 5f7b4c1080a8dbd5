//! Quantities on the bench's command lines that must be above zero or within reason.

use tracelight_units::{FREQUENCIES, Unit, VOLTAGES, parse};

/// A value with its unit, in SI, that is more than none.
pub(super) fn above_zero(text: &str, units: &'static [Unit]) -> Result<f64, String> {
    let value = parse(text, units).map_err(|e| e.to_string())?;
    if value > 0.0 { Ok(value) } else { Err(format!("{text} is not above zero")) }
}

pub(super) fn frequency(text: &str) -> Result<f64, String> {
    above_zero(text, FREQUENCIES)
}

pub(super) fn voltage(text: &str) -> Result<f64, String> {
    above_zero(text, VOLTAGES)
}

/// What limits of moves may be, in SI: more is no head's, and less takes for ever.
const LEAST: f64 = 1e-6;
const MOST: f64 = 1e6;

/// `value` if it is within reason.
pub(super) fn within<T>(text: &str, value: T, number: f64, units: &[Unit]) -> Result<T, String> {
    let unit = units.first().map_or("", |unit| unit.0);
    if (LEAST..=MOST).contains(&number) {
        Ok(value)
    } else {
        Err(format!("{text} is not between {LEAST} and {MOST} {unit}"))
    }
}

/// How far from zero a plane is shown.
pub(super) fn reach(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (1e-9..=1e9).contains(&value) => Ok(value),
        _ => Err(format!("{text} is no number between 1e-9 and 1e9")),
    }
}
