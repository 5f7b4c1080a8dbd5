//! Where in a file something is wrong.

use std::ops::Range;

/// A place in a file, for messages.
pub(crate) struct Mark<'a> {
    /// Its name.
    pub(crate) file: &'a str,
    /// All of it.
    pub(crate) text: &'a str,
    /// Bytes; without it the message names the file alone.
    pub(crate) span: Option<Range<usize>>,
}

/// Longest line that is shown, characters.
const SHOWN: usize = 120;

impl Mark<'_> {
    /// `file:line:column: what`, the line, and carets under the place.
    pub(crate) fn message(&self, what: &str) -> String {
        let Some(span) = &self.span else { return format!("{}: {what}", self.file) };
        let start = span.start.min(self.text.len());
        let before = &self.text.as_bytes()[..start];
        let number = 1 + before.iter().filter(|&&b| b == b'\n').count();
        let line_start = before.iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
        let rest = self.text.get(line_start..).unwrap_or_default();
        let line: String = rest.lines().next().unwrap_or_default().chars().take(SHOWN).collect();
        let column = String::from_utf8_lossy(&before[line_start..]).chars().count();
        let width = span.end.saturating_sub(span.start).clamp(1, SHOWN.saturating_sub(column).max(1));
        let (gutter, carets) = (" ".repeat(number.to_string().len()), "^".repeat(width));
        let indent = " ".repeat(column.min(SHOWN));
        format!(
            "{}:{number}:{}: {what}\n{gutter} |\n{number} | {line}\n{gutter} | {indent}{carets}",
            self.file,
            column + 1
        )
    }
}
