//! Groups of ASCII DXF: a code and a value on two lines.

use super::groups::{At, Group, Value, is_text};
use crate::FormatError;

/// The groups of an ASCII file.
pub(super) struct Lines<'a> {
    rest: &'a [u8],
    end_of_line: u8,
    line: u32,
    /// Whether all its numbers have a comma before their decimals.
    has_commas: bool,
}

impl<'a> Lines<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        // files of old Macintoshes end their lines with a carriage return alone
        let end_of_line = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
        let mut own = Self { rest: bytes, end_of_line, line: 0, has_commas: false };
        own.has_commas = own.decimals_follow_commas();
        own
    }

    /// The next group; `None` where the file ends.
    ///
    /// # Errors
    /// A code that is no number.
    pub(super) fn group(&mut self) -> Result<Option<Group<'a>>, FormatError> {
        let Some(code) = self.next_line().map(<[u8]>::trim_ascii) else { return Ok(None) };
        let code = std::str::from_utf8(code).ok().and_then(|c| c.parse().ok()).ok_or_else(|| {
            let code = String::from_utf8_lossy(&code[..code.len().min(40)]).into_owned();
            self.broken(format!("{code:?} is no group code; save the drawing again as ASCII DXF"))
        })?;
        let Some(value) = self.next_line() else { return Ok(None) };
        let value = if is_text(code) { value } else { value.trim_ascii() };
        let value = match self.has_commas && is_real(code) {
            true => with_comma(value).map_or(Value::Text(value), Value::Number),
            false => Value::Text(value),
        };
        Ok(Some(Group { code, value, at: At::Line(self.line) }))
    }

    pub(super) fn broken(&self, message: String) -> FormatError {
        FormatError::Syntax { format: "DXF", line: self.line as usize, column: 1, message }
    }

    fn next_line(&mut self) -> Option<&'a [u8]> {
        self.line = self.line.saturating_add(1);
        if self.rest.is_empty() {
            return None;
        }
        let length = self.rest.iter().position(|&b| b == self.end_of_line).unwrap_or(self.rest.len());
        let (line, rest) = self.rest.split_at(length);
        self.rest = rest.get(1..).unwrap_or_default();
        Some(line.strip_suffix(b"\r").unwrap_or(line))
    }

    /// Whether some real number of the file has a comma, and none a point: most files are known by their first number.
    fn decimals_follow_commas(&self) -> bool {
        let mut ahead = Self { rest: self.rest, line: 0, ..*self };
        let mut commas = false;
        while let (Some(code), Some(value)) = (ahead.next_line(), ahead.next_line()) {
            let code = std::str::from_utf8(code.trim_ascii()).ok().and_then(|c| c.parse().ok());
            if code.is_some_and(is_real) {
                if value.contains(&b'.') {
                    return false;
                }
                commas |= with_comma(value.trim_ascii()).is_some();
            }
        }
        commas
    }
}

/// Whether groups of a code hold real numbers.
const fn is_real(code: i32) -> bool {
    matches!(code, 10..=59 | 110..=149 | 210..=239 | 1010..=1059)
}

/// A number whose one comma stands before its decimals.
fn with_comma(value: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(value).ok()?;
    let (whole, decimals) = text.split_once(',')?;
    let is_plain = !whole.contains('.') && decimals.starts_with(|c: char| c.is_ascii_digit());
    is_plain.then(|| format!("{whole}.{decimals}").parse().ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commas_are_decimal_where_no_number_has_a_point() {
        let check = |values: [&str; 2], wanted: Option<f64>| {
            let text = format!("0\nLINE\n1\n1.5\n10\n{}\n20\n{}\n", values[0], values[1]);
            let mut lines = Lines::new(text.as_bytes());
            let groups: Vec<_> = std::iter::from_fn(|| lines.group().unwrap()).collect();
            assert_eq!(groups[2].number().ok(), wanted, "{values:?}");
        };
        check(["12,5", "7"], Some(12.5));
        check(["-0,25e1", "1,0"], Some(-2.5));
        check(["12,5", "7.0"], None);
        check(["1,234,5", "7"], None);
        check(["12,", "7"], None);
    }
}
