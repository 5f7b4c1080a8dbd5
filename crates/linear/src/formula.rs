//! Transfer functions from text.

use thiserror::Error;

use crate::{LinearError, Polynomial, Time, TransferFunction};

/// What is wrong with a formula, and where.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{message}")]
pub struct FormulaError {
    /// Characters before the place.
    pub at: usize,
    /// What is wrong there and what would be right.
    pub message: String,
}

/// Powers a formula may reach: more is a slip, and multiplying it out would take for ever.
const MOST_ORDER: usize = 60;
/// Brackets in brackets.
const MOST_DEPTH: usize = 50;

impl TransferFunction {
    /// From text like `281 (s + 32.9)(s + 97.8) / ((s + 250)(s + 177))`: numbers, the variable (s, or z of samples), + − * / ^ and
    /// brackets. Factors may stand side by side; after a/(b) and a space the next one multiplies the quotient. Nothing is cancelled.
    ///
    /// Text that can be read in two ways is refused: `1/2s`, `1/s(s+1)`, `s2`, `s^2s`, `2^3^2`.
    ///
    /// # Errors
    /// What is wrong, where, and what to write.
    pub fn parse(text: &str, time: Time) -> Result<Self, FormulaError> {
        Self::parse_with(text, time, &|_| None)
    }

    /// Reads a formula in which names like `G11`, a letter other than the variable and what letters and digits follow, stand for systems.
    pub fn parse_with(text: &str, time: Time, named: &Names<'_>) -> Result<Self, FormulaError> {
        let mut reader =
            Reader { characters: text.chars().map(plain).collect(), at: 0, depth: 0, time, named };
        let whole = reader.sum()?;
        match reader.next() {
            None => Ok(whole),
            Some(')') => Err(reader.error("this bracket was never opened")),
            Some(other) => Err(reader.error(&format!("`{other}` is not part of a formula"))),
        }
    }
}

/// Systems by name.
pub type Names<'a> = dyn Fn(&str) -> Option<TransferFunction> + 'a;

/// Signs as they are printed, as they are typed.
const fn plain(c: char) -> char {
    match c {
        '−' | '–' => '-',
        '·' | '×' | '⋅' => '*',
        _ => c,
    }
}

struct Reader<'a> {
    characters: Vec<char>,
    at: usize,
    depth: usize,
    time: Time,
    named: &'a Names<'a>,
}

impl Reader<'_> {
    /// The next character that is no space.
    fn next(&mut self) -> Option<char> {
        while self.characters.get(self.at).is_some_and(|c| c.is_whitespace()) {
            self.at += 1;
        }
        self.characters.get(self.at).copied()
    }

    fn error(&self, message: &str) -> FormulaError {
        FormulaError { at: self.at, message: message.to_owned() }
    }

    fn checked(
        &self,
        result: Result<TransferFunction, LinearError>,
    ) -> Result<TransferFunction, FormulaError> {
        let value = result.map_err(|e| match e {
            LinearError::NoDenominator => self.error("here it is divided by zero"),
            e => self.error(&e.to_string()),
        })?;
        if value.numerator().degree().max(value.denominator().degree()) > MOST_ORDER {
            return Err(self.error(&format!("powers beyond {MOST_ORDER} are not read")));
        }
        Ok(value)
    }

    fn sum(&mut self) -> Result<TransferFunction, FormulaError> {
        let mut value = self.product()?;
        while let Some(sign @ ('+' | '-')) = self.next() {
            self.at += 1;
            let next = self.product()?;
            value = self.checked(value.parallel(&if sign == '-' { next.scaled(-1.0) } else { next }))?;
        }
        Ok(value)
    }

    fn product(&mut self) -> Result<TransferFunction, FormulaError> {
        let mut value = self.signed()?;
        let mut is_divided = false;
        loop {
            match self.next() {
                Some('*') => {
                    self.at += 1;
                    is_divided = false;
                    let next = self.signed()?;
                    value = self.checked(value.series(&next))?;
                }
                Some('/') => {
                    self.at += 1;
                    let below = self.signed()?;
                    is_divided = true;
                    let inverse = self.checked(below.inverse())?;
                    value = self.checked(value.series(&inverse))?;
                }
                Some(c) if c == '(' || c.is_alphanumeric() || c == '.' => {
                    // behind brackets and a space the quotient ends
                    let is_apart = self.characters[..self.at].ends_with(&[' ']) && self.before() == Some(')');
                    if is_divided && !is_apart {
                        return Err(self.error(
                            "does this multiply what is below the line, or the quotient? Write a/(b c) or a/b*c",
                        ));
                    }
                    self.stands_alone(c)?;
                    is_divided = false;
                    let next = self.power()?;
                    value = self.checked(value.series(&next))?;
                }
                _ => return Ok(value),
            }
        }
    }

    /// The last character before this place that is no space.
    fn before(&self) -> Option<char> {
        self.characters[..self.at].iter().rev().find(|c| !c.is_whitespace()).copied()
    }

    /// Refuses a factor that stands beside another in a way that may mean something else.
    fn stands_alone(&self, c: char) -> Result<(), FormulaError> {
        let before = self.before();
        let touches = self.at > 0 && !self.characters[self.at - 1].is_whitespace();
        let is_number = c.is_ascii_digit() || c == '.';
        let rest = self.characters[self.at..].iter();
        let is_lone_digit = rest.take_while(|c| c.is_alphanumeric() || **c == '.').count() == 1;
        let message = match before {
            Some(b) if is_number && (b.is_ascii_digit() || b == '.') => {
                "two numbers side by side: write * between them"
            }
            Some(b) if is_number && b.is_alphabetic() => {
                "a digit behind a letter: a power is written ^2, a factor stands in front"
            }
            Some(')') if is_number && touches && is_lone_digit => {
                "a digit behind a bracket: a power is written ^2, a product *2"
            }
            Some(b) if touches && b.is_alphabetic() && c.is_alphabetic() => {
                "two letters side by side: a power is written s^2, a product with * or a space"
            }
            _ => return Ok(()),
        };
        Err(self.error(message))
    }

    fn signed(&mut self) -> Result<TransferFunction, FormulaError> {
        let sign = match self.next() {
            Some('-') => -1.0,
            Some('+') => 1.0,
            _ => return self.power(),
        };
        self.at += 1;
        self.nested(|reader| Ok(reader.signed()?.scaled(sign)))
    }

    /// Goes one deeper.
    fn nested(
        &mut self,
        inner: impl FnOnce(&mut Self) -> Result<TransferFunction, FormulaError>,
    ) -> Result<TransferFunction, FormulaError> {
        if self.depth >= MOST_DEPTH {
            return Err(self.error(&format!("more than {MOST_DEPTH} brackets and signs in each other")));
        }
        self.depth += 1;
        let value = inner(self);
        self.depth -= 1;
        value
    }

    fn power(&mut self) -> Result<TransferFunction, FormulaError> {
        let base = self.atom()?;
        let Some((is_inverse, exponent)) = self.exponent()? else { return Ok(base) };
        let order = base.numerator().degree().max(base.denominator().degree()).max(1);
        if exponent.saturating_mul(order) > MOST_ORDER {
            return Err(self.error(&format!("powers beyond {MOST_ORDER} are not read")));
        }
        let base = if is_inverse { self.checked(base.inverse())? } else { base };
        let one = TransferFunction::gain(1.0, self.time);
        (0..exponent).try_fold(one, |power, _| self.checked(power.series(&base)))
    }

    /// `^2`, `**2`, `^-1`, `^(2)` or `²`: whether it is negative, and its size.
    fn exponent(&mut self) -> Result<Option<(bool, usize)>, FormulaError> {
        const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
        let sign = self.next();
        if let Some(raised) = self.digits(|c| RAISED.iter().position(|&r| r == c)) {
            return Ok(Some((false, raised)));
        }
        let length = match (sign, self.characters.get(self.at + 1)) {
            (Some('^'), _) => 1,
            (Some('*'), Some('*')) => 2,
            _ => return Ok(None),
        };
        self.at += length;
        let in_brackets = self.next() == Some('(');
        self.at += usize::from(in_brackets);
        let is_inverse = self.next() == Some('-');
        self.at += usize::from(is_inverse || self.next() == Some('+'));
        let _ = self.next();
        let wrong = "an exponent is a whole number";
        let size = self.digits(|c| c.to_digit(10).map(|d| d as usize)).ok_or_else(|| self.error(wrong))?;
        // 2.0 is whole
        if self.characters.get(self.at) == Some(&'.') {
            self.at += 1;
            if self.digits(|c| c.to_digit(10).map(|d| d as usize)).is_some_and(|part| part > 0) {
                return Err(self.error(wrong));
            }
        }
        if in_brackets {
            if self.next() != Some(')') {
                return Err(self.error("an exponent in brackets is one whole number"));
            }
            self.at += 1;
        }
        match self.characters.get(self.at).copied() {
            Some(c) if !in_brackets && (c.is_alphabetic() || c == '.') => {
                Err(self.error("this stands beside an exponent: write a space or * between them"))
            }
            _ if matches!(self.next(), Some('^')) || self.characters[self.at..].starts_with(&['*', '*']) => {
                Err(self.error("a power of a power: write brackets"))
            }
            _ => Ok(Some((is_inverse, size))),
        }
    }

    /// A whole number, if one stands here.
    fn digits(&mut self, digit: impl Fn(char) -> Option<usize>) -> Option<usize> {
        let mut value = None;
        while let Some(d) = self.characters.get(self.at).and_then(|&c| digit(c)) {
            value = Some(value.unwrap_or(0_usize).saturating_mul(10).saturating_add(d));
            self.at += 1;
        }
        value
    }

    fn atom(&mut self) -> Result<TransferFunction, FormulaError> {
        match self.next() {
            Some('(') => self.nested(|reader| {
                reader.at += 1;
                let value = reader.sum()?;
                if reader.next() != Some(')') {
                    return Err(reader.error("a bracket is not closed"));
                }
                reader.at += 1;
                Ok(value)
            }),
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c @ ('s' | 'z')) => self.variable(c),
            Some(c) if c.is_alphabetic() => self.name(),
            Some(c) => {
                Err(self
                    .error(&format!("`{c}` is neither a number nor {} nor a bracket", self.time.variable())))
            }
            None => Err(self.error("the formula ends here, and something is missing")),
        }
    }

    /// A system's name; `G11(s)` is `G11`.
    fn name(&mut self) -> Result<TransferFunction, FormulaError> {
        let rest = &self.characters[self.at..];
        let name: String = rest.iter().take_while(|c| c.is_alphanumeric()).collect();
        let Some(system) = (self.named)(&name) else { return Err(self.unknown(&name)) };
        self.at += name.chars().count();
        if self.characters.get(self.at) == Some(&'(') {
            let variable = self.time.variable();
            let inside = self.characters[self.at + 1..].split(|c| *c == ')').next().unwrap_or_default();
            let length = inside.len() + 2;
            let is_variable = inside.iter().filter(|c| !c.is_whitespace()).collect::<String>() == variable;
            if !is_variable || self.at + length > self.characters.len() {
                return Err(self.error(&format!(
                    "{name}({variable}) is {name} itself; a product is written {name} * (…)"
                )));
            }
            self.at += length;
        }
        self.checked(system.series(&TransferFunction::gain(1.0, self.time)))
    }

    fn unknown(&self, name: &str) -> FormulaError {
        let variable = self.time.variable();
        match name {
            "exp" | "e" => {
                self.error("a dead time is not computed here: approximate e^(−sT) by (1 − sT/2)/(1 + sT/2)")
            }
            _ => {
                self.error(&format!("`{name}` is no system that is known here, no number and not {variable}"))
            }
        }
    }

    fn variable(&mut self, c: char) -> Result<TransferFunction, FormulaError> {
        if self.time.variable() != c.to_string() {
            let hint = match c {
                's' => "s is of continuous time, and this system is sampled",
                _ => "z is of samples: say how far apart they are",
            };
            return Err(self.error(hint));
        }
        self.at += 1;
        self.checked(TransferFunction::new(Polynomial::new([1.0, 0.0]), Polynomial::one(), self.time))
    }

    fn number(&mut self) -> Result<TransferFunction, FormulaError> {
        let start = self.at;
        let digit = |reader: &Self, at: usize| reader.characters.get(at).is_some_and(char::is_ascii_digit);
        while digit(self, self.at) || self.characters.get(self.at) == Some(&'.') {
            self.at += 1;
        }
        if matches!(self.characters.get(self.at), Some('e' | 'E')) {
            let sign = usize::from(matches!(self.characters.get(self.at + 1), Some('+' | '-')));
            if digit(self, self.at + 1 + sign) {
                self.at += 1 + sign;
                while digit(self, self.at) {
                    self.at += 1;
                }
            }
        }
        let text: String = self.characters[start..self.at].iter().collect();
        let value: f64 =
            text.parse().map_err(|_| FormulaError { at: start, message: format!("{text} is no number") })?;
        if !value.is_finite() {
            return Err(FormulaError {
                at: start,
                message: format!("{text} is more than can be computed with"),
            });
        }
        Ok(TransferFunction::gain(value, self.time))
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
        let named = |name: &str| (name == "K2").then(|| parse("2/(s+1)"));
        for text in ["K2/s*K2", "K2(s) K2(s)/s", "K2(s)K2( s )/s"] {
            let product = TransferFunction::parse_with(text, Time::Continuous, &named).unwrap();
            assert_eq!(product.denominator().coefficients(), [1.0, 2.0, 1.0, 0.0], "{text}");
        }
        let error = TransferFunction::parse_with("K2(s+1)", Time::Continuous, &named).unwrap_err();
        assert!(error.at == 2 && error.message.contains("K2 * (…)"), "{error}");
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
            ("2/(5s+1)*exp(-s)", 9, "dead time"),
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
