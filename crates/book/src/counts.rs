//! Moves as encoder positions, which the report means to feed to its motors.

use std::path::Path;

use crate::chapter::{Done, Joined, Run};
use crate::table::{Cell, Table};

const PROFILES: [&str; 2] = ["trapezoid", "s-curve"];
/// Rows of the table.
const PARTS: usize = 10;

/// Moves by name and what describes them, each by both profiles.
pub(crate) fn joined(book: &Path, moves: &[(&'static str, &[&str])]) -> Joined {
    let mut runs = Vec::new();
    let mut names = Vec::new();
    for (name, course) in moves {
        for profile in PROFILES {
            let file = book.join("moves").join(format!("{name}-{profile}.csv"));
            let path = file.display().to_string();
            let words =
                [&["lab", "move"][..], course, &["--profile", profile, "--set", "B", "-o", &path]].concat();
            let arguments = words.into_iter().map(str::to_owned).collect();
            runs.push(Run { arguments, figure: Some(file), ..Run::default() });
            names.push(format!("{name}, {profile}"));
        }
    }
    Joined {
        caption: "Encoder positions of the arc and the line: time in ms, pan / tilt in counts",
        runs,
        show: Box::new(move |done| table(&names, done)),
    }
}

fn table(names: &[String], done: &[Done]) -> Table {
    let columns: Vec<Vec<Cell>> = done.iter().map(|(_, csv)| tenths(csv.as_deref().unwrap_or(""))).collect();
    let row = |tenth: usize| {
        let mut cells = vec![Cell::words(format!("{} %", tenth * 100 / PARTS))];
        cells.extend(
            columns.iter().map(|column| column.get(tenth).cloned().unwrap_or_else(|| Cell::words("–"))),
        );
        cells
    };
    Table {
        heads: std::iter::once("of the time".to_owned()).chain(names.iter().cloned()).collect(),
        rows: (0..=PARTS).map(row).collect(),
        finding: String::new(),
    }
}

/// When, and where both encoders are, at each tenth of a move's rows.
fn tenths(csv: &str) -> Vec<Cell> {
    let mut lines = csv.lines();
    let heads: Vec<&str> = lines.next().unwrap_or("").split(',').collect();
    let place = |name: &str| heads.iter().position(|head| *head == name);
    let (Some(time), Some(pan), Some(tilt)) = (place("t_s"), place("pan_count"), place("tilt_count")) else {
        return Vec::new();
    };
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let cell = |tenth: usize| {
        let row = rows.get((rows.len().saturating_sub(1)) * tenth / PARTS)?;
        let time_s: f64 = row.get(time)?.parse().ok()?;
        let text = format!("{:.0}: {} / {}", 1e3 * time_s, row.get(pan)?, row.get(tilt)?);
        Some(Cell::words(text.replace('-', "−")))
    };
    (0..=PARTS).filter_map(cell).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tenths_are_told_by_the_names_of_columns() {
        let rows: String = (0..=20).map(|k| format!("{},{k},x,{}\n", 1e-3 * f64::from(k), -2 * k)).collect();
        let cells = tenths(&format!("t_s,pan_count,other,tilt_count\n{rows}"));
        assert_eq!(cells.len(), PARTS + 1);
        assert_eq!(cells[1].text, "2: 2 / −4");
        assert_eq!(cells[PARTS].text, "20: 20 / −40");
        assert!(tenths("a,b\n1,2\n").is_empty());
    }
}
