//! TOML with the line of each value.

use std::ops::Range;

use toml_edit::{Document, Item, TableLike, Value as Entry};

use crate::plant_file::node::{MOST_DEPTH, Node, Table, Value, Wrong};

/// Largest file, bytes: 200 states, written to the last bit.
const MOST_BYTES: usize = 2 << 20;

/// Reads a whole file.
pub(super) fn read(text: &str) -> Result<Node, Wrong> {
    if text.len() > MOST_BYTES {
        return Err(Wrong::new(
            None,
            format!("{} bytes; a TOML system has at most {MOST_BYTES}", text.len()),
        ));
    }
    let lines = Lines::of(text);
    let document =
        Document::parse(text).map_err(|e| Wrong::new(lines.line(e.span()), e.message().to_owned()))?;
    Ok(Node { value: Value::Table(lines.table(document.as_table(), 0)?), line: Some(1) })
}

/// Where lines begin.
struct Lines(Vec<usize>);

impl Lines {
    fn of(text: &str) -> Self {
        Self(text.match_indices('\n').map(|(at, _)| at).collect())
    }

    fn line(&self, span: Option<Range<usize>>) -> Option<usize> {
        span.map(|span| self.0.partition_point(|newline| *newline < span.start) + 1)
    }

    fn table(&self, table: &dyn TableLike, depth: usize) -> Result<Table, Wrong> {
        if depth > MOST_DEPTH {
            return Err(Wrong::new(None, format!("tables are nested more than {MOST_DEPTH} deep")));
        }
        table.iter().map(|(name, item)| Ok((name.to_owned(), self.item(item, depth + 1)?))).collect()
    }

    fn item(&self, item: &Item, depth: usize) -> Result<Node, Wrong> {
        let line = self.line(item.span());
        let value = match item {
            Item::Value(value) => return self.value(value, depth),
            Item::Table(table) => Value::Table(self.table(table, depth)?),
            Item::ArrayOfTables(tables) => Value::List(
                tables
                    .iter()
                    .map(|table| {
                        Ok(Node {
                            value: Value::Table(self.table(table, depth)?),
                            line: self.line(table.span()),
                        })
                    })
                    .collect::<Result<_, Wrong>>()?,
            ),
            Item::None => Value::Nothing,
        };
        Ok(Node { value, line })
    }

    fn value(&self, entry: &Entry, depth: usize) -> Result<Node, Wrong> {
        let line = self.line(entry.span());
        let value = match entry {
            Entry::Integer(whole) => Value::Number(*whole.value() as f64),
            Entry::Float(float) if float.value().is_finite() => Value::Number(*float.value()),
            Entry::Float(float) => {
                return Err(Wrong::new(line, format!("{} is no number that can be used", float.value())));
            }
            Entry::Boolean(truth) => Value::Truth(*truth.value()),
            Entry::String(text) => Value::Text(text.value().clone()),
            Entry::Datetime(_) => Value::Unreadable("a date".into()),
            Entry::InlineTable(table) => Value::Table(self.table(table, depth)?),
            Entry::Array(array) => {
                if depth > MOST_DEPTH {
                    return Err(Wrong::new(line, format!("lists are nested more than {MOST_DEPTH} deep")));
                }
                let nodes: Vec<Node> =
                    array.iter().map(|entry| self.value(entry, depth + 1)).collect::<Result<_, _>>()?;
                let numbers: Option<Vec<f64>> = nodes
                    .iter()
                    .map(|node| if let Value::Number(number) = node.value { Some(number) } else { None })
                    .collect();
                numbers.map_or(Value::List(nodes), Value::Numbers)
            }
        };
        Ok(Node { value, line })
    }
}
