//! MATLAB's .mat files of version 4: matrices with a short header each.

use tracelight_linear::{Complex, Matrix};

use crate::plant_file::node::{Node, Table, Value, Wrong};

const HEADER: usize = 20;
const MOST_VARIABLES: usize = 1024;

/// Reads the variables of a file by name.
pub(super) fn read(bytes: &[u8]) -> Result<Node, Wrong> {
    let mut rest = bytes;
    let mut variables = Table::new();
    while !rest.is_empty() {
        if variables.len() >= MOST_VARIABLES {
            return Err(wrong(format!("it holds more than {MOST_VARIABLES} variables")));
        }
        let (name, node, used) = variable(rest)?;
        variables.push((name, node));
        rest = &rest[used..];
    }
    Ok(Node::bare(Value::Table(variables)))
}

fn wrong(what: impl Into<String>) -> Wrong {
    Wrong::new(None, what)
}

/// A variable, and how many bytes it takes.
fn variable(bytes: &[u8]) -> Result<(String, Node, usize), Wrong> {
    let no_file = || wrong("it is no .mat file of version 4 to 7");
    let header = bytes.get(..HEADER).ok_or_else(no_file)?;
    let field = |k: usize, swapped: bool| {
        let own = [header[4 * k], header[4 * k + 1], header[4 * k + 2], header[4 * k + 3]];
        if swapped { u32::from_be_bytes(own) } else { u32::from_le_bytes(own) }
    };
    // thousands: 0 little-endian, 1 big-endian; of the other order the number is huge
    let swapped = field(0, false) > 4052;
    let kind = field(0, swapped);
    let (machine, of, class) = (kind / 1000, kind / 10 % 10, kind % 10);
    if kind > 4052 || machine != u32::from(swapped) || kind / 100 % 10 != 0 {
        return Err(no_file());
    }
    let size = match of {
        0 => 8,
        1 | 2 => 4,
        3 | 4 => 2,
        5 => 1,
        _ => return Err(no_file()),
    };
    let (rows, columns) = (field(1, swapped) as usize, field(2, swapped) as usize);
    let parts = if field(3, swapped) == 1 { 2 } else { 1 };
    let named = field(4, swapped) as usize;
    let count = rows.checked_mul(columns).filter(|count| *count <= bytes.len()).ok_or_else(no_file)?;
    let start = HEADER.checked_add(named).ok_or_else(no_file)?;
    let end = start.checked_add(parts * count * size).ok_or_else(no_file)?;
    let (name, data) = match (bytes.get(HEADER..start), bytes.get(start..end)) {
        (Some(name), Some(data)) => (text(name), data),
        _ => return Err(wrong(format!("it is cut off: a variable of {rows} × {columns} has too few bytes"))),
    };
    let numbers: Vec<f64> = data.chunks_exact(size).map(|bytes| number(bytes, of, swapped)).collect();
    let value = match (class, parts) {
        (0, 1) => Value::Grid(Matrix::from_vec(rows, columns, numbers)),
        (0, _) => {
            let (re, im) = numbers.split_at(count);
            Value::ComplexGrid(
                rows,
                columns,
                re.iter().zip(im).map(|(re, im)| Complex::new(*re, *im)).collect(),
            )
        }
        (1, _) => Value::Text(numbers.iter().map(|code| char::from(*code as u8)).collect()),
        _ => Value::Unreadable("a sparse matrix: save full(…) of it".into()),
    };
    Ok((name, Node::bare(value), end))
}

fn number(b: &[u8], of: u32, swapped: bool) -> f64 {
    let mut own = [0; 8];
    for (to, from) in own.iter_mut().zip(b) {
        *to = *from;
    }
    if swapped {
        own[..b.len()].reverse();
    }
    let four = [own[0], own[1], own[2], own[3]];
    match of {
        0 => f64::from_le_bytes(own),
        1 => f32::from_le_bytes(four).into(),
        2 => i32::from_le_bytes(four).into(),
        3 => i16::from_le_bytes([own[0], own[1]]).into(),
        4 => u16::from_le_bytes([own[0], own[1]]).into(),
        _ => own[0].into(),
    }
}

/// Up to the first zero byte.
pub(super) fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|b| *b == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end]).into_owned()
}
