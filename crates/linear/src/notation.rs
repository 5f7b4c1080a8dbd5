//! Formulas as text.

use std::fmt;

use tracelight_maths::log10;

use crate::polynomial::Polynomial;

/// `13.16 s² + 1.754 s + 10.29`.
pub(crate) fn polynomial(polynomial: &Polynomial, variable: &str) -> String {
    let degree = polynomial.degree();
    let mut text = String::new();
    for (i, &c) in polynomial.coefficients().iter().enumerate().filter(|(_, c)| **c != 0.0) {
        text += match (text.is_empty(), c < 0.0) {
            (true, true) => "−",
            (true, false) => "",
            (false, true) => " − ",
            (false, false) => " + ",
        };
        let (number, power) = (four_digits(c.abs()), power(variable, degree - i));
        text += &match (number.as_str(), power.as_str()) {
            (_, "") => number,
            ("1", _) => power,
            _ => format!("{number} {power}"),
        };
    }
    if text.is_empty() { "0".to_owned() } else { text }
}

impl fmt::Display for Polynomial {
    /// In s, four digits: `13.16 s² + 1.754 s + 10.29`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&polynomial(self, "s"))
    }
}

/// Four digits, without idle zeros.
pub fn four_digits(value: f64) -> String {
    if value == 0.0 {
        // without the sign that a zero may have
        return "0".to_owned();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let exponent = log10(value.abs()).floor() as i32;
    let trimmed = |text: String| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    };
    if (-4..7).contains(&exponent) {
        return trimmed(format!("{value:.*}", (3 - exponent).max(0) as usize));
    }
    let text = format!("{value:.3e}");
    let (mantissa, power) = text.split_once('e').unwrap_or((&text, "0"));
    format!("{}e{power}", trimmed(mantissa.to_owned()))
}

/// `(s² + 2 s + 5)`.
pub(crate) fn quadratic(variable: &str, linear: f64, constant: f64) -> String {
    format!("({})", polynomial(&Polynomial::new([1.0, linear, constant]), variable))
}

pub(crate) fn power(variable: &str, power: usize) -> String {
    match power {
        0 => String::new(),
        1 => variable.to_owned(),
        _ => variable.chars().chain(power.to_string().chars().map(superscript)).collect(),
    }
}

fn superscript(digit: char) -> char {
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    digit.to_digit(10).map_or(digit, |d| digits[d as usize])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_written_as_on_paper() {
        let text = |c: &[f64]| polynomial(&Polynomial::new(c), "s");
        assert_eq!(text(&[1.0, 0.13331, 0.78215]), "s² + 0.1333 s + 0.7822");
        assert_eq!(text(&[-1.0, 0.0, 1.5e-9]), "−s² + 1.5e-9");
        assert_eq!(text(&[]), "0");
        assert_eq!([-0.0, 100.0, 1e7, -0.5].map(four_digits), ["0", "100", "1e7", "-0.5"]);
    }
}
