//! A plan's table as a page draws it: columns of 32-bit floats behind a header.

use serde_json::Value;

/// What a message holds: a plan, columns x, y, lit, stroke, speed.
const KIND: u8 = 5;
const VERSION: u8 = 1;
const COLUMNS: u16 = 5;
/// Rows that a page gets at most; of longer plans each nth tick.
const MOST_ROWS: usize = 200_000;

/// From a table of `plan -o FILE.csv` and the sequence of its `--json`: little-endian `kind u8, version u8, columns u16, first_tick u32, rows u32, ticks_a_row u32`, then
/// the columns one after the other: x and y on the target, m; whether it is lit, 0 or 1; the stroke's number, 0 between them; the spot's speed, m/s. `None` of a table
/// that is no plan.
pub(crate) fn binary(table: &str, answer: &Value) -> Option<Vec<u8>> {
    let mut lines = table.lines();
    let head: Vec<&str> = lines.next()?.split(',').collect();
    let at = |name: &str| head.iter().position(|column| *column == name);
    let (lit, x, y) = (at("lit")?, at("x_m")?, at("y_m")?);
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |at: usize| cells.get(at)?.parse::<f64>().ok();
        Some([number(x)?, number(y)?, number(lit)?])
    };
    let every = lines.clone().count().div_ceil(MOST_ROWS).max(1);
    let strokes = lit_ticks(answer);
    let mut columns = [const { Vec::new() }; COLUMNS as usize];
    let (mut stroke, mut rows) = (0, 0);
    let mut lines = lines.enumerate().peekable();
    while let Some((tick, line)) = lines.next() {
        if tick % every != 0 {
            continue;
        }
        let [x, y, lit] = row(line)?;
        let [next_x, next_y, _] = lines.peek().map_or(Some([x, y, lit]), |(_, next)| row(next))?;
        while strokes.get(stroke).is_some_and(|&(_, end)| end < tick) {
            stroke += 1;
        }
        let number = strokes.get(stroke).filter(|&&(begin, _)| begin <= tick).map_or(0, |_| stroke + 1);
        let (dx, dy) = (next_x - x, next_y - y);
        let speed_m_s = 1e3 * (dx * dx + dy * dy).sqrt();
        for (column, value) in columns.iter_mut().zip([x, y, lit, number as f64, speed_m_s]) {
            column.push(value as f32);
        }
        rows += 1;
    }
    let mut bytes = vec![KIND, VERSION];
    bytes.extend(COLUMNS.to_le_bytes());
    for number in [0, rows, every as u32] {
        bytes.extend(number.to_le_bytes());
    }
    columns.iter().flatten().for_each(|value| bytes.extend(value.to_le_bytes()));
    Some(bytes)
}

/// From which tick to which each stroke is lit.
fn lit_ticks(answer: &Value) -> Vec<(usize, usize)> {
    let tick =
        |stroke: &Value, key: &str| (1e3 * stroke[key].as_f64().unwrap_or(0.0)).round().max(0.0) as usize;
    let sequence = answer["sequence"].as_array().map(Vec::as_slice).unwrap_or_default();
    sequence.iter().map(|stroke| (tick(stroke, "lit_from_s"), tick(stroke, "lit_to_s"))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_table_becomes_columns_with_the_number_of_each_stroke() {
        let table = "t_s,lit,x_m,y_m\n0.000,0,0.0,0.5\n0.001,1,0.003,0.5\n0.002,1,0.003,0.504\n0.003,0,0,0\n";
        let answer = json!({ "sequence": [{ "lit_from_s": 0.001, "lit_to_s": 0.002 }] });
        let bytes = binary(table, &answer).unwrap();
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
        assert_eq!((bytes[0], bytes[1], bytes[2], word(8), word(12)), (5, 1, 5, 4, 1));
        let column = |number: usize| -> Vec<f32> {
            (0..4).map(|row| f32::from_bits(word(16 + 4 * (4 * number + row)))).collect()
        };
        assert_eq!(column(0), [0.0, 0.003, 0.003, 0.0]);
        assert_eq!(column(2), [0.0, 1.0, 1.0, 0.0]);
        assert_eq!(column(3), [0.0, 1.0, 1.0, 0.0]);
        assert!((column(4)[1] - 4.0).abs() < 1e-4);
        assert!(binary("a,b\n1,2\n", &answer).is_none() && binary("", &answer).is_none());
    }
}
