//! Matrices as tables: blocks of rows, each under its name.

use crate::plant_file::node::{Node, Table, Value, Wrong};
use crate::plant_file::rows::Separator;

/// What a block may be called.
const NAMES: [&str; 17] = [
    "a",
    "b",
    "c",
    "d",
    "e",
    "ts",
    "dt",
    "period_s",
    "num",
    "den",
    "numerator",
    "denominator",
    "inputs",
    "outputs",
    "zeros",
    "poles",
    "gain",
];
/// Numbers of a file: 200 states with 32 inputs and outputs are 54 000.
const MOST_NUMBERS: usize = 1_000_000;

struct Block {
    name: String,
    line: usize,
    rows: Vec<(usize, Vec<f64>)>,
    words: Vec<String>,
}

/// Reads the blocks; nothing of a file that does not begin with one.
pub(super) fn read(text: &str) -> Result<Option<Node>, Wrong> {
    let separator = Separator::of(text.lines());
    let mut blocks: Vec<Block> = Vec::new();
    let mut count = 0;
    for (line, at) in text.lines().zip(1..) {
        let fields = separator.fields(line);
        if fields.iter().all(|field| field.is_empty()) {
            continue;
        }
        if let Some((name, rest)) = head(line, separator)? {
            if blocks.iter().any(|block| block.name.eq_ignore_ascii_case(&name)) {
                return Err(Wrong::new(at, format!("{name} is there twice")));
            }
            let mut block = Block { name, line: at, rows: Vec::new(), words: Vec::new() };
            block.take(at, &rest, separator)?;
            blocks.push(block);
            continue;
        }
        if line.starts_with(['#', '%']) {
            continue;
        }
        let Some(block) = blocks.last_mut() else { return Ok(None) };
        count += fields.len();
        if count > MOST_NUMBERS {
            return Err(Wrong::new(at, format!("more than {MOST_NUMBERS} numbers")));
        }
        block.take(at, &fields, separator)?;
    }
    if blocks.is_empty() {
        return Ok(None);
    }
    let table: Table = blocks.into_iter().map(|block| (block.name.clone(), block.node())).collect();
    Ok(Some(Node { value: Value::Table(table), line: Some(1) }))
}

/// The name at the head of a block, and what follows it in its line.
fn head(line: &str, separator: Separator) -> Result<Option<(String, Vec<&str>)>, Wrong> {
    let is_remark = line.starts_with(['#', '%']);
    let bare = line.trim_start_matches(['#', '%', '[', '"', ' ', '\t']);
    let end = bare.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(bare.len());
    let (name, rest) = bare.split_at(end);
    if !NAMES.contains(&name.to_lowercase().as_str()) {
        return Ok(None);
    }
    let rest = rest.trim_matches([']', '"', ':', '=', ' ', '\t', ';', ',']);
    let fields = if rest.is_empty() { Vec::new() } else { separator.fields(rest) };
    let are_numbers = fields.iter().all(|field| separator.number(field).is_some());
    let are_words = ["inputs", "outputs"].contains(&name.to_lowercase().as_str());
    // a remark may begin with "A"
    if !are_numbers && !are_words && (is_remark || fields.len() > 1) {
        return Ok(None);
    }
    Ok(Some((name.to_owned(), fields)))
}

impl Block {
    fn take(&mut self, line: usize, fields: &[&str], separator: Separator) -> Result<(), Wrong> {
        // a spreadsheet fills the rows of a narrow block up
        let used = fields.iter().rposition(|field| !field.is_empty()).map_or(0, |last| last + 1);
        let fields = &fields[..used];
        if fields.is_empty() {
            return Ok(());
        }
        if ["inputs", "outputs"].contains(&self.name.to_lowercase().as_str()) {
            self.words.extend(fields.iter().map(|&word| word.to_owned()));
            return Ok(());
        }
        let number = |(field, column): (&&str, usize)| {
            separator.number(field).ok_or_else(|| {
                let shown: String = field.chars().take(40).collect();
                Wrong::new(line, format!("{shown:?}, column {column}, below {}, is no number", self.name))
            })
        };
        let row = fields.iter().zip(1..).map(number).collect::<Result<_, _>>()?;
        self.rows.push((line, row));
        Ok(())
    }

    fn node(self) -> Node {
        let line = Some(self.line);
        let text = |word: String| Node { value: Value::Text(word), line };
        let value = match self.rows.len() {
            0 if !self.words.is_empty() => Value::List(self.words.into_iter().map(text).collect()),
            _ => {
                let row = |(line, numbers)| Node { value: Value::Numbers(numbers), line: Some(line) };
                let rows: Vec<Node> = self.rows.into_iter().map(row).collect();
                match rows.len() {
                    0 => Value::Numbers(Vec::new()),
                    _ => Value::List(rows),
                }
            }
        };
        Node { value, line }
    }
}
