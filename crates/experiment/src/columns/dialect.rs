//! How a table of numbers is written: its characters, what separates its columns, its decimal sign, its header, its comments.

use std::borrow::Cow;

use super::clock;

/// Rows by which a table is judged.
const JUDGED: usize = 200;
/// What a line that is a comment begins with.
const COMMENTS: [&str; 3] = ["#", "%", "//"];

/// What separates columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Separator {
    Comma,
    Semicolon,
    Tab,
    /// One or more.
    Spaces,
}

/// How a table is written.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Dialect {
    separator: Separator,
    /// Numbers have a comma where others have a point.
    comma: bool,
    /// Above the columns; none without a header.
    pub(super) names: Vec<String>,
    /// Units in a row below the names; empty where there is none.
    pub(super) units: Vec<String>,
    /// Columns of its first row.
    pub(super) columns: usize,
    /// Lines before its first row.
    before: usize,
}

/// The text of a file: UTF-8 with or without a mark, UTF-16 with one, or else Latin-1.
pub(super) fn text(bytes: &[u8]) -> Cow<'_, str> {
    let wide = |order: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes[2..].chunks_exact(2).map(|pair| order([pair[0], pair[1]])).collect();
        Cow::Owned(String::from_utf16_lossy(&units))
    };
    match bytes {
        [0xff, 0xfe, ..] => wide(u16::from_le_bytes),
        [0xfe, 0xff, ..] => wide(u16::from_be_bytes),
        _ => {
            let bytes = bytes.strip_prefix(&[0xef, 0xbb, 0xbf]).unwrap_or(bytes);
            std::str::from_utf8(bytes).map_or_else(
                |_| Cow::Owned(bytes.iter().map(|&byte| char::from(byte)).collect()),
                Cow::Borrowed,
            )
        }
    }
}

impl Dialect {
    /// How a text is written; `None` if no separator makes rows of two numbers or more of it.
    pub(super) fn of(text: &str) -> Option<Self> {
        let tries = [
            (Separator::Tab, false),
            (Separator::Semicolon, false),
            (Separator::Comma, false),
            (Separator::Spaces, false),
            (Separator::Tab, true),
            (Separator::Semicolon, true),
            (Separator::Spaces, true),
        ];
        let (mut best, mut most) = (None, 0);
        for (separator, comma) in tries {
            let dialect =
                Self { separator, comma, names: Vec::new(), units: Vec::new(), columns: 0, before: 0 };
            let score = dialect.score(text);
            // of two that read as much the first is the plainer one
            if score > most {
                (best, most) = (Some(dialect), score);
            }
        }
        best.map(|dialect| dialect.with_header(text))
    }

    /// By how many the first rows have more numbers than other cells.
    fn score(&self, text: &str) -> usize {
        let lines = text.lines().filter(|line| !is_idle(line));
        lines.map(|line| self.numbers(line)).filter(|more| *more > 0).take(JUDGED).sum()
    }

    /// By how many a line has more numbers than other cells; none if it is no row of numbers.
    fn numbers(&self, line: &str) -> usize {
        let cells = self.cells(line);
        let filled = cells.iter().filter(|cell| !cell.is_empty()).count();
        let count = cells.iter().filter(|cell| self.is_value(cell)).count();
        if count > 1 { (2 * count).saturating_sub(filled) } else { 0 }
    }

    fn is_value(&self, cell: &str) -> bool {
        self.number(cell).is_some() || clock::of_day(cell).is_some()
    }

    /// Adds the names and units that stand above the first row.
    fn with_header(mut self, text: &str) -> Self {
        let lines: Vec<&str> =
            text.lines().take_while(|line| is_idle(line) || self.numbers(line) == 0).collect();
        self.before = lines.len();
        let first = text.lines().nth(self.before).unwrap_or_default();
        self.columns = self.cells(first).len();
        let fits = |cells: &Vec<&str>| {
            // a row may end with a separator, and its header without one
            let count = cells.len();
            (count == self.columns || count + 1 == self.columns) && count > 1
        };
        let owned = |cells: Vec<&str>| cells.into_iter().map(str::to_owned).collect::<Vec<String>>();
        let plain: Vec<Vec<&str>> =
            lines.iter().filter(|line| !is_idle(line)).map(|line| self.cells(line)).filter(fits).collect();
        let found = match plain.as_slice() {
            [.., names, units] => Some((names.clone(), units.clone())),
            [names] => Some((names.clone(), Vec::new())),
            [] => {
                let said = lines.iter().rev().filter_map(|line| comment(line)).map(|line| self.cells(line));
                said.filter(fits).map(|names| (names, Vec::new())).next()
            }
        };
        if let Some((names, units)) = found {
            (self.names, self.units) = (owned(names), owned(units));
        }
        self
    }

    /// Every row after the header, with the number of its line; and whether the header stood between it and the row before, as where a
    /// board woke up again.
    pub(super) fn each<'t>(
        &self,
        text: &'t str,
        mut row: impl FnMut(u64, bool, &[&'t str]) -> Result<(), String>,
    ) -> Result<(), String> {
        let mut fresh = false;
        for (number, line) in text.lines().enumerate().skip(self.before) {
            if is_idle(line) {
                continue;
            }
            let cells = self.cells(line);
            if !self.names.is_empty() && cells == self.names {
                fresh = true;
                continue;
            }
            row(number as u64 + 1, std::mem::take(&mut fresh), &cells)?;
        }
        Ok(())
    }

    /// A finite number.
    pub(super) fn number(&self, cell: &str) -> Option<f64> {
        let digits = cell.ends_with(|c: char| c.is_ascii_digit() || c == '.');
        let parsed = if self.comma && cell.contains(',') {
            (!cell.contains('.') && digits).then(|| cell.replace(',', ".").parse::<f64>().ok())?
        } else {
            digits.then(|| cell.parse().ok())?
        };
        parsed.filter(|number| number.is_finite())
    }

    fn cells<'t>(&self, line: &'t str) -> Vec<&'t str> {
        let separator = match self.separator {
            Separator::Spaces => return line.split_whitespace().collect(),
            Separator::Comma => ',',
            Separator::Semicolon => ';',
            Separator::Tab => '\t',
        };
        let mut quoted = false;
        let ends = |c: char| {
            quoted ^= c == '"';
            c == separator && !quoted
        };
        line.split(ends).map(|cell| cell.trim().trim_matches('"').trim()).collect()
    }
}

/// A line that is no row: empty, or a comment.
fn is_idle(line: &str) -> bool {
    line.trim().is_empty() || comment(line).is_some()
}

/// What a comment says.
fn comment(line: &str) -> Option<&str> {
    let line = line.trim_start();
    COMMENTS.iter().find_map(|mark| line.strip_prefix(mark))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names, and all rows as numbers.
    fn table(bytes: &[u8]) -> (Vec<String>, Vec<Vec<f64>>) {
        let text = text(bytes);
        let dialect = Dialect::of(&text).unwrap();
        let mut rows = Vec::new();
        dialect
            .each(&text, |_, _, cells| {
                rows.push(cells.iter().filter_map(|cell| dialect.number(cell)).collect());
                Ok(())
            })
            .unwrap();
        (dialect.names, rows)
    }

    #[test]
    fn one_table_is_read_however_it_is_written() {
        let wide: Vec<u8> = [0xff, 0xfe]
            .into_iter()
            .chain("t;v\r\n0;0,5\r\n1;-1,5\r\n".encode_utf16().flat_map(u16::to_le_bytes))
            .collect();
        for bytes in [
            &b"t,v\n0,0.5\n1,-1.5\n"[..],
            b"\xef\xbb\xbft, v\r\n0, 0.5\r\n1, -1.5\r\n",
            b"t;v\n0;0.5\n1;-1.5\n",
            b"t;v\n0;0,5\n1;-1,5\n",
            b"\"t\",\"v\"\n\"0\",\"0.5\"\n\"1\",\"-1.5\"\n",
            b"t\tv\n0\t0,5\n1\t-1,5\n",
            b"  t   v\n0    0.5\n\n1   -1.5\n",
            b"# made by hand\n% 3 Nov\nt,v\n0,0.5\n// stopped\n1,-1.5\n",
            b"# t v\n0 5.0e-1\n1 -1.5E0\n",
            b"t v\n0,0 0,5\n1,0 -1,5\n",
            &wide,
        ] {
            let (names, rows) = table(bytes);
            let shown = String::from_utf8_lossy(bytes);
            assert_eq!(names, ["t", "v"], "{shown}");
            assert_eq!(rows, [[0.0, 0.5], [1.0, -1.5]], "{shown}");
        }
    }

    #[test]
    fn a_table_may_have_no_header_and_a_row_of_units() {
        assert_eq!(table(b"0,0.5\n1,2\n").0, [""; 0]);
        let text = "x,y\nsecond,Volt\n0,1\n1,2\n";
        let dialect = Dialect::of(text).unwrap();
        assert_eq!(
            (dialect.names, dialect.units),
            (vec!["x".to_owned(), "y".into()], vec!["second".to_owned(), "Volt".into()])
        );
        assert_eq!(Dialect::of("nothing\nto read\n"), None);
        assert_eq!(Dialect::of("1\n2\n3\n"), None, "one column");
    }

    #[test]
    fn a_header_again_begins_anew() {
        let text = "t,v\n0,1\n1,1\nt,v\n0,2\n";
        let dialect = Dialect::of(text).unwrap();
        let mut fresh = Vec::new();
        dialect
            .each(text, |line, new, _| {
                fresh.push((line, new));
                Ok(())
            })
            .unwrap();
        assert_eq!(fresh, [(2, false), (3, false), (5, true)]);
    }

    #[test]
    fn old_characters_are_read() {
        let (names, rows) = table(b"t (\xb5s),v\n0,1\n5,2\n");
        assert_eq!(names[0], "t (µs)");
        assert_eq!(rows.len(), 2);
    }
}
