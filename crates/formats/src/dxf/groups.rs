//! Bytes to groups (a code and a value on two lines), groups to records (all groups up to the next code 0).

use tracelight_stroke::Point;

use crate::FormatError;

/// A group code with its value, blanks trimmed but of text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Group<'a> {
    pub(super) code: i32,
    pub(super) value: &'a [u8],
    /// The value's line, from 1.
    line: u32,
}

/// A record: `0 LINE` and what follows it.
#[derive(Debug, Default)]
pub(super) struct Record<'a> {
    /// `LINE`, `SECTION`, …
    pub(super) kind: &'a [u8],
    pub(super) groups: Vec<Group<'a>>,
    /// Line of its name, from 1.
    pub(super) line: u32,
}

/// The records of a file, one after another.
pub(super) struct Records<'a> {
    rest: &'a [u8],
    end_of_line: u8,
    line: u32,
    /// The group of code 0 that ended the record before.
    next: Option<Group<'a>>,
}

/// Groups of one record at most: a polyline of a million vertices.
const MAX_GROUPS: usize = 4_000_000;

/// Numbers beyond this are a broken file's. Maps have six digits before the point, in millimetres nine.
const MAX_NUMBER: f64 = 1e12;

impl<'a> Records<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        // files of old Macintoshes end their lines with a carriage return alone
        let end_of_line = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
        Self { rest: bytes, end_of_line, line: 0, next: None }
    }

    /// Reads the next record into `record`, whose memory is used again. `false` after `EOF`.
    ///
    /// # Errors
    /// A code that is no number, a file that ends without `EOF`, a record beyond all measure.
    pub(super) fn read(&mut self, record: &mut Record<'a>) -> Result<bool, FormatError> {
        record.groups.clear();
        let first = loop {
            match self.next.take() {
                Some(group) if group.code == 0 => break group,
                // comments may stand before the first record
                _ => self.next = Some(self.group()?),
            }
        };
        (record.kind, record.line) = (first.value, first.line);
        if first.value == b"EOF" {
            return Ok(false);
        }
        loop {
            let group = self.group()?;
            if group.code == 0 {
                self.next = Some(group);
                return Ok(true);
            }
            record.groups.push(group);
            if record.groups.len() > MAX_GROUPS {
                let found = record.groups.len();
                return Err(FormatError::TooLarge {
                    what: "DXF's entity",
                    found,
                    unit: "groups",
                    limit: MAX_GROUPS,
                });
            }
        }
    }

    fn group(&mut self) -> Result<Group<'a>, FormatError> {
        let code = self.next_line()?.trim_ascii();
        let code = std::str::from_utf8(code).ok().and_then(|c| c.parse().ok()).ok_or_else(|| {
            let code = String::from_utf8_lossy(&code[..code.len().min(40)]).into_owned();
            self.broken(format!("{code:?} is no group code; save the drawing again as ASCII DXF"))
        })?;
        let value = self.next_line()?;
        // a text may begin and end with blanks; of an MTEXT's pieces each but the last one may end between two words
        let value = if matches!(code, 1 | 3) { value } else { value.trim_ascii() };
        Ok(Group { code, value, line: self.line })
    }

    fn next_line(&mut self) -> Result<&'a [u8], FormatError> {
        self.line = self.line.saturating_add(1);
        if self.rest.is_empty() {
            return Err(self.broken("the file is cut off, it does not end with EOF; save it again".into()));
        }
        let length = self.rest.iter().position(|&b| b == self.end_of_line).unwrap_or(self.rest.len());
        let (line, rest) = self.rest.split_at(length);
        self.rest = rest.get(1..).unwrap_or_default();
        Ok(line.strip_suffix(b"\r").unwrap_or(line))
    }

    fn broken(&self, message: String) -> FormatError {
        FormatError::Syntax { format: "DXF", line: self.line as usize, column: 1, message }
    }
}

impl<'a> Group<'a> {
    /// Its value as a number.
    ///
    /// # Errors
    /// What is no number, not finite, or larger than any drawing.
    pub(super) fn number(&self) -> Result<f64, FormatError> {
        let number = std::str::from_utf8(self.value).ok().and_then(|v| v.parse::<f64>().ok());
        number.filter(|v| v.abs() <= MAX_NUMBER).ok_or_else(|| self.wrong("a number up to 1e12"))
    }

    /// Its value as a whole number; what is written as 1.0 is one too.
    ///
    /// # Errors
    /// What is no number.
    pub(super) fn whole(&self) -> Result<i64, FormatError> {
        self.number().map(|v| v as i64)
    }

    fn wrong(&self, expected: &'static str) -> FormatError {
        let shown = String::from_utf8_lossy(&self.value[..self.value.len().min(40)]).into_owned();
        FormatError::Value {
            place: format!("line {}", self.line),
            field: field(self.code),
            value: format!("{shown:?}"),
            expected,
        }
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

    /// The text of the first group of a code; empty where there is none.
    pub(super) fn text(&self, code: i32) -> String {
        self.first(code).map_or_else(String::new, |g| text(g.value))
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
        FormatError::Value { place: format!("{kind} at line {}", self.line), field, value, expected }
    }
}

/// A name of any age: see [`characters`].
fn text(bytes: &[u8]) -> String {
    const LONGEST: usize = 255; // AutoCAD's own bound for a name
    characters(bytes, LONGEST)
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
    fn records_end_where_the_next_one_begins() {
        let check = |bytes: &[u8]| {
            let mut records = Records::new(bytes);
            let mut record = Record::default();
            assert!(records.read(&mut record).unwrap());
            assert_eq!((record.kind, record.groups.len(), record.key(8)), (&b"LINE"[..], 2, "a".into()));
            assert_eq!(record.number_or(10, 0.0).unwrap(), 1.5);
            assert!(!records.read(&mut record).unwrap());
        };
        check(b"999\ncomment\n  0\nLINE\n  8\nA\n 10\n1.5\n  0\nEOF\n");
        check(b"0\r\nLINE\r\n8\r\nA\r\n10\r\n1.5\r\n0\r\nEOF");
        check(b"0\rLINE\r8\rA\r10\r1.5\r0\rEOF\r");
    }

    #[test]
    fn what_is_no_number_is_named_with_its_line() {
        let check = |bytes: &[u8], message: &str| {
            let mut record = Record::default();
            let found = Records::new(bytes).read(&mut record).and_then(|_| record.number_or(10, 0.0));
            let found = found.unwrap_err().to_string();
            assert!(found.contains(message), "{found}");
        };
        check(b"0\nLINE\n10\nleft\n0\nEOF\n", "line 4: an x coordinate is \"left\", expected a number");
        check(b"0\nLINE\n10\nNaN\n0\nEOF\n", "line 4");
        check(b"0\nLINE\n10\ninf\n0\nEOF\n", "line 4");
        check(b"0\nLINE\n10\n1e300\n0\nEOF\n", "line 4");
        check(b"0\nLINE\nten\n1\n", "line 3, column 1: not valid DXF: \"ten\" is no group code");
        check(b"0\nLINE\n10\n", "line 4, column 1: not valid DXF: the file is cut off");
        check(b"", "line 1, column 1: not valid DXF: the file is cut off");
    }

    #[test]
    fn names_of_any_age_are_read() {
        assert_eq!(text("Umriß".as_bytes()), "Umriß");
        assert_eq!(text(b"Umri\xdf"), "Umriß");
        assert_eq!(text(b"Umri\\U+00DF"), "Umriß");
        assert_eq!(text(b"\\U+ZZ \\U+D800 \\U+"), "\\U+ZZ \\U+D800 \\U+");
    }
}
