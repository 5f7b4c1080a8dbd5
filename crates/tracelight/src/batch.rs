//! Many pictures: on all cores, past those that fail, in the order they were named, and again from where it stopped.
//!
//! | module | knows |
//! |---|---|
//! | [`places`] | the file each picture's strokes go to |
//! | [`manifest`] | what is done already |
//! | [`queue`] | threads, memory, panics |
//! | [`weight`] | the memory a picture takes |
//! | [`figures`], [`table`], [`report`] | what is told of it |

pub(crate) mod figures;
mod manifest;
pub(crate) mod places;
mod queue;
mod report;
mod table;
mod weight;

use std::ffi::OsStr;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use figures::Figures;
use manifest::{Entry, Manifest, Stamp};
use queue::Panicked;
use report::Report;
pub(crate) use report::{Outcome, Row, Totals};
use tracelight_files::Picture;
use tracelight_task::{Failure, Stop, Task};

use crate::bar::Bar;
use crate::cli::{Answer, Voice};

/// What a batch is asked for.
pub(crate) struct Batch<'a> {
    /// In the order they are told of.
    pub(crate) pictures: Vec<Picture>,
    /// Where their strokes go.
    pub(crate) out: Option<Out<'a>>,
    /// Threads.
    pub(crate) jobs: usize,
    pub(crate) voice: Voice,
}

/// A folder for the results.
pub(crate) struct Out<'a> {
    pub(crate) folder: &'a Path,
    /// Their format.
    pub(crate) extension: &'a str,
    /// Version and options: whatever makes a difference to a result.
    pub(crate) made_with: String,
    /// Make also those that are there already.
    pub(crate) again: bool,
}

/// A traced picture.
pub(crate) struct Finding {
    pub(crate) figures: Figures,
    /// What its pixels are worth, a sentence.
    pub(crate) verdict: Option<String>,
    /// Its strokes, if they were asked for.
    pub(crate) json: Option<String>,
    /// Time from pixels to strokes, ms.
    pub(crate) vision_ms: f64,
}

/// Traces the picture of this name, and writes its strokes to the file, if one is given.
pub(crate) type Tracer<'a> = dyn Fn(&str, Option<&Path>) -> Result<Finding, Failure> + Sync + 'a;

/// Traces all pictures. Results begin to appear on standard output with `--json`; the answer holds the rest.
///
/// # Errors
/// What makes the whole batch senseless, before any work: names that meet in one file, a folder that cannot be
/// written. A picture that fails is a row of the answer, and the answer's failure.
pub(crate) fn run(batch: &Batch<'_>, trace: &Tracer<'_>, stop: &Stop) -> Result<Answer, Failure> {
    let began = Instant::now();
    let files = files(batch)?;
    let manifest = batch.out.as_ref().map(|out| Manifest::open(out.folder)).transpose()?;
    let mut report = Report::new(batch.pictures.len(), batch.voice.json);
    let left = keep(batch, &files, manifest.as_ref(), &mut report);
    let bar = Bar::new(batch.voice.quiet);
    let task = Task { progress: &bar, stop };
    task.progress.things(left.len() as u64);
    let work = Work { batch, files: &files, left: &left, manifest: manifest.map(Mutex::new), trace };
    let limits = queue::Limits { jobs: batch.jobs, bytes: weight::MOST_BYTES };
    queue::run(&work, left.len(), limits, stop, |index, result| {
        let index = left[index];
        let name = &batch.pictures[index].name;
        let made = result.unwrap_or_else(|panicked| Made::fallen(name, &panicked));
        report.add(index, Row { picture: name.clone(), outcome: made.outcome }, made.told);
        task.progress.finished(&table::shortened(name, LAST_NAME_COLUMNS));
    });
    Ok(report.answer(batch, task, began.elapsed().as_secs_f64() * 1e3))
}

/// A file for each picture, if they are to be written.
fn files(batch: &Batch<'_>) -> Result<Vec<PathBuf>, Failure> {
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
    report: &mut Report,
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
        let told = report::Told { file: file_name(batch, files.get(index)), strokes: None };
        report.add(index, Row { picture: picture.name.clone(), outcome }, told);
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
    told: report::Told,
}

impl Made {
    fn failed(failure: Failure) -> Self {
        let Failure { code, message, .. } = failure;
        Self { outcome: Outcome::Failed { code, message }, told: report::Told::default() }
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
        let began = Instant::now();
        let picture = &self.batch.pictures[index].name;
        // before it is read: if it changes meanwhile, it is traced again the next time
        let picture_stamp = Stamp::of(Path::new(picture));
        let file = self.files.get(index);
        let path = self.batch.out.as_ref().and_then(|out| Some(out.folder.join(file?)));
        let traced = match &path {
            Some(path) => whole(path, |path| (self.trace)(picture, Some(path)))?,
            None => (self.trace)(picture, None)?,
        };
        let timing_ms = rounded_ms(began);
        if let Some(entry) = self.entry(index, picture_stamp, path.as_deref(), &traced.figures, timing_ms) {
            self.note(&entry);
        }
        let outcome = Outcome::Done { figures: traced.figures, timing_ms, kept: false };
        let told = report::Told { file: file_name(self.batch, file), strokes: traced.json };
        Ok(Made { outcome, told })
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

/// Milliseconds since then, to the microsecond.
fn rounded_ms(began: Instant) -> f64 {
    (began.elapsed().as_secs_f64() * 1e6).round() / 1e3
}

/// Lets `write` write a file beside `path`, and gives it that name when it is whole: whoever looks sees the old file,
/// the new one, or none, whenever the process ends.
pub(crate) fn whole<T>(path: &Path, write: impl FnOnce(&Path) -> Result<T, Failure>) -> Result<T, Failure> {
    let cannot_write = |e: std::io::Error| {
        let advice = "check the folder, its permissions and the free space";
        Failure::failed("cannot-write", format!("cannot write {}: {e}; {advice}", path.display()))
    };
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    fs::create_dir_all(folder).map_err(cannot_write)?;
    let part = folder.join(part_name(path));
    let written = write(&part).and_then(|made| {
        fs::rename(&part, path).map_err(cannot_write)?;
        Ok(made)
    });
    if written.is_err() {
        drop(fs::remove_file(&part)); // it may never have been begun
    }
    written
}

/// The name of a file that is not whole yet: hidden, short even where `path` is not, of the same kind, and the same
/// each time, so that the next run replaces what a killed one left.
fn part_name(path: &Path) -> String {
    let mut hasher = DefaultHasher::new();
    path.file_name().hash(&mut hasher);
    let extension = path.extension().map(OsStr::to_string_lossy).unwrap_or_default();
    format!(".tracelight-part-{:016x}.{extension}", hasher.finish())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::batch::figures::Unit;

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
        Finding { figures, verdict: None, json: None, vision_ms: 1.0 }
    }

    #[test]
    fn a_picture_that_panics_is_a_row_like_any_that_fails() {
        let pictures =
            ["a.png", "b.png", "c.png"].map(|name| Picture { name: name.to_owned(), within: None }).to_vec();
        let batch = Batch { pictures, out: None, jobs: 2, voice: Voice { json: false, quiet: true } };
        let trace = |name: &str, _: Option<&Path>| {
            assert!(name != "b.png", "no such stroke");
            Ok(traced())
        };
        let answer = run(&batch, &trace, &Stop::default()).unwrap();
        assert!(answer.text.contains("2 traced, 0 kept, 1 failed"), "{}", answer.text);
        assert!(
            answer.text.contains("b.png    failed: b.png: the program made a mistake"),
            "{}",
            answer.text
        );
        assert!(answer.failure.unwrap().message.contains("1 of 3 pictures failed: b.png"));
    }

    #[test]
    fn a_file_is_written_whole_or_not_at_all() {
        let folder = std::env::temp_dir().join(format!("tracelight-whole-{}", std::process::id()));
        let path = folder.join("below/a.svg");
        whole(&path, |part| fs::write(part, "old").map_err(|e| Failure::failed("cannot-write", e))).unwrap();
        let failed = whole(&path, |part| -> Result<(), Failure> {
            fs::write(part, "half").unwrap();
            Err(Failure::failed("cannot-write", "the disk is full"))
        });
        assert_eq!(failed.unwrap_err().message, "the disk is full");
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(fs::read_dir(folder.join("below")).unwrap().count(), 1, "the half is gone");
        fs::remove_dir_all(folder).unwrap();
    }
}
