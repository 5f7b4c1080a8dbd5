//! What a job's folder keeps from its first tick on, so that it can be gone on with whatever ends it: what was asked, and how far it came.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{SyncSender, sync_channel};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use tracelight_files::{self as files, ResultFolder};
use tracelight_job::{Keep, Prepared};
use tracelight_rig::TICK_F64_S;
use tracelight_sim::Tick;
use tracelight_stroke::Element;
use tracelight_task::Failure;
use tracelight_trajectory::Plan;

/// What was asked.
pub(crate) const JOB: &str = "job.toml";
/// How far it came.
pub(crate) const PROGRESS: &str = "progress";
/// Code of a run that drew all that it was to draw.
pub const NOTHING_LEFT: &str = "nothing-left";
/// Largest file of either kind, bytes.
const MOST_BYTES: u64 = 1 << 20;

/// All that is needed to do a job again.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Asked {
    /// Version of the program.
    pub version: String,
    /// When it was begun, UTC.
    pub begun: String,
    /// Where the command was given.
    pub folder: PathBuf,
    /// The command, without the program's name.
    pub arguments: Vec<String>,
    /// The strokes of the whole drawing.
    pub strokes: usize,
    /// Of all of them, m.
    pub length_m: f64,
    /// Size on the target, m.
    pub size_m: [f64; 2],
    /// By which anybody can tell whether the same strokes come out again.
    pub strokes_sha256: String,
    /// Whether `tracelight resume` can go on with it.
    pub can_resume: bool,
    /// The files that were read.
    #[serde(default)]
    pub inputs: Vec<Input>,
    /// The runs that this one goes on with, the first one first.
    #[serde(default)]
    pub before: Vec<Before>,
}

/// A file that a job was read from.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Input {
    /// Its real path.
    pub path: PathBuf,
    /// Hash of its bytes.
    pub sha256: String,
}

/// A run that ended on its way.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Before {
    /// Where its results are.
    pub folder: PathBuf,
    /// How far its plan was drawn, ticks.
    pub plan_tick: u32,
}

/// How far a run came.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Which lap, from 1.
    pub lap: u32,
    /// How far its plan was run, ticks.
    pub plan_tick: u32,
    /// All of that, ticks; 0 before the first.
    pub plan_ticks: u32,
    /// Number of the stroke that was begun last, from 1; 0 before the first.
    pub stroke: u32,
    /// How many there are.
    pub strokes: u32,
}

impl Progress {
    /// As a line, always as long: the newer one takes the place of the older, in one piece.
    fn line(&self) -> String {
        let Self { lap, plan_tick, plan_ticks, stroke, strokes } = self;
        format!("lap {lap:4} tick {plan_tick:10} of {plan_ticks:10} stroke {stroke:8} of {strokes:8}\n")
    }

    fn parse(line: &str) -> Option<Self> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let ["lap", lap, "tick", plan_tick, "of", plan_ticks, "stroke", stroke, "of", strokes] = words[..]
        else {
            return None;
        };
        Some(Self {
            lap: lap.parse().ok()?,
            plan_tick: plan_tick.parse().ok()?,
            plan_ticks: plan_ticks.parse().ok()?,
            stroke: stroke.parse().ok()?,
            strokes: strokes.parse().ok()?,
        })
    }

    /// Whether its plan was run to its end.
    #[must_use]
    pub const fn is_at_end(&self) -> bool {
        self.plan_ticks > 0 && self.plan_tick + 1 >= self.plan_ticks
    }

    /// Time of the plan that was drawn, and all of it, s.
    #[must_use]
    pub fn seconds(&self) -> (f64, f64) {
        (f64::from(self.plan_tick) * TICK_F64_S, f64::from(self.plan_ticks) * TICK_F64_S)
    }
}

/// What a run's folder tells of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept {
    /// What it was asked.
    pub asked: Asked,
    /// Nothing where it was ended before its first tick.
    pub progress: Option<Progress>,
}

/// What `dir` tells of the run whose results lie there.
///
/// # Errors
/// `not-a-run` where it tells nothing.
pub fn read(dir: &Path) -> Result<Kept, Failure> {
    let job = dir.join(JOB);
    let none = |why: String| {
        let message = format!("{} is no folder of a run: {why}; tracelight runs lists them", dir.display());
        Failure::usage("not-a-run", message)
    };
    let text = bounded(&job).map_err(|e| none(format!("{JOB}: {e}")))?;
    let asked = toml_edit::de::from_str(&text).map_err(|e| none(format!("{JOB} is damaged: {e}")))?;
    let progress = bounded(&dir.join(PROGRESS)).ok().and_then(|line| Progress::parse(&line));
    Ok(Kept { asked, progress })
}

fn bounded(path: &Path) -> std::io::Result<String> {
    let mut text = String::new();
    File::open(path)?.take(MOST_BYTES).read_to_string(&mut text)?;
    Ok(text)
}

/// Whether an argument names that real path: by itself, as a flag's value, or as what stands behind a word, as in `emulated:my-head.toml`.
fn is_named(path: &Path, arguments: &[String]) -> bool {
    let is_it = |name: &str| std::fs::canonicalize(name).is_ok_and(|real| real == path);
    arguments.iter().any(|argument| {
        let value = argument.split_once('=').map_or(argument.as_str(), |(_, value)| value);
        is_it(argument) || is_it(value) || value.match_indices(':').any(|(at, _)| is_it(&value[at + 1..]))
    })
}

impl Asked {
    /// Of a job that is about to be run, by these arguments of the program, `begun` then.
    ///
    /// # Errors
    /// `unreadable` where a file that it was read from is gone already.
    pub fn of(
        arguments: &[String],
        begun: String,
        can_resume: bool,
        prepared: &Prepared,
    ) -> Result<Self, Failure> {
        let drawing = &prepared.schedule.ordered.drawing;
        let folder = std::env::current_dir().unwrap_or_default();
        // a program that does many commands has read other files too
        let inputs = files::inputs().into_iter().filter(|path| is_named(path, arguments)).map(|path| {
            let sha256 = hash_of(&path).map_err(|e| {
                Failure::usage("unreadable", format!("cannot read {} again: {e}", path.display()))
            })?;
            Ok(Input { path, sha256 })
        });
        Ok(Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            begun,
            folder,
            arguments: arguments.to_vec(),
            strokes: drawing.strokes.len(),
            length_m: drawing.length(1e-6),
            size_m: [prepared.placed.size_m.0, prepared.placed.size_m.1],
            strokes_sha256: strokes_hash(prepared),
            can_resume,
            inputs: inputs.collect::<Result<_, Failure>>()?,
            before: Vec::new(),
        })
    }

    /// Puts it into a run's folder.
    pub(crate) fn put(&self, folder: &ResultFolder) -> Result<(), Failure> {
        let text = toml_edit::ser::to_string_pretty(self).map_err(|e| Failure::failed("internal", e))?;
        let head = "# What this run was asked, for `tracelight resume`. How far it came is in the file `progress`.\n";
        folder.put(JOB, format!("{head}{text}"))?;
        // before any light: after a power cut it is what there is to go on with
        folder.keep(JOB);
        Ok(())
    }

    /// Whether its command names every file that it was read from by its whole path.
    #[must_use]
    pub fn is_from_root(&self) -> bool {
        let is_whole = |input: &Input| {
            let path = input.path.to_string_lossy();
            self.arguments.iter().any(|argument| argument.contains(&*path))
        };
        !self.inputs.is_empty() && self.inputs.iter().all(is_whole)
    }

    /// Refuses to go on where a file that the job was read from is another one now.
    ///
    /// # Errors
    /// `changed`.
    pub fn check_inputs(&self) -> Result<(), Failure> {
        for Input { path, sha256 } in &self.inputs {
            let is = hash_of(path).map_err(|e| format!("cannot read it: {e}"));
            let why = match is {
                Ok(hash) if hash == *sha256 => continue,
                Ok(_) => "it has changed since".to_owned(),
                Err(why) => why,
            };
            let message = format!(
                "cannot go on: the run was read from {}, and {why}; put the old one back, or begin anew with tracelight {}",
                path.display(),
                self.arguments.join(" ")
            );
            return Err(Failure::usage("changed", message));
        }
        Ok(())
    }

    /// What is left of the whole job after earlier runs of it, the first one first, and what is kept of what was asked then, `begun` now. Its last note says so.
    ///
    /// # Errors
    /// `changed` where other strokes come out of the same files; [`NOTHING_LEFT`].
    pub fn rest(
        &self,
        whole: Prepared,
        before: &[Before],
        begun: String,
    ) -> Result<(Prepared, Self), Failure> {
        self.check_strokes(&whole)?;
        let mut rest = whole;
        for Before { folder, plan_tick } in before {
            rest = rest.after(*plan_tick)?.ok_or_else(|| {
                let message = format!("{} was drawn to its end: nothing is left of it", folder.display());
                Failure::failed(NOTHING_LEFT, message)
            })?;
        }
        let left = rest.schedule.ordered.drawing.strokes.len();
        let last = before.last().map_or_else(String::new, |run| run.folder.display().to_string());
        rest.notes.push(format!(
            "goes on with {last}: {left} of {} strokes are left, or a part of the first",
            self.strokes
        ));
        Ok((rest, Self { before: before.to_vec(), begun, ..self.clone() }))
    }

    /// Refuses to go on where other strokes come out of the same files.
    fn check_strokes(&self, prepared: &Prepared) -> Result<(), Failure> {
        if strokes_hash(prepared) == self.strokes_sha256 {
            return Ok(());
        }
        let message = format!(
            "cannot go on: version {} of this program draws other strokes than {} did; use that one, or begin anew with tracelight {}",
            env!("CARGO_PKG_VERSION"),
            self.version,
            self.arguments.join(" ")
        );
        Err(Failure::failed("changed", message))
    }
}

/// Hash of the strokes as they are drawn, in order, and of how long that takes.
fn strokes_hash(prepared: &Prepared) -> String {
    let mut hash = Sha256::new();
    let mut number = |value: f64| hash.update(value.to_bits().to_le_bytes());
    for stroke in &prepared.schedule.ordered.drawing.strokes {
        let start = stroke.path.start();
        [start.x, start.y].into_iter().for_each(&mut number);
        for element in stroke.path.elements() {
            match *element {
                Element::Line { to } => [1.0, to.x, to.y].into_iter().for_each(&mut number),
                Element::Arc { centre, sweep } => {
                    [2.0, centre.x, centre.y, sweep].into_iter().for_each(&mut number);
                }
                Element::Cubic { c1: a, c2: b, to } => {
                    [3.0, a.x, a.y, b.x, b.y, to.x, to.y].into_iter().for_each(&mut number);
                }
            }
        }
    }
    number(prepared.schedule.plan.points.len() as f64);
    hex(&hash.finalize())
}

/// SHA-256 of a file.
pub(crate) fn hash_of(path: &Path) -> std::io::Result<String> {
    let mut file = File::open(path)?;
    let mut hash = Sha256::new();
    let mut piece = vec![0; 1 << 16];
    loop {
        let read = file.read(&mut piece)?;
        if read == 0 {
            return Ok(hex(&hash.finalize()));
        }
        hash.update(&piece[..read]);
    }
}

fn hex(hash: &[u8]) -> String {
    hash.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Keeps how far a run came, tick by tick: what a killed program has drawn is known to the tick. After a power cut it is known as it was at the last
/// stroke's end, when the disk was asked to keep it.
pub(crate) struct Journal {
    path: PathBuf,
    file: File,
    /// Asks the disk to keep what was written, which takes as long as it takes.
    sync: SyncSender<()>,
    now: Progress,
    /// Tick of the rig.
    tick: u32,
}

impl Journal {
    /// Begins one in a run's folder.
    pub(crate) fn begin(folder: &ResultFolder, strokes: usize) -> Result<Self, Failure> {
        let file = folder.begin(PROGRESS)?;
        let path = folder.path(PROGRESS);
        let other = file.try_clone().map_err(|e| cannot_keep(&path, &e))?;
        let (sync, wanted) = sync_channel(1);
        std::thread::spawn(move || {
            while wanted.recv().is_ok() {
                // a file system that cannot has nothing better
                drop(other.sync_data());
            }
        });
        let now = Progress { lap: 1, plan_tick: 0, plan_ticks: 0, stroke: 0, strokes: strokes as u32 };
        let mut journal = Self { path, file, sync, now, tick: 0 };
        journal.write()?;
        Ok(journal)
    }

    fn write(&mut self) -> Result<(), Failure> {
        let all =
            self.file.seek(SeekFrom::Start(0)).and_then(|_| self.file.write_all(self.now.line().as_bytes()));
        all.map_err(|e| cannot_keep(&self.path, &e))
    }
}

impl Keep for Journal {
    fn tick(&mut self, plan: &Plan, tick: &Tick) -> Result<(), Failure> {
        let told = &tick.telemetry;
        let before = self.now;
        // each lap counts from power-up
        self.now.lap += u32::from(told.tick < self.tick);
        self.tick = told.tick;
        self.now.plan_tick = told.plan_tick;
        self.now.plan_ticks = plan.points.len() as u32;
        if let Some(point) = plan.points.get(told.plan_tick as usize) {
            self.now.stroke = match point.stroke {
                Some(stroke) => stroke + 1,
                // on its way to the next one
                None if before.lap == self.now.lap => before.stroke,
                None => 0,
            };
        }
        if self.now == before {
            return Ok(());
        }
        self.write()?;
        if self.now.stroke != before.stroke {
            // one that is still asked for will do
            let _ = self.sync.try_send(());
        }
        Ok(())
    }
}

fn cannot_keep(path: &Path, error: &std::io::Error) -> Failure {
    let message = format!(
        "cannot write {}: {error}; check the free space, or choose another folder with --out",
        path.display()
    );
    Failure::failed("cannot-write", message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn progress_reads_back_and_every_line_is_as_long() {
        let some = Progress { lap: 2, plan_tick: 17, plan_ticks: 12_345, stroke: 3, strokes: 11 };
        let most = Progress {
            lap: 1000,
            plan_tick: u32::MAX,
            plan_ticks: u32::MAX,
            stroke: 99_999_999,
            strokes: 99_999_999,
        };
        for progress in [some, most] {
            assert_eq!(Progress::parse(&progress.line()), Some(progress));
            assert_eq!(progress.line().len(), some.line().len());
        }
        assert_eq!(Progress::parse("lap 1 tick"), None);
    }
}
