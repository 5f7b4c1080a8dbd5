//! What became of each picture, and of all of them.

use serde_json::{Value, json};
use tracelight_task::Failure;
use tracelight_task::counted;

use crate::figures::Figures;

/// What became of one picture.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    pub(crate) picture: String,
    pub(crate) outcome: Outcome,
}

/// How it ended.
#[derive(Clone, Debug)]
pub(crate) enum Outcome {
    /// Its strokes are found.
    Done {
        figures: Figures,
        /// From its bytes to its file.
        timing_ms: f64,
        /// By an earlier run.
        kept: bool,
    },
    /// Why there are none.
    Failed(Failure),
}

/// Counts over all rows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Totals {
    pictures: usize,
    traced: usize,
    kept: usize,
    failed: usize,
    strokes: usize,
    timing_ms: f64,
}

impl Totals {
    /// Of rows that took `timing_ms` in all.
    pub(crate) fn of(rows: &[Row], timing_ms: f64) -> Self {
        let mut totals = Self { pictures: rows.len(), timing_ms, ..Self::default() };
        for row in rows {
            match &row.outcome {
                Outcome::Done { figures, kept, .. } => {
                    totals.strokes += figures.strokes;
                    *if *kept { &mut totals.kept } else { &mut totals.traced } += 1;
                }
                Outcome::Failed(_) => totals.failed += 1,
            }
        }
        totals
    }

    /// The table's last lines.
    pub(crate) fn text(&self) -> String {
        let Self { pictures, traced, kept, failed, strokes, timing_ms } = self;
        let (pictures, strokes) = (counted(*pictures, "picture"), counted(*strokes, "stroke"));
        let time = time(*timing_ms);
        let rate = self.rate().map_or_else(String::new, |rate| format!(", {rate:.1} pictures a second"));
        format!("{pictures}: {traced} traced, {kept} kept, {failed} failed\n{strokes}; {time}{rate}")
    }

    /// Pictures a second: what was kept took no time, what failed did. None where that says nothing.
    fn rate(&self) -> Option<f64> {
        let seconds = self.timing_ms / 1e3;
        (self.traced > 0 && seconds > 0.0).then(|| (self.traced + self.failed) as f64 / seconds)
    }

    pub(crate) fn json(&self) -> Value {
        let Self { pictures, traced, kept, failed, strokes, timing_ms } = self;
        json!({
            "pictures": pictures, "traced": traced, "kept": kept, "failed": failed, "strokes": strokes,
            "timing_ms": timing_ms,
        })
    }
}

/// A time in three or four figures.
pub(crate) fn time(ms: f64) -> String {
    if ms < 999.5 { format!("{ms:.0} ms") } else { format!("{:.1} s", ms / 1e3) }
}
