//! Sums, products and powers.

use super::part::{FormulaError, Names, Part};
use crate::{LinearError, Time, TransferFunction};

/// Powers a formula may reach: more is a slip, and multiplying it out would take for ever.
const MOST_ORDER: usize = 60;
/// Brackets in brackets.
const MOST_DEPTH: usize = 50;

pub(super) struct Reader<'a> {
    pub(super) characters: Vec<char>,
    pub(super) at: usize,
    pub(super) depth: usize,
    pub(super) time: Time,
    pub(super) named: &'a Names<'a>,
}

impl Reader<'_> {
    /// The next character that is no space.
    pub(super) fn next(&mut self) -> Option<char> {
        while self.characters.get(self.at).is_some_and(|c| c.is_whitespace()) {
            self.at += 1;
        }
        self.characters.get(self.at).copied()
    }

    pub(super) fn error(&self, message: &str) -> FormulaError {
        FormulaError { at: self.at, message: message.to_owned() }
    }

    pub(super) fn checked(
        &self,
        result: Result<TransferFunction, LinearError>,
        delay_s: f64,
    ) -> Result<Part, FormulaError> {
        let rational = result.map_err(|e| match e {
            LinearError::NoDenominator => self.error("here it is divided by zero"),
            e => self.error(&e.to_string()),
        })?;
        if rational.numerator().degree().max(rational.denominator().degree()) > MOST_ORDER {
            return Err(self.error(&format!("powers beyond {MOST_ORDER} are not read")));
        }
        if !delay_s.is_finite() {
            return Err(self.error("this dead time is more than can be computed with"));
        }
        Ok(Part { rational, delay_s })
    }

    fn series(&self, first: &Part, next: &Part) -> Result<Part, FormulaError> {
        let (a, b) = (first.delay_s, next.delay_s);
        // what takes a dead time back leaves none
        let delay_s = if (a + b).abs() <= 8.0 * f64::EPSILON * a.abs().max(b.abs()) { 0.0 } else { a + b };
        self.checked(first.rational.series(&next.rational), delay_s)
    }

    fn inverse(&self, of: &Part) -> Result<Part, FormulaError> {
        self.checked(of.rational.inverse(), -of.delay_s)
    }

    /// The sum of parts that are equally late; nothing is as late as anything.
    fn added(&self, one: &Part, other: &Part) -> Result<Part, FormulaError> {
        let (a, b) = (one.delay_s, other.delay_s);
        let is_same = (a - b).abs() <= 8.0 * f64::EPSILON * a.abs().max(b.abs());
        if !(is_same || one.is_zero() || other.is_zero()) {
            return Err(self.error(&format!(
                "what is added here has dead times of {a} and {b} s; only equal ones are added: approximate one by pade({}, 3)",
                a.abs().max(b.abs())
            )));
        }
        self.checked(one.rational.parallel(&other.rational), if one.is_zero() { b } else { a })
    }

    pub(super) fn sum(&mut self) -> Result<Part, FormulaError> {
        let mut value = self.product()?;
        while let Some(sign @ ('+' | '-')) = self.next() {
            self.at += 1;
            let next = self.product()?;
            value = self.added(&value, &if sign == '-' { next.scaled(-1.0) } else { next })?;
        }
        Ok(value)
    }

    fn product(&mut self) -> Result<Part, FormulaError> {
        let mut value = self.signed()?;
        let mut is_divided = false;
        loop {
            match self.next() {
                Some('*') => {
                    self.at += 1;
                    is_divided = false;
                    let next = self.signed()?;
                    value = self.series(&value, &next)?;
                }
                Some('/') => {
                    self.at += 1;
                    let below = self.signed()?;
                    is_divided = true;
                    let inverse = self.inverse(&below)?;
                    value = self.series(&value, &inverse)?;
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
                    value = self.series(&value, &next)?;
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

    fn signed(&mut self) -> Result<Part, FormulaError> {
        let sign = match self.next() {
            Some('-') => -1.0,
            Some('+') => 1.0,
            _ => return self.power(),
        };
        self.at += 1;
        self.nested(|reader| Ok(reader.signed()?.scaled(sign)))
    }

    /// Goes one deeper.
    pub(super) fn nested(
        &mut self,
        inner: impl FnOnce(&mut Self) -> Result<Part, FormulaError>,
    ) -> Result<Part, FormulaError> {
        if self.depth >= MOST_DEPTH {
            return Err(self.error(&format!("more than {MOST_DEPTH} brackets and signs in each other")));
        }
        self.depth += 1;
        let value = inner(self);
        self.depth -= 1;
        value
    }

    pub(super) fn power(&mut self) -> Result<Part, FormulaError> {
        let base = self.atom()?;
        let Some((is_inverse, exponent)) = self.exponent()? else { return Ok(base) };
        let order = base.rational.numerator().degree().max(base.rational.denominator().degree()).max(1);
        if exponent.saturating_mul(order) > MOST_ORDER {
            return Err(self.error(&format!("powers beyond {MOST_ORDER} are not read")));
        }
        let base = if is_inverse { self.inverse(&base)? } else { base };
        let one = Part::from(TransferFunction::gain(1.0, self.time));
        (0..exponent).try_fold(one, |power, _| self.series(&power, &base))
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
}
