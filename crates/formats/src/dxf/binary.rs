//! Groups of binary DXF: a code of one or two bytes, and a value whose kind the code says (Autodesk's *DXF Reference*,
//! "Binary DXF Files" and "Group Code Value Types").

use super::groups::{At, Group, Value, is_text};
use crate::FormatError;

/// How a binary file begins.
pub(super) const SENTINEL: &[u8] = b"AutoCAD Binary DXF\r\n\x1a\x00";

/// The groups of a binary file.
pub(super) struct Typed<'a> {
    rest: &'a [u8],
    /// Length of the file, bytes, the sentinel with it.
    length: usize,
    /// Whether codes take two bytes, as from release 13 on.
    is_wide: bool,
}

/// How the value of a code is written.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// Up to a zero byte.
    Text,
    /// A byte that says how many follow.
    Chunk,
    /// A whole number of so many bytes, the low one first.
    Whole(usize),
    /// Eight bytes.
    Real,
}

const fn kind_of(code: i32) -> Option<Kind> {
    Some(match code {
        0..=9 | 100..=109 | 300..=309 | 320..=369 | 390..=399 | 410..=419 | 430..=439 | 470..=489 => {
            Kind::Text
        }
        999..=1003 | 1005..=1009 => Kind::Text,
        310..=319 | 1004 => Kind::Chunk,
        10..=59 | 110..=149 | 210..=239 | 460..=469 | 1010..=1059 => Kind::Real,
        60..=89 | 170..=179 | 270..=289 | 370..=389 | 400..=409 | 1060..=1070 => Kind::Whole(2),
        90..=99 | 420..=429 | 440..=459 | 1071 => Kind::Whole(4),
        160..=169 => Kind::Whole(8),
        290..=299 => Kind::Whole(1),
        _ => return None,
    })
}

impl<'a> Typed<'a> {
    /// The groups behind the sentinel.
    pub(super) fn new(rest: &'a [u8]) -> Self {
        // the first group is `0 SECTION`, or a comment of code 999 = 0x3e7: with two bytes for the code, these two
        let is_wide = matches!(rest, [_, 0, ..] | [0xe7, 3, ..]);
        Self { rest, length: SENTINEL.len() + rest.len(), is_wide }
    }

    /// The next group; `None` where the file ends.
    ///
    /// # Errors
    /// A code of no known kind.
    pub(super) fn group(&mut self) -> Result<Option<Group<'a>>, FormatError> {
        let Some(code) = self.code() else { return Ok(None) };
        let at = At::Byte(u32::try_from(self.offset()).unwrap_or(u32::MAX));
        let kind = kind_of(code)
            .ok_or_else(|| self.broken(format!("{code} is no group code; save the drawing again")))?;
        let value = self.value(kind, code);
        if value.is_none() {
            self.rest = &[]; // what is left is a part of a value
        }
        Ok(value.map(|value| Group { code, value, at }))
    }

    pub(super) fn broken(&self, message: String) -> FormatError {
        let message = format!("byte {} of a binary file: {message}", self.offset());
        FormatError::Syntax { format: "DXF", line: 1, column: 1, message }
    }

    const fn offset(&self) -> usize {
        self.length - self.rest.len()
    }

    fn code(&mut self) -> Option<i32> {
        if self.is_wide {
            return self.whole(2).map(|code| code as i32);
        }
        // the codes of a user's own data do not fit into one byte
        const ESCAPE: u8 = 255;
        match self.take(1)? {
            [ESCAPE] => self.whole(2).map(|code| code as i32),
            code => Some(i32::from(code[0])),
        }
    }

    fn value(&mut self, kind: Kind, code: i32) -> Option<Value<'a>> {
        match kind {
            Kind::Text => {
                let length = self.rest.iter().position(|&b| b == 0)?;
                let text = self.take(length + 1)?;
                let text = &text[..length];
                Some(Value::Text(if is_text(code) { text } else { text.trim_ascii() }))
            }
            Kind::Chunk => {
                let length = usize::from(self.take(1)?[0]);
                self.take(length).map(Value::Text)
            }
            Kind::Whole(bytes) => self.whole(bytes).map(Value::Whole),
            Kind::Real => {
                let bytes = self.take(8)?.try_into().ok()?;
                Some(Value::Number(f64::from_le_bytes(bytes)))
            }
        }
    }

    /// A whole number with its sign.
    fn whole(&mut self, bytes: usize) -> Option<i64> {
        let bytes = self.take(bytes)?;
        let is_negative = bytes.len() > 1 && bytes.last().is_some_and(|high| high & 0x80 != 0);
        let mut all = [if is_negative { 0xff } else { 0 }; 8];
        all[..bytes.len()].copy_from_slice(bytes);
        Some(i64::from_le_bytes(all))
    }

    fn take(&mut self, bytes: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(bytes)?;
        self.rest = rest;
        Some(taken)
    }
}
