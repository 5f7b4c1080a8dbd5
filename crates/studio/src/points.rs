//! A plan's table as a page draws it: columns of 32-bit floats behind a header.

use axum::body::Bytes;
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

/// A plan's points, to be looked up.
#[derive(Clone, Debug)]
pub(crate) struct Drawn {
    bytes: Bytes,
    rows: usize,
    ticks_a_row: f64,
}

impl Drawn {
    /// Of what [`binary`] has made; `None` of anything else.
    pub(crate) fn of(bytes: Bytes) -> Option<Self> {
        let word = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
        let (rows, ticks_a_row) = (word(8)? as usize, f64::from(word(12)?));
        let is_whole = bytes.len() == 16 + 4 * usize::from(COLUMNS) * rows && bytes[0] == KIND;
        is_whole.then_some(Self { bytes, rows, ticks_a_row })
    }

    fn value(&self, column: usize, row: usize) -> Option<f32> {
        let at = 16 + 4 * (column * self.rows + row);
        Some(f32::from_le_bytes(self.bytes.get(at..at + 4)?.try_into().ok()?))
    }

    /// Where the spot is to be at a time of the plan, s, on the target, m; `None` after its end.
    pub(crate) fn at(&self, plan_s: f64) -> Option<[f32; 2]> {
        let row = (1e3 * plan_s / self.ticks_a_row).round();
        let row = (row >= 0.0 && row < self.rows as f64).then_some(row as usize)?;
        Some([self.value(0, row)?, self.value(1, row)?])
    }

    /// Its lit strokes, m on the target, thinned so that they have so many points in all, and their ends at least.
    pub(crate) fn strokes(&self, most: usize) -> Vec<Vec<[f32; 2]>> {
        let every = self.rows.div_ceil(most.max(1)).max(1);
        let mut strokes: Vec<Vec<[f32; 2]>> = Vec::new();
        let (mut number, mut last) = (0.0, None);
        for row in 0..self.rows {
            let (Some(x), Some(y), Some(lit), Some(stroke)) =
                (self.value(0, row), self.value(1, row), self.value(2, row), self.value(3, row))
            else {
                break;
            };
            let is_new = lit > 0.0 && stroke != number;
            if is_new || lit <= 0.0 {
                // where the one before ended
                if let (Some(end), Some(stroke)) = (last.take(), strokes.last_mut()) {
                    stroke.push(end);
                }
            }
            if is_new {
                strokes.push(Vec::new());
            }
            number = if lit > 0.0 { stroke } else { 0.0 };
            if let Some(stroke) = strokes.last_mut().filter(|_| lit > 0.0) {
                if is_new || row % every == 0 {
                    stroke.push([x, y]);
                    last = None;
                } else {
                    last = Some([x, y]);
                }
            }
        }
        if let (Some(end), Some(stroke)) = (last, strokes.last_mut()) {
            stroke.push(end);
        }
        strokes
    }
}

/// From which tick to which each stroke is lit.
fn lit_ticks(answer: &Value) -> Vec<(usize, usize)> {
    let tick =
        |stroke: &Value, key: &str| (1e3 * stroke[key].as_f64().unwrap_or(0.0)).round().max(0.0) as usize;
    let sequence = answer["sequence"].as_array().map(Vec::as_slice).unwrap_or_default();
    sequence.iter().map(|stroke| (tick(stroke, "lit_from_s"), tick(stroke, "lit_to_s"))).collect()
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use serde_json::json;

    /// Two strokes of two points each.
    pub(crate) fn two_strokes() -> Bytes {
        let table =
            "t_s,lit,x_m,y_m\n0.000,0,0,0\n0.001,1,1,0\n0.002,1,2,0\n0.003,0,3,0\n0.004,1,4,0\n0.005,1,5,0\n";
        let answer = json!({ "sequence": [{ "lit_from_s": 0.001, "lit_to_s": 0.002 }, { "lit_from_s": 0.004, "lit_to_s": 0.005 }] });
        Bytes::from(binary(table, &answer).unwrap())
    }

    #[test]
    fn points_are_looked_up_by_time_and_by_stroke() {
        let drawn = Drawn::of(two_strokes()).unwrap();
        assert_eq!(drawn.at(0.004), Some([4.0, 0.0]));
        assert_eq!((drawn.at(0.006), drawn.at(-1.0), drawn.at(f64::NAN)), (None, None, None));
        assert_eq!(drawn.strokes(100), [[[1.0, 0.0], [2.0, 0.0]], [[4.0, 0.0], [5.0, 0.0]]]);
        // however few points there may be, every stroke keeps its ends
        assert_eq!(drawn.strokes(1), drawn.strokes(100));
        assert!(Drawn::of(Bytes::from_static(b"no points at all")).is_none());
    }

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
