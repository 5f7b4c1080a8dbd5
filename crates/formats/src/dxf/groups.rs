//! Groups (a code and a value) and records (all groups up to the next code 0), as ASCII and binary DXF both have them.

use std::fmt;

use tracelight_stroke::Point;

use crate::FormatError;

/// A group code with its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Group<'a> {
    pub(super) code: i32,
    pub(super) value: Value<'a>,
    pub(super) at: At,
}

/// What a group holds: text may be a number that is yet to be read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Value<'a> {
    /// Blanks trimmed but of text, see [`is_text`].
    Text(&'a [u8]),
    Number(f64),
    Whole(i64),
}

/// Where in a file a value stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum At {
    /// From 1.
    Line(u32),
    /// From 0, in a binary file.
    Byte(u32),
}

impl Default for At {
    fn default() -> Self {
        Self::Line(0)
    }
}

impl fmt::Display for At {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

/// A record: `0 LINE` and what follows it.
#[derive(Debug, Default)]
pub(super) struct Record<'a> {
    /// `LINE`, `SECTION`, …
    pub(super) kind: &'a [u8],
    pub(super) groups: Vec<Group<'a>>,
    /// Where its name stands.
    pub(super) at: At,
}

/// Numbers beyond this are a broken file's. Maps have six digits before the point, in millimetres nine.
const MAX_NUMBER: f64 = 1e12;

impl<'a> Group<'a> {
    /// Its value as a number.
    ///
    /// # Errors
    /// What is no number, not finite, or larger than any drawing.
    pub(super) fn number(&self) -> Result<f64, FormatError> {
        let number = match self.value {
            Value::Text(text) => std::str::from_utf8(text).ok().and_then(|v| v.parse::<f64>().ok()),
            Value::Number(number) => Some(number),
            Value::Whole(number) => Some(number as f64),
        };
        number.filter(|v| v.abs() <= MAX_NUMBER).ok_or_else(|| self.wrong("a number up to 1e12"))
    }

    /// Its value as a whole number; what is written as 1.0 is one too.
    ///
    /// # Errors
    /// What is no number.
    pub(super) fn whole(&self) -> Result<i64, FormatError> {
        self.number().map(|v| v as i64)
    }

    /// Its value as it stands in the file; nothing of a binary number.
    pub(super) const fn bytes(&self) -> &'a [u8] {
        match self.value {
            Value::Text(text) => text,
            Value::Number(_) | Value::Whole(_) => b"",
        }
    }

    fn wrong(&self, expected: &'static str) -> FormatError {
        let value = match self.value {
            Value::Text(text) => format!("{:?}", String::from_utf8_lossy(&text[..text.len().min(40)])),
            Value::Number(number) => format!("{number:e}"),
            Value::Whole(number) => number.to_string(),
        };
        FormatError::Value { place: self.at.to_string(), field: field(self.code), value, expected }
    }
}

/// What a group of numbers holds.
fn field(code: i32) -> &'static str {
    match code {
        10..=18 => "an x coordinate",
        20..=28 => "a y coordinate",
        30..=38 => "a z coordinate",
        40 => "a radius, factor or knot",
        42 => "a bulge or factor",
        50 | 51 => "an angle",
        62 => "a colour number",
        70..=78 => "a count or flag",
        _ => "a number",
    }
}

impl<'a> Record<'a> {
    fn first(&self, code: i32) -> Option<&Group<'a>> {
        self.groups.iter().find(|g| g.code == code)
    }

    /// The number of the first group of a code.
    ///
    /// # Errors
    /// What is no number.
    pub(super) fn number_or(&self, code: i32, otherwise: f64) -> Result<f64, FormatError> {
        self.first(code).map_or(Ok(otherwise), Group::number)
    }

    /// The whole number of the first group of a code.
    ///
    /// # Errors
    /// What is no number.
    pub(super) fn whole_or(&self, code: i32, otherwise: i64) -> Result<i64, FormatError> {
        self.first(code).map_or(Ok(otherwise), Group::whole)
    }

    /// A point: x at `code`, y ten codes later.
    ///
    /// # Errors
    /// What is no number.
    pub(super) fn point(&self, code: i32) -> Result<Point, FormatError> {
        Ok(Point::new(self.number_or(code, 0.0)?, self.number_or(code + 10, 0.0)?))
    }

    /// All numbers of a code.
    ///
    /// # Errors
    /// What is no number.
    pub(super) fn numbers(&self, code: i32) -> Result<Vec<f64>, FormatError> {
        self.groups.iter().filter(|g| g.code == code).map(Group::number).collect()
    }

    /// All points of x at `code` and y ten codes later.
    ///
    /// # Errors
    /// What is no number.
    pub(super) fn points(&self, code: i32) -> Result<Vec<Point>, FormatError> {
        let mut points: Vec<Point> = Vec::new();
        for group in &self.groups {
            match points.last_mut() {
                _ if group.code == code => points.push(Point::new(group.number()?, 0.0)),
                Some(last) if group.code == code + 10 => last.y = group.number()?,
                _ => {}
            }
        }
        Ok(points)
    }

    /// The text of the first group of a code; empty where there is none.
    pub(super) fn text(&self, code: i32) -> String {
        self.first(code).map_or_else(String::new, |g| text(g.bytes()))
    }

    /// The text without blanks and in one case: how names are told apart.
    pub(super) fn key(&self, code: i32) -> String {
        self.text(code).to_lowercase()
    }

    pub(super) fn has(&self, code: i32) -> bool {
        self.first(code).is_some()
    }

    /// Something that makes no sense in this record.
    pub(super) fn wrong(&self, field: &'static str, value: String, expected: &'static str) -> FormatError {
        let kind = String::from_utf8_lossy(&self.kind[..self.kind.len().min(20)]);
        FormatError::Value { place: format!("{kind} at {}", self.at), field, value, expected }
    }
}

/// Whether groups of a code hold text, which may begin and end with blanks: of an MTEXT's pieces each but the last one
/// may end between two words.
pub(super) const fn is_text(code: i32) -> bool {
    matches!(code, 1 | 3)
}

/// A name of any age: see [`characters`].
fn text(bytes: &[u8]) -> String {
    const LONGEST: usize = 255; // AutoCAD's own bound for a name
    characters(bytes.trim_ascii(), LONGEST)
}

/// Characters of any age, so many at most: UTF-8, else Latin-1, with `\U+00E9` for what neither the writer's code page nor ASCII has.
pub(super) fn characters(bytes: &[u8], most: usize) -> String {
    let plain = match std::str::from_utf8(bytes) {
        Ok(text) => text.chars().take(most).collect(),
        Err(_) => bytes.iter().take(most).map(|&b| char::from(b)).collect::<String>(),
    };
    let mut parts = plain.split("\\U+");
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let code = part.get(..4).and_then(|hex| u32::from_str_radix(hex, 16).ok());
        match code.and_then(char::from_u32) {
            Some(c) => {
                out.push(c);
                out.push_str(&part[4..]);
            }
            None => {
                out.push_str("\\U+");
                out.push_str(part);
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_any_age_are_read() {
        assert_eq!(text("Umriß".as_bytes()), "Umriß");
        assert_eq!(text(b"Umri\xdf"), "Umriß");
        assert_eq!(text(b"Umri\\U+00DF"), "Umriß");
        assert_eq!(text(b"\\U+ZZ \\U+D800 \\U+"), "\\U+ZZ \\U+D800 \\U+");
    }
}
