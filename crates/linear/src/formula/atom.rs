//! Numbers, the variable, names, brackets, dead times.

use super::part::{FormulaError, Part};
use super::reader::Reader;
use crate::{Polynomial, Time, TransferFunction};

impl Reader<'_> {
    pub(super) fn atom(&mut self) -> Result<Part, FormulaError> {
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
    fn name(&mut self) -> Result<Part, FormulaError> {
        let rest = &self.characters[self.at..];
        let name: String = rest.iter().take_while(|c| c.is_alphanumeric()).collect();
        match name.as_str() {
            "exp" => return self.dead_time(3),
            "e" if self.characters.get(self.at + 1) == Some(&'^') => return self.dead_time(2),
            "pade" => return self.pade(),
            _ => {}
        }
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
        // another sampling does not go together with this one
        self.checked(system.rational().series(&TransferFunction::gain(1.0, self.time)), system.delay_s())
    }

    /// `exp(-0.2s)`, of which so many letters stand before the bracket.
    fn dead_time(&mut self, letters: usize) -> Result<Part, FormulaError> {
        let start = self.at;
        let refused = |at: usize, message: &str| Err(FormulaError { at, message: message.to_owned() });
        if self.time != Time::Continuous {
            return refused(start, "a dead time of samples is a power of z: z^-3 is three samples late");
        }
        self.at += letters;
        if self.next() != Some('(') {
            return refused(start, "a dead time is written exp(-0.2s), in brackets");
        }
        let inside = self.atom()?;
        let above = inside.rational.numerator();
        let is_time =
            inside.rational.denominator().degree() == 0 && above.degree() <= 1 && above.constant() == 0.0;
        if !is_time || inside.delay_s != 0.0 {
            return refused(start, "a dead time is exp of a number times s: exp(-0.2s)");
        }
        let delay_s = if above.is_zero() { 0.0 } else { -above.leading() };
        Ok(Part { rational: TransferFunction::gain(1.0, self.time), delay_s })
    }

    /// `pade(0.2, 3)`: a dead time and an order.
    fn pade(&mut self) -> Result<Part, FormulaError> {
        let start = self.at;
        let wrong = || FormulaError {
            at: start,
            message: "an approximation of a dead time is written pade(seconds, order): pade(0.2, 3)"
                .to_owned(),
        };
        if self.time != Time::Continuous {
            let message = "a dead time of samples is a power of z: z^-3 is three samples late".to_owned();
            return Err(FormulaError { at: start, message });
        }
        self.at += 4;
        let mut numbers = [0.0; 2];
        for (number, before) in numbers.iter_mut().zip(['(', ',']) {
            if self.next() != Some(before) {
                return Err(wrong());
            }
            self.at += 1;
            if !self.next().is_some_and(|c| c.is_ascii_digit() || c == '.') {
                return Err(wrong());
            }
            *number = self.number()?.rational.dc_gain();
        }
        if self.next() != Some(')') || numbers[1].fract() != 0.0 {
            return Err(wrong());
        }
        self.at += 1;
        let order = numbers[1].min(1e6) as usize;
        self.checked(TransferFunction::pade(numbers[0], order), 0.0)
    }

    fn unknown(&self, name: &str) -> FormulaError {
        let variable = self.time.variable();
        match name {
            "e" => self.error("a dead time is written exp(-0.2s) or e^(-0.2s)"),
            _ => {
                self.error(&format!("`{name}` is no system that is known here, no number and not {variable}"))
            }
        }
    }

    fn variable(&mut self, c: char) -> Result<Part, FormulaError> {
        if self.time.variable() != c.to_string() {
            let hint = match c {
                's' => "s is of continuous time, and this system is sampled",
                _ => "z is of samples: say how far apart they are",
            };
            return Err(self.error(hint));
        }
        self.at += 1;
        self.checked(TransferFunction::new(Polynomial::new([1.0, 0.0]), Polynomial::one(), self.time), 0.0)
    }

    fn number(&mut self) -> Result<Part, FormulaError> {
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
        Ok(TransferFunction::gain(value, self.time).into())
    }
}
