//! Numbers as people read them.

use tracelight_lab::Uncertain;
use tracelight_linear::four_digits;
use tracelight_maths::{log10, powf};
use tracelight_rig::Fault;

/// To so many digits, and without a sign where that is none.
pub(crate) fn rounded(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    match text.strip_prefix('-') {
        Some(size) if size.bytes().all(|b| matches!(b, b'0' | b'.')) => size.to_owned(),
        _ => text,
    }
}

/// What the intervals of a table mean.
pub(crate) const HOW_SURE: &str = "\n\n± has the true value in 95 of 100 cases, if the model is right.";

/// Lines of their own, each after the end of the one before.
pub(crate) fn lines(said: &[String]) -> String {
    said.iter().map(|line| format!("\n{line}")).collect()
}

/// A value and its interval, times a thousand.
pub(crate) fn milli(value: Option<Uncertain>) -> String {
    value.map_or("–".to_owned(), |u| {
        // two digits of how well it is known
        let digits = (1.0 - log10(1e3 * u.within).floor()).clamp(0.0, 6.0);
        if !u.within.is_finite() {
            return format!("{:.4} ± ?", 1e3 * u.value);
        }
        let digits = if u.within > 0.0 { digits as usize } else { 4 };
        format!("{:.digits$} ± {:.digits$}", 1e3 * u.value, 1e3 * u.within)
    })
}

/// A number for people: four digits, without idle zeros.
pub(crate) fn four(value: f64) -> String {
    if value.is_infinite() { "∞".to_owned() } else { four_digits(value).replace('-', "−") }
}

/// A positive number to two digits.
pub(crate) fn two_digits(value: f64) -> f64 {
    let unit = powf(10.0, log10(value).floor() - 1.0);
    // a power of ten below 1 is not exact: its inverse is
    if unit < 1.0 {
        (value / unit).round() / (1.0 / unit).round()
    } else {
        (value / unit).round() * unit.round()
    }
}

/// A time, for people.
pub(crate) fn seconds(seconds: Option<f64>) -> String {
    seconds.map_or("never".to_owned(), |s| format!("{} s", four(s)))
}

/// A share, for people.
pub(crate) fn percent(value: Option<f64>) -> String {
    value.map_or("–".to_owned(), |p| format!("{} %", four(p)))
}

/// Why a run is not done, given the fault it ended with.
pub(crate) fn why_unfinished(fault: Option<Fault>) -> &'static str {
    fault.map_or("held again and again", |fault| fault.code())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_digits_are_left() {
        let rounded = [0.012_345, 0.999, 1.26, 98.7, 123_456.0].map(two_digits);
        assert_eq!(rounded, [0.012, 1.0, 1.3, 99.0, 120_000.0]);
    }
}
