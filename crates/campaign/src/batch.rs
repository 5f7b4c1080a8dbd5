//! The whole way of a batch.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use tracelight_files::{self as files, Picture};
use tracelight_task::{Failure, Task};

use crate::figures::Figures;
use crate::manifest::{Entry, Manifest, Stamp};
use crate::queue::{self, Panicked};
use crate::report::{Ended, Extra, Names, Pieces, Report};
use crate::row::{Outcome, Row};
use crate::{places, table, weight};

/// What a batch is asked for.
pub struct Batch<'a> {
    /// In the order they are told of.
    pub pictures: Vec<Picture>,
    /// Where their strokes go.
    pub out: Option<Out<'a>>,
    /// Threads.
    pub jobs: usize,
    /// What to do about a failure of a code, for the object of a picture that failed.
    pub help: fn(&str) -> String,
}

/// A folder for the results.
pub struct Out<'a> {
    /// The folder.
    pub folder: &'a Path,
    /// Their format.
    pub extension: &'a str,
    /// Version and options: whatever makes a difference to a result.
    pub made_with: String,
    /// Make also those that are there already.
    pub again: bool,
}

/// A traced picture.
pub struct Finding {
    /// Strokes, length, what was missed.
    pub figures: Figures,
    /// What to say of it where it is the only picture: what its pixels are worth, how long its frames take.
    pub words: Option<String>,
    /// Its strokes, if they were asked for.
    pub json: Option<String>,
    /// Time from pixels to strokes, ms.
    pub vision_ms: f64,
}

/// Traces the picture of this name, and writes its strokes to the file, if one is given.
pub type Tracer<'a> = dyn Fn(&str, Option<&Path>) -> Result<Finding, Failure> + Sync + 'a;

/// Traces all pictures. If `pieces` is given, it gets the results as one JSON object, as they come; the answer holds its end.
///
/// # Errors
/// What makes the whole batch senseless, before any work: names that meet in one file, a folder that cannot be
/// written. A picture that fails is a row of the answer, and the answer's failure.
pub fn run<'a>(
    batch: &Batch<'_>,
    trace: &Tracer<'_>,
    task: Task<'_>,
    pieces: Option<&'a mut Pieces<'a>>,
) -> Result<Ended, Failure> {
    // what is under way is finished, and what was done is told
    let _kept = task.stop.keep();
    let began_s = task.progress.clock_s();
    let files = places_of(batch)?;
    let manifest = batch.out.as_ref().map(|out| Manifest::open(out.folder)).transpose()?;
    let mut report = Report::new(batch.pictures.len(), batch.help, pieces);
    let left = keep(batch, &files, manifest.as_ref(), &mut report);
    task.progress.things(left.len() as u64);
    let work = Work { batch, files: &files, left: &left, manifest: manifest.map(Mutex::new), trace, task };
    let limits = queue::Limits { jobs: batch.jobs, bytes: weight::MOST_BYTES };
    queue::run(&work, left.len(), limits, task.stop, |index, result| {
        let index = left[index];
        let name = &batch.pictures[index].name;
        let made = result.unwrap_or_else(|panicked| Made::fallen(name, &panicked));
        report.add(index, Row { picture: name.clone(), outcome: made.outcome }, made.extra);
        task.progress.finished(&table::shortened(name, LAST_NAME_COLUMNS));
    });
    let names = Names {
        pictures: batch.pictures.iter().map(|picture| picture.name.as_str()).collect(),
        are_kept: batch.out.is_some(),
    };
    Ok(report.end(&names, task, 1e3 * (task.progress.clock_s() - began_s)))
}

/// A file for each picture, if they are to be written.
fn places_of(batch: &Batch<'_>) -> Result<Vec<PathBuf>, Failure> {
    match &batch.out {
        Some(out) => places::files(&batch.pictures, out.folder, out.extension),
        None => Ok(Vec::new()),
    }
}

/// Room for a name beside the progress bar.
const LAST_NAME_COLUMNS: usize = 24;

/// Tells of the pictures that are done already; gives the others.
fn keep(
    batch: &Batch<'_>,
    files: &[PathBuf],
    manifest: Option<&Manifest>,
    report: &mut Report<'_>,
) -> Vec<usize> {
    let held = |index: usize| -> Option<&Entry> {
        let out = batch.out.as_ref().filter(|out| !out.again)?;
        let entry = manifest?.entry(&files[index])?;
        entry.holds(out.folder, &batch.pictures[index].name, &out.made_with).then_some(entry)
    };
    let mut left = Vec::new();
    for (index, picture) in batch.pictures.iter().enumerate() {
        let Some(entry) = held(index) else {
            left.push(index);
            continue;
        };
        let outcome =
            Outcome::Done { figures: entry.figures.clone(), timing_ms: entry.timing_ms, kept: true };
        let extra = Extra { file: file_name(batch, files.get(index)), strokes: None };
        report.add(index, Row { picture: picture.name.clone(), outcome }, extra);
    }
    left
}

fn file_name(batch: &Batch<'_>, file: Option<&PathBuf>) -> Option<String> {
    let folder = batch.out.as_ref()?.folder;
    Some(folder.join(file?).to_string_lossy().into_owned())
}

/// What one picture came to.
struct Made {
    outcome: Outcome,
    extra: Extra,
}

impl Made {
    fn failed(failure: Failure) -> Self {
        Self { outcome: Outcome::Failed(failure), extra: Extra::default() }
    }

    fn fallen(picture: &str, Panicked(words): &Panicked) -> Self {
        let message =
            format!("{picture}: the program made a mistake ({words}); please report it, with the picture");
        Self::failed(Failure::failed("internal", message))
    }
}

/// The pictures that are left to do.
struct Work<'a> {
    batch: &'a Batch<'a>,
    files: &'a [PathBuf],
    /// Indices into the batch's pictures.
    left: &'a [usize],
    manifest: Option<Mutex<Manifest>>,
    trace: &'a Tracer<'a>,
    task: Task<'a>,
}

impl queue::Work for Work<'_> {
    type Done = Made;

    fn bytes(&self, index: usize) -> u64 {
        weight::bytes(&self.batch.pictures[self.left[index]].name)
    }

    fn run(&self, index: usize) -> Made {
        self.make(self.left[index]).unwrap_or_else(Made::failed)
    }
}

impl Work<'_> {
    fn make(&self, index: usize) -> Result<Made, Failure> {
        let began_s = self.task.progress.clock_s();
        let picture = &self.batch.pictures[index].name;
        // before it is read: if it changes meanwhile, it is traced again the next time
        let picture_stamp = Stamp::of(Path::new(picture));
        let file = self.files.get(index);
        let path = self.batch.out.as_ref().and_then(|out| Some(out.folder.join(file?)));
        let traced = match &path {
            Some(path) => files::written_whole(path, |path| (self.trace)(picture, Some(path)))?,
            None => (self.trace)(picture, None)?,
        };
        let timing_ms = rounded_ms(self.task.progress.clock_s() - began_s);
        if let Some(entry) = self.entry(index, picture_stamp, path.as_deref(), &traced.figures, timing_ms) {
            self.note(&entry);
        }
        let outcome = Outcome::Done { figures: traced.figures, timing_ms, kept: false };
        let extra = Extra { file: file_name(self.batch, file), strokes: traced.json };
        Ok(Made { outcome, extra })
    }

    /// At once, for the next run.
    fn note(&self, entry: &Entry) {
        if let Some(manifest) = &self.manifest {
            // lines are whole whatever thread panicked while it held them
            let mut manifest = manifest.lock().unwrap_or_else(PoisonError::into_inner);
            // a full disk is told of where strokes are written; what is not noted is only traced again
            drop(manifest.append(entry));
        }
    }

    fn entry(
        &self,
        index: usize,
        picture_stamp: Option<Stamp>,
        path: Option<&Path>,
        figures: &Figures,
        timing_ms: f64,
    ) -> Option<Entry> {
        Some(Entry {
            file: self.files.get(index)?.clone(),
            file_stamp: Stamp::of(path?)?,
            picture: std::path::absolute(&self.batch.pictures[index].name).ok()?,
            picture_stamp: picture_stamp?,
            made_with: self.batch.out.as_ref()?.made_with.clone(),
            figures: figures.clone(),
            timing_ms,
        })
    }
}

/// Milliseconds, to the microsecond.
fn rounded_ms(seconds: f64) -> f64 {
    (seconds * 1e6).round() / 1e3
}

#[cfg(test)]
mod tests {
    use tracelight_task::{NoProgress, Stop};

    use super::*;
    use crate::figures::Unit;

    fn traced() -> Finding {
        let (missed_ink, doubt) = (Some(0.0), None);
        let sheet = (640.0, 480.0);
        let figures = Figures {
            strokes: 1,
            closed: 0,
            length: 9.0,
            sheet,
            unit: Unit::Px,
            missed_ink,
            doubt,
            quality: None,
        };
        Finding { figures, words: None, json: None, vision_ms: 1.0 }
    }

    #[test]
    fn a_picture_that_panics_is_a_row_like_any_that_fails() {
        let pictures =
            ["a.png", "b.png", "c.png"].map(|name| Picture { name: name.to_owned(), within: None }).to_vec();
        let batch = Batch { pictures, out: None, jobs: 2, help: |_| String::new() };
        let trace = |name: &str, _: Option<&Path>| {
            assert!(name != "b.png", "no such stroke");
            Ok(traced())
        };
        let stop = Stop::default();
        let answer = run(&batch, &trace, Task { progress: &NoProgress, stop: &stop }, None).unwrap();
        assert!(answer.text.contains("2 traced, 0 kept, 1 failed"), "{}", answer.text);
        assert!(
            answer.text.contains("b.png    failed: b.png: the program made a mistake"),
            "{}",
            answer.text
        );
        assert!(answer.failure.unwrap().message.contains("1 of 3 pictures failed: b.png"));
    }
}
