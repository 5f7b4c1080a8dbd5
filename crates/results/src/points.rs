//! Points that were marked, and when each was ticked off.

use std::fs;
use std::path::Path;

use tracelight_files::ResultFolder;
use tracelight_job::PointDone;
use tracelight_report::PointFigures;
use tracelight_task::Failure;

/// Which points were ticked off, and when.
pub(crate) const POINTS: &str = "points.csv";

/// Columns of the table.
const HEADER: [&str; 8] = ["point", "kind", "block", "layer", "entity", "x_mm", "y_mm", "done_s"];

/// Writes the table of a run that marked points.
pub(crate) fn put_points(folder: &ResultFolder, points: &[PointDone]) -> Result<(), Failure> {
    if points.is_empty() {
        return Ok(());
    }
    let table = table(points).map_err(|e| Failure::failed("cannot-write", format!("{POINTS}: {e}")))?;
    folder.put(POINTS, table)
}

/// How many there are, and are done.
pub(crate) fn figures(points: &[PointDone]) -> Option<PointFigures> {
    let done = points.iter().filter(|point| point.done_s.is_some()).count();
    (!points.is_empty()).then_some(PointFigures { count: points.len(), done })
}

/// How many a run's folder says to be done, of how many; `None` of a run that marks none.
pub(crate) fn ticked_off(dir: &Path) -> Option<(usize, usize)> {
    const MOST_BYTES: u64 = 1 << 22;
    let path = dir.join(POINTS);
    let mut table = is_small(&path, MOST_BYTES).then(|| csv::Reader::from_path(&path).ok()).flatten()?;
    let done: Vec<bool> =
        table.records().map_while(Result::ok).map(|row| row.iter().next_back() != Some("")).collect();
    (!done.is_empty()).then(|| (done.iter().filter(|is_done| **is_done).count(), done.len()))
}

/// Whether something is a file of so many bytes at most.
pub(crate) fn is_small(path: &Path, most_bytes: u64) -> bool {
    fs::metadata(path).is_ok_and(|of| of.is_file() && of.len() <= most_bytes)
}

/// One row a point, in the order in which they were gone to; `done_s` is empty where one was not ticked off.
fn table(points: &[PointDone]) -> Result<Vec<u8>, csv::Error> {
    let mut rows = csv::Writer::from_writer(Vec::new());
    rows.write_record(HEADER)?;
    for PointDone { number, place, done_s } in points {
        let word = |text: Option<&str>| text.unwrap_or_default().to_owned();
        rows.write_record([
            (number + 1).to_string(),
            place.kind.name().to_owned(),
            word(place.block.as_deref()),
            word(place.layer.as_deref()),
            place.entity.as_ref().map_or_else(String::new, |entity| entity.to_string()),
            format!("{:.3}", 1e3 * place.at.x),
            format!("{:.3}", 1e3 * place.at.y),
            done_s.map_or_else(String::new, |s| format!("{s:.3}")),
        ])?;
    }
    rows.into_inner().map_err(|e| e.into_error().into())
}
