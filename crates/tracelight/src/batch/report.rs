//! What a batch tells: rows of the table, one JSON object that appears as it grows, how it ended.

use std::io::Write;

use serde_json::{Value, json};
use tracelight_task::{Failure, Status, Task, counted};

use crate::batch::figures::Figures;
use crate::batch::{Batch, table};
use crate::cli::Answer;

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
    /// Its failure's code and message.
    Failed { code: &'static str, message: String },
}

/// What only `--json` tells of a picture.
#[derive(Debug, Default)]
pub(super) struct Told {
    /// Where its strokes are.
    pub(super) file: Option<String>,
    /// Themselves, as JSON.
    pub(super) strokes: Option<String>,
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
    pub(super) fn of(rows: &[Row], timing_ms: f64) -> Self {
        let mut totals = Self { pictures: rows.len(), timing_ms, ..Self::default() };
        for row in rows {
            match &row.outcome {
                Outcome::Done { figures, kept, .. } => {
                    totals.strokes += figures.strokes;
                    *if *kept { &mut totals.kept } else { &mut totals.traced } += 1;
                }
                Outcome::Failed { .. } => totals.failed += 1,
            }
        }
        totals
    }

    /// The table's last lines.
    pub(super) fn text(&self) -> String {
        let Self { pictures, traced, kept, failed, strokes, timing_ms } = self;
        let (pictures, strokes) = (counted(*pictures, "picture"), counted(*strokes, "stroke"));
        let time = table::time(*timing_ms);
        let rate = self.rate().map_or_else(String::new, |rate| format!(", {rate:.1} pictures a second"));
        format!("{pictures}: {traced} traced, {kept} kept, {failed} failed\n{strokes}; {time}{rate}")
    }

    /// Pictures a second: what was kept took no time, what failed did. None where that says nothing.
    fn rate(&self) -> Option<f64> {
        let seconds = self.timing_ms / 1e3;
        (self.traced > 0 && seconds > 0.0).then(|| (self.traced + self.failed) as f64 / seconds)
    }

    fn json(&self) -> Value {
        let Self { pictures, traced, kept, failed, strokes, timing_ms } = self;
        json!({
            "pictures": pictures, "traced": traced, "kept": kept, "failed": failed, "strokes": strokes,
            "timing_ms": timing_ms,
        })
    }
}

/// All pictures of a batch, filled in as they end.
pub(super) struct Report {
    rows: Vec<Option<Row>>,
    stream: Option<Stream>,
}

impl Report {
    pub(super) fn new(pictures: usize, json: bool) -> Self {
        Self { rows: vec![None; pictures], stream: json.then(|| Stream::new(pictures)) }
    }

    /// Takes in what became of a picture.
    pub(super) fn add(&mut self, index: usize, row: Row, told: Told) {
        if let Some(stream) = &mut self.stream {
            stream.add(index, object(&row, told));
        }
        self.rows[index] = Some(row);
    }

    /// The table, or the end of the JSON object whose beginning is printed already; and how the command ends.
    pub(super) fn answer(mut self, batch: &Batch<'_>, task: Task<'_>, timing_ms: f64) -> Answer {
        let rows: Vec<_> = self.rows.iter().flatten().cloned().collect();
        rows.iter().filter_map(remark).for_each(|remark| task.say(&remark));
        let totals = Totals::of(&rows, timing_ms);
        let left: Vec<_> = (0..self.rows.len()).filter(|&i| self.rows[i].is_none()).collect();
        let json = self.stream.take().map(|mut stream| {
            left.iter().for_each(|&i| stream.add(i, not_begun(&batch.pictures[i].name)));
            stream.end(&totals)
        });
        let mut answer = Answer::new(table::text(&rows, &totals), json.unwrap_or_default());
        answer.failure = if left.is_empty() {
            failure(&rows, batch.out.is_some())
        } else {
            Some(interrupted(rows.len(), left.len(), batch.out.is_some()))
        };
        answer
    }
}

/// What stderr says of a picture whose strokes may not be what its owner wants.
fn remark(row: &Row) -> Option<String> {
    match &row.outcome {
        Outcome::Done { figures: Figures { doubt, quality, .. }, kept: false, .. } => {
            let weak = quality.iter().flat_map(|q| &q.remarks);
            let all: Vec<&str> = doubt.iter().chain(weak).map(String::as_str).collect();
            (!all.is_empty()).then(|| format!("note: {}: {}", row.picture, all.join("; ")))
        }
        _ => None,
    }
}

fn object(row: &Row, told: Told) -> String {
    let picture = &row.picture;
    match &row.outcome {
        Outcome::Failed { code, message } => {
            json!({"picture": picture, "error": {"code": code, "message": message}}).to_string()
        }
        Outcome::Done { figures, timing_ms, kept } => {
            let mut object = json!({
                "picture": picture, "kept": kept, "figures": figures, "timing_ms": timing_ms,
            });
            if let Some(file) = told.file {
                object["file"] = file.into();
            }
            let object = object.to_string();
            match (told.strokes, object.strip_suffix('}')) {
                // a document of its own: it goes in as it is, without being read again
                (Some(strokes), Some(object)) => format!("{object},\"strokes\":{strokes}}}"),
                _ => object,
            }
        }
    }
}

fn not_begun(picture: &str) -> String {
    let message = format!("{picture} was not begun: interrupted");
    json!({"picture": picture, "error": {"code": "interrupted", "message": message}}).to_string()
}

fn failure(rows: &[Row], keeps: bool) -> Option<Failure> {
    const NAMED: usize = 3;
    let failed: Vec<_> = rows
        .iter()
        .filter(|row| matches!(row.outcome, Outcome::Failed { .. }))
        .map(|row| row.picture.as_str())
        .collect();
    let names = failed.iter().take(NAMED).copied().collect::<Vec<_>>().join(", ");
    let more = match failed.len().saturating_sub(NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let kept = if keeps { ": what is done is kept" } else { "" };
    let them = if failed.len() == 1 { ["it", "it"] } else { ["them", "each"] };
    let message = format!(
        "{} of {} pictures failed: {names}{more}; the reason stands beside {}. Mend or leave out {}, and run the same \
         command again{kept}",
        failed.len(),
        rows.len(),
        them[1],
        them[0],
    );
    (!failed.is_empty()).then(|| Failure::failed("pictures-failed", message))
}

fn interrupted(done: usize, left: usize, keeps: bool) -> Failure {
    let advice = match keeps {
        true => format!("the same command again goes on with the other {left}"),
        false => "nothing was written: with --out FOLDER/ the next run goes on from here".to_owned(),
    };
    let message = format!("interrupted: {done} of {} pictures are done; {advice}", done + left);
    Failure { status: Status::Interrupted, code: "interrupted", message }
}

/// `{"pictures":[…` on standard output, in order, each as soon as those before it are there: a long batch takes no
/// memory for what is printed.
struct Stream {
    waiting: Vec<Option<String>>,
    printed: usize,
}

impl Stream {
    fn new(pictures: usize) -> Self {
        Self { waiting: vec![None; pictures], printed: 0 }
    }

    fn add(&mut self, index: usize, object: String) {
        self.waiting[index] = Some(object);
        let mut out = std::io::stdout().lock();
        while let Some(object) = self.waiting.get_mut(self.printed).and_then(Option::take) {
            let before = if self.printed == 0 { "{\"pictures\":[" } else { "," };
            // a reader that has left is no error
            drop(write!(out, "{before}{object}"));
            self.printed += 1;
        }
    }

    /// What is left to print when every object is.
    fn end(self, totals: &Totals) -> String {
        let before = if self.printed == 0 { "{\"pictures\":[" } else { "" };
        format!("{before}],\"totals\":{}}}", totals.json())
    }
}
