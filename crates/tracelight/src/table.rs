//! Tables that were measured: CSV with names above its columns, so many rows at most, each told with its line.

use tracelight_files as files;
use tracelight_rig::Joint;
use tracelight_task::Failure;

use crate::record::Row;

/// Most rows: ten hours of a sample each 10 ms.
pub(crate) const MOST_ROWS: usize = 3_600_000;

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

/// Reads a file's columns and then each row; what is wrong is told with file and line under that code.
pub(crate) fn read<C>(
    path: &str,
    code: &'static str,
    columns: impl FnOnce(&Names) -> Result<C, String>,
    row: impl FnMut(&C, &Row<'_>) -> Result<(), String>,
) -> Result<(), Failure> {
    let bytes = files::read(path)?;
    parse(&bytes, columns, row).map_err(|what| Failure::usage(code, format!("{path}{what}")))
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
    let mut fields = csv::ByteRecord::new();
    let mut rows = 0;
    while reader.read_byte_record(&mut fields).map_err(|e| format!(": {e}"))? {
        let line = fields.position().map_or(0, csv::Position::line);
        rows += 1;
        if rows > MOST_ROWS {
            return Err(format!(":{line}: a table has at most {MOST_ROWS} rows; give a part of it"));
        }
        each(&columns, &Row { fields: &fields, line })?;
    }
    Ok(())
}

impl Row<'_> {
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
