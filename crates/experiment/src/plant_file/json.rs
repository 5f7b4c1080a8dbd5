//! JSON with the line of each value and numbers to the last bit.

use std::str::from_utf8;

use crate::plant_file::node::{MOST_DEPTH, Node, Table, Value, Wrong};

/// Values of a file.
const MOST_VALUES: usize = 4_000_000;
/// Names of a table: each is held against all others.
const MOST_NAMES: usize = 256;

/// Reads a whole file.
pub(super) fn read(bytes: &[u8]) -> Result<Node, Wrong> {
    let mut reader = Reader { bytes, at: 0, line: 1, values: 0 };
    let node = reader.value(0)?;
    reader.blank();
    if reader.at < bytes.len() {
        Err(reader.wrong("something follows the end of the JSON"))
    } else {
        Ok(node)
    }
}

struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
    values: usize,
}

impl Reader<'_> {
    fn wrong(&self, what: impl Into<String>) -> Wrong {
        Wrong::new(self.line, what)
    }

    fn peek(&self) -> u8 {
        self.bytes.get(self.at).copied().unwrap_or(0)
    }

    fn blank(&mut self) {
        while let b' ' | b'\t' | b'\r' | b'\n' = self.peek() {
            self.line += usize::from(self.peek() == b'\n');
            self.at += 1;
        }
    }

    /// Steps over that byte if it comes next.
    fn take(&mut self, byte: u8) -> bool {
        self.blank();
        let is_next = self.at < self.bytes.len() && self.peek() == byte;
        self.at += usize::from(is_next);
        is_next
    }

    fn value(&mut self, depth: usize) -> Result<Node, Wrong> {
        self.values += 1;
        if self.values > MOST_VALUES || depth > MOST_DEPTH {
            return Err(self.wrong(format!(
                "more than {MOST_VALUES} values, or nested more than {MOST_DEPTH} deep; no system file is"
            )));
        }
        self.blank();
        let line = Some(self.line);
        let value = match self.peek() {
            b'{' => Value::Table(self.table(depth)?),
            b'[' => self.list(depth)?,
            b'"' => Value::Text(self.text()?),
            _ => self.word()?,
        };
        Ok(Node { value, line })
    }

    fn table(&mut self, depth: usize) -> Result<Table, Wrong> {
        self.at += 1;
        let mut table = Table::new();
        if self.take(b'}') {
            return Ok(table);
        }
        loop {
            self.blank();
            if self.peek() != b'"' {
                return Err(self.wrong("a name in quotes is expected"));
            }
            let name = self.text()?;
            if table.len() >= MOST_NAMES {
                return Err(self.wrong(format!("a table has at most {MOST_NAMES} names")));
            }
            if table.iter().any(|(other, _)| *other == name) {
                return Err(self.wrong(format!("{name:?} is there twice")));
            }
            if !self.take(b':') {
                return Err(self.wrong(format!("a colon is expected after {name:?}")));
            }
            let node = self.value(depth + 1)?;
            table.push((name, node));
            if self.take(b'}') {
                return Ok(table);
            }
            if !self.take(b',') {
                return Err(self.wrong("a comma or a closing brace is expected"));
            }
        }
    }

    fn list(&mut self, depth: usize) -> Result<Value, Wrong> {
        self.at += 1;
        let (mut numbers, mut list) = (Vec::new(), Vec::new());
        if self.take(b']') {
            return Ok(Value::Numbers(numbers));
        }
        loop {
            let node = self.value(depth + 1)?;
            match node.value {
                Value::Number(number) if list.is_empty() => numbers.push(number),
                _ => {
                    list.extend(numbers.drain(..).map(|number| Node::bare(Value::Number(number))));
                    list.push(node);
                }
            }
            if self.take(b']') {
                return Ok(if list.is_empty() { Value::Numbers(numbers) } else { Value::List(list) });
            }
            if !self.take(b',') {
                return Err(self.wrong("a comma or a closing bracket is expected"));
            }
        }
    }

    /// A text in quotes; what is escaped is kept as it stands but for quotes and slashes.
    fn text(&mut self) -> Result<String, Wrong> {
        let start = self.at + 1;
        let mut end = start;
        while let Some(byte) = self.bytes.get(end) {
            match byte {
                b'"' => break,
                b'\\' => end += 2,
                b'\n' => return Err(self.wrong("a quote is not closed")),
                _ => end += 1,
            }
        }
        let Some(inside) = self.bytes.get(start..end).filter(|_| end < self.bytes.len()) else {
            return Err(self.wrong("a quote is not closed"));
        };
        let text = from_utf8(inside).map_err(|_| self.wrong("a text is not UTF-8"))?;
        self.at = end + 1;
        Ok(text.replace("\\\"", "\"").replace("\\/", "/").replace("\\\\", "\\"))
    }

    fn word(&mut self) -> Result<Value, Wrong> {
        let rest = &self.bytes[self.at..];
        let length = rest
            .iter()
            .position(|b| !(b.is_ascii_alphanumeric() || b"+-.".contains(b)))
            .unwrap_or(rest.len());
        let word = from_utf8(&rest[..length]).unwrap_or_default();
        let value = match word {
            "null" => Value::Nothing,
            "true" => Value::Truth(true),
            "false" => Value::Truth(false),
            _ => match word.parse::<f64>() {
                Ok(number) if number.is_finite() => Value::Number(number),
                _ => {
                    return Err(self.wrong(match word {
                        "" => "a value is missing".to_owned(),
                        _ => format!("{:?} is no number", word.chars().take(40).collect::<String>()),
                    }));
                }
            },
        };
        self.at += length;
        Ok(value)
    }
}
