//! What a file holds before it is a system: values with their names and lines, whatever the format.

use tracelight_linear::{Complex, Matrix};

/// Tables within tables, and lists within lists.
pub(super) const MOST_DEPTH: usize = 24;

/// A value and the line it begins in, where lines are counted.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Node {
    pub(super) value: Value,
    pub(super) line: Option<usize>,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    /// null, None.
    Nothing,
    Truth(bool),
    Number(f64),
    Text(String),
    /// A list of numbers alone.
    Numbers(Vec<f64>),
    List(Vec<Node>),
    Table(Table),
    Grid(Matrix),
    /// Of rows and columns, column by column.
    ComplexGrid(usize, usize, Vec<Complex>),
    /// What this program does not read, in words.
    Unreadable(String),
}

/// Values by name, in their order.
pub(super) type Table = Vec<(String, Node)>;

/// What is wrong, and in which line.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Wrong {
    pub(super) line: Option<usize>,
    pub(super) what: String,
}

impl Wrong {
    pub(super) fn new(line: impl Into<Option<usize>>, what: impl Into<String>) -> Self {
        Self { line: line.into(), what: what.into() }
    }
}

impl Node {
    pub(super) const fn bare(value: Value) -> Self {
        Self { value, line: None }
    }

    pub(super) fn wrong(&self, what: impl Into<String>) -> Wrong {
        Wrong::new(self.line, what)
    }

    pub(super) const fn table(&self) -> Option<&Table> {
        match &self.value {
            Value::Table(table) => Some(table),
            _ => None,
        }
    }

    /// The numbers of a list, or of a matrix with one row or column.
    pub(super) fn numbers(&self) -> Option<Vec<f64>> {
        match &self.value {
            Value::Number(number) => Some(vec![*number]),
            Value::Numbers(numbers) => Some(numbers.clone()),
            Value::Grid(grid) if grid.nrows().min(grid.ncols()) <= 1 => Some(grid.as_slice().to_vec()),
            // [[…]], as some write a transfer function of one input and one output
            Value::List(list) if list.len() == 1 => list[0].numbers(),
            _ => None,
        }
    }

    /// What it is, for messages.
    pub(super) fn in_words(&self) -> String {
        match &self.value {
            Value::Nothing => "nothing".into(),
            Value::Truth(truth) => truth.to_string(),
            Value::Number(number) => number.to_string(),
            Value::Text(text) => format!("{:?}", text.chars().take(40).collect::<String>()),
            Value::Numbers(numbers) => format!("a list of {} numbers", numbers.len()),
            Value::List(list) => format!("a list of {}", list.len()),
            Value::Table(_) => "a table".into(),
            Value::Grid(grid) => format!("{} × {} numbers", grid.nrows(), grid.ncols()),
            Value::ComplexGrid(rows, columns, _) => format!("{rows} × {columns} complex numbers"),
            Value::Unreadable(what) => what.clone(),
        }
    }
}

/// The value with one of these names: the very name first, then whatever the case of its letters.
pub(super) fn find<'a>(table: &'a Table, names: &[&str]) -> Option<(&'a str, &'a Node)> {
    let by = |is: &dyn Fn(&str, &str) -> bool| {
        names.iter().find_map(|name| table.iter().find(|(key, _)| is(key, name)))
    };
    let found = by(&|key, name| key == name).or_else(|| by(&|key, name| key.eq_ignore_ascii_case(name)));
    found.map(|(key, node)| (key.as_str(), node))
}
