//! `seen.csv` and `seen.jpg`: what a camera saw of the spot while it drew.

use std::fmt::Write;
use std::path::Path;

use tracelight_eye::seen::SeenMark;

use super::{Job, OutputError, forget, write_jpeg};

/// Writes both; those that an earlier job left are removed where nobody looked.
pub(super) fn write(dir: &Path, job: &Job<'_>) -> Result<(), OutputError> {
    let (table, painting) = (dir.join("seen.csv"), dir.join("seen.jpg"));
    match job.seen.and_then(|seen| seen.painting.as_ref()) {
        Some(raster) => write_jpeg(&painting, raster)?,
        None => forget(&painting).map_err(OutputError::at(&painting))?,
    }
    let Some(seen) = job.seen else { return forget(&table).map_err(OutputError::at(&table)) };
    std::fs::write(&table, rows(&seen.marks)).map_err(OutputError::at(&table))
}

fn rows(marks: &[SeenMark]) -> String {
    let mut text = String::from("t_s,seen_x_m,seen_y_m,asked_x_m,asked_y_m,off_mm\n");
    for mark in marks {
        let SeenMark { time_s, seen, asked } = mark;
        // writing to a String cannot fail
        let _ = writeln!(
            text,
            "{time_s:.4},{:.6},{:.6},{:.6},{:.6},{:.3}",
            seen.x,
            seen.y,
            asked.x,
            asked.y,
            mark.off_mm()
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_stroke::Point;

    #[test]
    fn a_row_tells_where_it_was_seen_and_how_far_off() {
        let mark = SeenMark { time_s: 1.5, seen: Point::new(0.1, -0.2), asked: Point::new(0.1, -0.2003) };
        let text = rows(&[mark]);
        assert_eq!(text.lines().nth(1), Some("1.5000,0.100000,-0.200000,0.100000,-0.200300,0.300"));
    }
}
