//! Frequency responses as tables: of this program, of instruments, of other programs.

use tracelight_linear::FrequencyData;

use crate::plant_file::columns::{self, Picked};
use crate::plant_file::node::Wrong;
use crate::plant_file::plant::{Plant, PlantFile};
use crate::plant_file::rows::Separator;

/// Lines that may come before the names of the columns: instruments write theirs settings there.
const MOST_BEFORE: usize = 200;

/// Reads a table whose columns have names.
pub(super) fn read(text: &str, choice: Option<&str>) -> Result<Plant, Wrong> {
    let (at, separator, names) = header(text)?;
    let line = at + 1;
    let picked = columns::pick(&names, choice).map_err(|what| Wrong::new(line, what))?;
    let rows = rows(text, at, separator, &picked, &names)?;
    let number = |column: usize, row: usize| {
        let place = picked.all().iter().position(|own| *own == column)?;
        rows.get(row).map(|row| row[place])
    };
    let data = picked.data(number, rows.len()).map_err(|what| Wrong::new(None, what))?;
    Ok(Plant { understood: Some(picked.in_words(&names)), ..Plant::of(PlantFile::Frequencies(data)) })
}

/// Where the names of the columns are, what separates them, and they.
fn header(text: &str) -> Result<(usize, Separator, Vec<&str>), Wrong> {
    for (at, line) in text.lines().enumerate().take(MOST_BEFORE) {
        let separator = Separator::of([line].into_iter());
        let names = separator.fields(line.trim_start_matches(['#', '%']));
        // an instrument's first column may be a bare #: then its names stay in their places
        let names =
            if line.starts_with("#,") || line.starts_with("#;") { separator.fields(line) } else { names };
        if names.len() <= 1000 && columns::are_header(&names) {
            return Ok((at, separator, names));
        }
    }
    Err(Wrong::new(
        1,
        "it is neither a table of frequencies nor of matrices: above the columns write names such as \
         \"frequency (Hz),magnitude (dB),phase (deg)\" or \"frequency (rad/s),real,imaginary\"; above matrices A, B, C, D",
    ))
}

fn rows(
    text: &str,
    header: usize,
    separator: Separator,
    picked: &Picked,
    names: &[&str],
) -> Result<Vec<[f64; 4]>, Wrong> {
    let mut rows = Vec::new();
    for (at, line) in text.lines().enumerate().skip(header + 1) {
        let fields = separator.fields(line);
        if fields.iter().all(|field| field.is_empty()) || line.starts_with(['#', '%']) {
            continue;
        }
        if rows.len() >= FrequencyData::MOST {
            return Err(Wrong::new(at + 1, format!("more than {} frequencies", FrequencyData::MOST)));
        }
        let mut row = [0.0; 4];
        for (to, column) in row.iter_mut().zip(picked.all()) {
            let field = fields.get(column).copied().unwrap_or_default();
            *to = separator.number(field).ok_or_else(|| {
                let shown: String = field.chars().take(40).collect();
                Wrong::new(
                    at + 1,
                    format!("{shown:?} in column {} ({}) is no number", column + 1, names[column].trim()),
                )
            })?;
        }
        rows.push(row);
    }
    Ok(rows)
}
