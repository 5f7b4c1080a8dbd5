//! Tables that were measured: CSV with names above its columns, so many rows at most, each told with its line.

use tracelight_rig::Joint;
use tracelight_task::Failure;

/// Most rows: ten hours of a sample each 10 ms.
pub(crate) const MOST_ROWS: usize = 3_600_000;

/// What was measured, as its file has it.
#[derive(Clone, Debug)]
pub struct Log {
    /// What it is called in messages.
    pub name: String,
    /// CSV.
    pub bytes: Vec<u8>,
}

/// What logs are called, as one.
pub(crate) fn names(logs: &[Log]) -> String {
    logs.iter().map(|log| log.name.as_str()).collect::<Vec<_>>().join(", ")
}

/// What many logs are called, as one.
pub(crate) fn few(names: &[String]) -> String {
    const FEW: usize = 3;
    match names {
        [first, rest @ ..] if names.len() > FEW => format!("{first} and {} more", rest.len()),
        all => all.join(", "),
    }
}

/// The names above the columns.
pub(crate) struct Names(csv::ByteRecord);

impl Names {
    /// Where a column is.
    pub(crate) fn find(&self, name: &str) -> Option<usize> {
        self.0.iter().position(|field| field.trim_ascii() == name.as_bytes())
    }

    /// Where columns are that must all be there.
    pub(crate) fn all<const N: usize>(&self, names: [&str; N]) -> Result<[usize; N], String> {
        let mut places = [0; N];
        for (place, name) in places.iter_mut().zip(names) {
            *place = self
                .find(name)
                .ok_or_else(|| format!(": no column {name}; its columns must be {}", names.join(",")))?;
        }
        Ok(places)
    }
}

/// Whether a log has columns as this program names them, so that nothing needs to be told of them: those that `fits` asks for, or none but
/// `own` ones, of which some are missing.
pub(crate) fn is_own(log: &Log, own: &[&str], fits: impl FnOnce(&Names) -> bool) -> bool {
    begins(log, |names| {
        let all_own = || names.0.iter().all(|name| own.iter().any(|own| own.as_bytes() == name.trim_ascii()));
        names.find("axis").is_some() && (fits(names) || all_own())
    })
}

/// Whether a log begins with such names.
pub(crate) fn begins(log: &Log, fits: impl FnOnce(&Names) -> bool) -> bool {
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(log.bytes.as_slice());
    reader.byte_headers().is_ok_and(|header| fits(&Names(header.clone())))
}

/// Reads a log's columns and then each row; what is wrong is told with its name and the line under that code.
pub(crate) fn read<C>(
    log: &Log,
    code: &'static str,
    columns: impl FnOnce(&Names) -> Result<C, String>,
    row: impl FnMut(&C, &Row<'_>) -> Result<(), String>,
) -> Result<(), Failure> {
    parse(&log.bytes, columns, row).map_err(|what| Failure::usage(code, format!("{}{what}", log.name)))
}

/// The same of bytes.
pub(crate) fn parse<C>(
    bytes: &[u8],
    columns: impl FnOnce(&Names) -> Result<C, String>,
    mut each: impl FnMut(&C, &Row<'_>) -> Result<(), String>,
) -> Result<(), String> {
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(bytes);
    let names = Names(reader.byte_headers().map_err(|e| format!(": {e}"))?.clone());
    let columns = columns(&names)?;
    each_row(reader, |row| each(&columns, row))
}

/// The same of a table that may have no names: they, or values, are its first row.
pub(crate) fn parse_plain(
    bytes: &[u8],
    each: impl FnMut(&Row<'_>) -> Result<(), String>,
) -> Result<(), String> {
    each_row(csv::ReaderBuilder::new().flexible(true).has_headers(false).from_reader(bytes), each)
}

fn each_row(
    mut reader: csv::Reader<&[u8]>,
    mut each: impl FnMut(&Row<'_>) -> Result<(), String>,
) -> Result<(), String> {
    let mut fields = csv::ByteRecord::new();
    let mut rows = 0;
    while reader.read_byte_record(&mut fields).map_err(|e| format!(": {e}"))? {
        let line = fields.position().map_or(0, csv::Position::line);
        rows += 1;
        if rows > MOST_ROWS {
            return Err(format!(":{line}: a table has at most {MOST_ROWS} rows; give a part of it"));
        }
        each(&Row { fields: &fields, line })?;
    }
    Ok(())
}

/// One row, with what can be wrong with it.
pub(crate) struct Row<'a> {
    pub(crate) fields: &'a csv::ByteRecord,
    pub(crate) line: u64,
}

impl Row<'_> {
    pub(crate) fn text(&self, column: usize) -> &str {
        std::str::from_utf8(self.fields.get(column).unwrap_or_default()).unwrap_or("not text").trim()
    }

    pub(crate) fn number(&self, column: usize) -> Result<f64, String> {
        let text = self.text(column);
        let number: Option<f64> = text.parse().ok().filter(|value: &f64| value.is_finite());
        number.ok_or_else(|| format!(":{}: {text:?} in column {} is no number", self.line, column + 1))
    }

    pub(crate) fn whole(&self, column: usize) -> Result<i32, String> {
        let text = self.text(column);
        text.parse().map_err(|_| format!(":{}: {text:?} in column {} is no count", self.line, column + 1))
    }

    pub(crate) fn optional(&self, column: Option<usize>) -> Result<Option<f64>, String> {
        column.filter(|&c| !self.text(c).is_empty()).map(|c| self.number(c)).transpose()
    }

    /// pan or tilt.
    pub(crate) fn joint(&self, column: usize) -> Result<Joint, String> {
        match self.text(column) {
            "pan" => Ok(Joint::Pan),
            "tilt" => Ok(Joint::Tilt),
            other => Err(format!(":{}: axis {other:?} is neither pan nor tilt", self.line)),
        }
    }

    /// A number that is at most so large, either way.
    pub(crate) fn up_to(&self, column: usize, most: f64, what: &str) -> Result<f64, String> {
        let number = self.number(column)?;
        if number.abs() <= most {
            Ok(number)
        } else {
            Err(format!(":{}: {number} in column {} is more than {what}", self.line, column + 1))
        }
    }
}
