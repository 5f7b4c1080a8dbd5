//! What a batch tells: rows of the table, one JSON object that appears as it grows, how it ended.

use serde_json::json;
use tracelight_task::{Failure, Status, Task};

use crate::figures::Figures;
use crate::row::{Outcome, Row, Totals};
use crate::table;

/// What only `--json` tells of a picture.
#[derive(Debug, Default)]
pub(crate) struct Extra {
    /// Where its strokes are.
    pub(crate) file: Option<String>,
    /// Themselves, as JSON.
    pub(crate) strokes: Option<String>,
}

/// Who takes pieces of a JSON object as they come.
pub(crate) type Pieces<'a> = dyn FnMut(&str) + 'a;

/// What a report says of the batch as a whole.
pub(crate) struct Names<'a> {
    /// The pictures', in order.
    pub(crate) pictures: Vec<&'a str>,
    /// What is done is in a folder.
    pub(crate) are_kept: bool,
}

/// All pictures of a batch, filled in as they end.
pub(crate) struct Report<'a> {
    rows: Vec<Option<Row>>,
    help: fn(&str) -> String,
    stream: Option<Stream<'a>>,
}

/// What a batch came to.
pub struct Ended {
    /// The table, and totals.
    pub text: String,
    /// The end of the JSON object whose beginning was given away already.
    pub json: String,
    /// How it ended, if not all pictures were traced.
    pub failure: Option<Failure>,
}

impl<'a> Report<'a> {
    pub(crate) fn new(pictures: usize, help: fn(&str) -> String, pieces: Option<&'a mut Pieces<'a>>) -> Self {
        Self { rows: vec![None; pictures], help, stream: pieces.map(|pieces| Stream::new(pictures, pieces)) }
    }

    /// Takes in what became of a picture.
    pub(crate) fn add(&mut self, index: usize, row: Row, extra: Extra) {
        if let Some(stream) = &mut self.stream {
            stream.add(index, object(&row, extra, self.help));
        }
        self.rows[index] = Some(row);
    }

    /// The table, or the end of the JSON object whose beginning is printed already; and how the command ends.
    pub(crate) fn end(mut self, names: &Names<'_>, task: Task<'_>, timing_ms: f64) -> Ended {
        let rows: Vec<_> = self.rows.iter().flatten().cloned().collect();
        rows.iter().filter_map(remark).for_each(|remark| task.say(&remark));
        let totals = Totals::of(&rows, timing_ms);
        let left: Vec<_> = (0..self.rows.len()).filter(|&i| self.rows[i].is_none()).collect();
        let json = self.stream.take().map(|mut stream| {
            left.iter().for_each(|&i| stream.add(i, not_begun(names.pictures[i], self.help)));
            stream.end(&totals)
        });
        let failure = if left.is_empty() {
            failure(&rows, names.are_kept)
        } else {
            Some(interrupted(rows.len(), left.len(), names.are_kept))
        };
        Ended { text: table::text(&rows, &totals), json: json.unwrap_or_default(), failure }
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

fn object(row: &Row, extra: Extra, help: fn(&str) -> String) -> String {
    let picture = &row.picture;
    match &row.outcome {
        Outcome::Failed(failure) => {
            let error = failure.object(&help(failure.code));
            json!({"picture": picture, "error": error}).to_string()
        }
        Outcome::Done { figures, timing_ms, kept } => {
            let mut object = json!({
                "picture": picture, "kept": kept, "figures": figures, "timing_ms": timing_ms,
            });
            if let Some(file) = extra.file {
                object["file"] = file.into();
            }
            let object = object.to_string();
            match (extra.strokes, object.strip_suffix('}')) {
                // a document of its own: it goes in as it is, without being read again
                (Some(strokes), Some(object)) => format!("{object},\"strokes\":{strokes}}}"),
                _ => object,
            }
        }
    }
}

fn not_begun(picture: &str, help: fn(&str) -> String) -> String {
    let interrupted = Failure::interrupted();
    let failure = Failure { message: format!("{picture} was not begun: interrupted"), ..interrupted };
    json!({"picture": picture, "error": failure.object(&help(failure.code))}).to_string()
}

fn failure(rows: &[Row], keeps: bool) -> Option<Failure> {
    const NAMED: usize = 3;
    let failed: Vec<_> = rows
        .iter()
        .filter(|row| matches!(row.outcome, Outcome::Failed(_)))
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

/// `{"pictures":[…` in pieces, in order, each as soon as those before it are there: a long batch takes no memory for what was
/// given away.
struct Stream<'a> {
    waiting: Vec<Option<String>>,
    begun: usize,
    pieces: &'a mut Pieces<'a>,
}

impl<'a> Stream<'a> {
    fn new(pictures: usize, pieces: &'a mut Pieces<'a>) -> Self {
        Self { waiting: vec![None; pictures], begun: 0, pieces }
    }

    fn add(&mut self, index: usize, object: String) {
        self.waiting[index] = Some(object);
        while let Some(object) = self.waiting.get_mut(self.begun).and_then(Option::take) {
            let before = if self.begun == 0 { "{\"pictures\":[" } else { "," };
            (self.pieces)(&format!("{before}{object}"));
            self.begun += 1;
        }
    }

    /// What is left when every object was given.
    fn end(self, totals: &Totals) -> String {
        let before = if self.begun == 0 { "{\"pictures\":[" } else { "" };
        format!("{before}],\"totals\":{}}}", totals.json())
    }
}
