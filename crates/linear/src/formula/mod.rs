//! Transfer functions from text: what may be read, [`reader`] how, [`atom`] what it is made of.

mod atom;
mod part;
mod reader;

use crate::{Delayed, Time, TransferFunction};
use reader::Reader;

pub use part::{FormulaError, Names};

impl TransferFunction {
    /// From text like `281 (s + 32.9)(s + 97.8) / ((s + 250)(s + 177))`: numbers, the variable (s, or z of samples), + − * / ^,
    /// brackets, and `pade(0.2, 3)`, a dead time of 0.2 s approximated in the third order. Factors may stand side by side; after a/(b) and
    /// a space the next one multiplies the quotient. Nothing is cancelled.
    ///
    /// Text that can be read in two ways is refused: `1/2s`, `1/s(s+1)`, `s2`, `s^2s`, `2^3^2`; and so is a dead time.
    ///
    /// # Errors
    /// What is wrong, where, and what to write.
    pub fn parse(text: &str, time: Time) -> Result<Self, FormulaError> {
        Self::parse_with(text, time, &|_| None)
    }

    /// Reads a formula in which names like `G11`, a letter other than the variable and what letters and digits follow, stand for systems.
    ///
    /// # Errors
    /// As [`parse`](Self::parse).
    pub fn parse_with(text: &str, time: Time, named: &Names<'_>) -> Result<Self, FormulaError> {
        let read = Delayed::parse_with(text, time, named)?;
        if read.delay_s() == 0.0 {
            return Ok(read.rational().clone());
        }
        let at = text.find("exp").or_else(|| text.find("e^")).map_or(0, |byte| text[..byte].chars().count());
        let delay_s = read.delay_s();
        let message = format!("a dead time is not taken here: approximate it by pade({delay_s}, 3)");
        Err(FormulaError { at, message })
    }
}

impl Delayed {
    /// From text as [`TransferFunction::parse`] reads it, and dead times besides: `2 exp(-0.3s)/(s+1)`, `e^(-0.3s)`. What is added has the
    /// same dead time.
    ///
    /// # Errors
    /// What is wrong, where, and what to write.
    pub fn parse_with(text: &str, time: Time, named: &Names<'_>) -> Result<Self, FormulaError> {
        let mut reader =
            Reader { characters: text.chars().map(plain).collect(), at: 0, depth: 0, time, named };
        let whole = reader.sum()?;
        match reader.next() {
            Some(')') => Err(reader.error("this bracket was never opened")),
            Some(other) => Err(reader.error(&format!("`{other}` is not part of a formula"))),
            None if whole.delay_s < 0.0 => Err(reader
                .error(&format!("this is {} s early: it would have to know what comes", -whole.delay_s))),
            None => Self::new(whole.rational, whole.delay_s).map_err(|e| reader.error(&e.to_string())),
        }
    }
}

/// Signs as they are printed, as they are typed.
const fn plain(c: char) -> char {
    match c {
        '−' | '–' => '-',
        '·' | '×' | '⋅' => '*',
        _ => c,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> TransferFunction {
        TransferFunction::parse(text, Time::Continuous).unwrap()
    }

    #[test]
    fn formulas_are_read_as_they_are_written() {
        for (text, numerator, denominator) in [
            ("2", &[2.0][..], &[1.0][..]),
            ("-s^2 + 1.5e-2", &[-1.0, 0.0, 0.015], &[1.0]),
            ("13.33/(s^2 + 0.1333s + 0.7822)", &[13.33], &[1.0, 0.1333, 0.7822]),
            ("3 (s+1)(s+2) / (s (s+4))", &[3.0, 9.0, 6.0], &[1.0, 4.0, 0.0]),
            ("1/s/s", &[1.0], &[1.0, 0.0, 0.0]),
            ("1/s + 1/(s+1)", &[2.0, 1.0], &[1.0, 1.0, 0.0]),
            ("2 − 3·s²", &[-3.0, 0.0, 2.0], &[1.0]),
            ("(s+1)^3", &[1.0, 3.0, 3.0, 1.0], &[1.0]),
            ("1/(2s)^2", &[0.25], &[1.0, 0.0, 0.0]),
            ("1/(s+1)^2.0", &[1.0], &[1.0, 2.0, 1.0]),
            ("2s**2", &[2.0, 0.0, 0.0], &[1.0]),
            ("3s^-1", &[3.0], &[1.0, 0.0]),
            ("(s+2)^(-2)", &[1.0], &[1.0, 4.0, 4.0]),
            ("s^2(s+1)", &[1.0, 1.0, 0.0, 0.0], &[1.0]),
            ("(s+1)4.5s", &[4.5, 4.5, 0.0], &[1.0]),
            ("1/2*s", &[0.5, 0.0], &[1.0]),
            ("1/(s+1) (s+2)", &[1.0, 2.0], &[1.0, 1.0]),
            ("--1", &[1.0], &[1.0]),
        ] {
            let read = parse(text);
            assert_eq!(
                (read.numerator().coefficients(), read.denominator().coefficients()),
                (numerator, denominator),
                "{text}"
            );
        }
        let printed = "(13.16 s² + 1.754 s + 10.29) / (s⁴ + 0.2649 s³ + 0.7997 s² + 0.1029 s)";
        assert_eq!(parse(printed).to_string(), printed);
        let k11 = "281 (s + 32.9)(s + 97.8) / ((s + 250)(s + 177))";
        assert_eq!(parse(k11).zpk().poles().len(), 2);
        assert!(TransferFunction::parse("1/(z - 0.5)", Time::Sampled(0.001)).is_ok());
        let named = |name: &str| (name == "K2").then(|| parse("2/(s+1)").into());
        for text in ["K2/s*K2", "K2(s) K2(s)/s", "K2(s)K2( s )/s"] {
            let product = TransferFunction::parse_with(text, Time::Continuous, &named).unwrap();
            assert_eq!(product.denominator().coefficients(), [1.0, 2.0, 1.0, 0.0], "{text}");
        }
        let error = TransferFunction::parse_with("K2(s+1)", Time::Continuous, &named).unwrap_err();
        assert!(error.at == 2 && error.message.contains("K2 * (…)"), "{error}");
    }

    #[test]
    fn dead_times_are_read() {
        let read = |text: &str| {
            let read = Delayed::parse_with(text, Time::Continuous, &|name| {
                let late = Delayed::new(parse("1/(s+1)"), 0.1).unwrap();
                (name == "P").then_some(late)
            });
            let read = read.unwrap_or_else(|e| panic!("{text}: {e}"));
            (read.rational().to_string(), read.delay_s())
        };
        for (text, rational, delay_s) in [
            ("2 exp(-0.3s)/(s+1)", "2 / (s + 1)", 0.3),
            ("exp(-0.3 s) 2/(s+1)", "2 / (s + 1)", 0.3),
            ("e^(-2*s/4)/s", "1 / s", 0.5),
            ("exp(-s)^3/s", "1 / s", 3.0),
            ("exp(-s) exp(s)", "1", 0.0),
            ("exp(-s)/s + 2exp(-s)", "(2 s + 1) / s", 1.0),
            ("exp(-0.2s)*0 + 1/s", "1 / s", 0.0),
            ("P P/s", "1 / (s³ + 2 s² + s)", 0.2),
            ("exp(0)", "1", 0.0),
        ] {
            let found = read(text);
            assert!(found.0 == rational && (found.1 - delay_s).abs() < 1e-15, "{text}: {found:?}");
        }
        assert_eq!(parse("pade(0.2, 1)").to_string(), "(−s + 10) / (s + 10)");
        let sampled = TransferFunction::parse("exp(-s)/z", Time::Sampled(0.1)).unwrap_err();
        assert!(sampled.message.contains("z^-3"), "{sampled}");
    }

    #[test]
    fn what_is_wrong_is_said_where_it_is() {
        let deep = format!("{}s", "(".repeat(1000));
        for (text, at, words) in [
            ("", 0, "ends here"),
            ("1 +", 3, "ends here"),
            ("(s + 1", 6, "not closed"),
            ("s + 1)", 5, "never opened"),
            ("2 $ 3", 2, "`$`"),
            ("2 G33 + 1", 2, "`G33`"),
            ("1/(s - s)", 9, "divided by zero"),
            ("1/(z+1)", 3, "how far apart"),
            ("s^2.5", 5, "whole number"),
            ("s^x", 2, "whole number"),
            ("s^(1+1)", 4, "one whole number"),
            ("s^2s", 3, "beside an exponent"),
            ("2^3^2", 3, "power of a power"),
            ("1/2s", 3, "a/(b c)"),
            ("1/s (s+1)", 4, "a/(b c)"),
            ("3/(s+2)(s+3)", 7, "a/(b c)"),
            ("1/(s2+1)", 4, "a power is written ^2"),
            ("(s+1)2", 5, "a power is written ^2"),
            ("ss", 1, "two letters"),
            ("2 3", 2, "two numbers"),
            ("2/(5s+1)*exp(-s)", 9, "pade(1, 3)"),
            ("exp(-s)+1/s", 11, "dead times of 1 and 0 s"),
            ("exp(-s+1)", 0, "exp(-0.2s)"),
            ("exp(-s^2)", 0, "exp(-0.2s)"),
            ("exp -s", 0, "in brackets"),
            ("exp(0.5s)", 9, "0.5 s early"),
            ("1/exp(-s)", 9, "1 s early"),
            ("2 e s", 2, "e^(-0.2s)"),
            ("pade(s, 3)", 0, "pade(0.2, 3)"),
            ("pade(0.2)", 0, "pade(0.2, 3)"),
            ("pade(0.2, 2.5)", 0, "pade(0.2, 3)"),
            ("pade(0.2, 99)", 13, "at most 15"),
            ("2,5", 1, "`,`"),
            ("s^99999999999999999999", 22, "beyond 60"),
            ("(s+1)^50 (s+2)^50", 17, "beyond 60"),
            ("1e999", 0, "more than"),
            ("1.2.3", 0, "no number"),
            (&deep, 50, "brackets"),
        ] {
            let error = TransferFunction::parse(text, Time::Continuous).unwrap_err();
            assert!(error.message.contains(words), "{text}: {error}");
            assert_eq!(error.at, at, "{text}: {error}");
        }
    }
}
