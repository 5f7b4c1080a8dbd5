//! Which runs a folder holds.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use tracelight_files::ResultFolder;
use tracelight_task::Failure;

use crate::folder::SUMMARY;
use crate::journal::{self, Asked, Kept, Progress};
use crate::points::{is_small, ticked_off};

/// Largest summary that is read, bytes.
const MOST_BYTES: u64 = 1 << 24;

/// A run, as its folder tells of it.
#[derive(Clone, Debug)]
pub struct ListedRun {
    /// The folder.
    pub dir: PathBuf,
    /// What it was asked.
    pub asked: Asked,
    /// How far it came; nothing where it ended before its first tick.
    pub progress: Option<Progress>,
    /// How many points are ticked off, of how many, where it marks points.
    pub points: Option<(usize, usize)>,
    /// What stands in its summary; null where none was written.
    pub summary: Value,
    /// A program writes to it at present.
    pub is_running: bool,
    /// The newest run that goes on with it.
    pub went_on_in: Option<PathBuf>,
}

/// The runs in a folder, the oldest first.
///
/// # Errors
/// `unreadable`.
pub fn runs(dir: &Path) -> Result<Vec<ListedRun>, Failure> {
    let unreadable = |e: std::io::Error| {
        let message =
            format!("cannot read the folder {}: {e}; give the one that holds results", dir.display());
        Failure::usage("unreadable", message)
    };
    let entries = fs::read_dir(dir).map_err(unreadable)?;
    let mut rows = Vec::new();
    for entry in entries {
        let dir = entry.map_err(unreadable)?.path();
        if let Ok(kept) = journal::read(&dir) {
            rows.push(listed(&dir, kept));
        }
    }
    rows.sort_by(|a, b| (&a.asked.begun, &a.dir).cmp(&(&b.asked.begun, &b.dir)));
    let newest = |row: &ListedRun| {
        let real = fs::canonicalize(&row.dir).ok()?;
        let goes_on = |other: &&ListedRun| {
            other.dir != row.dir && other.asked.before.iter().any(|before| before.folder == real)
        };
        rows.iter().rev().find(goes_on).map(|other| other.dir.clone())
    };
    let newest: Vec<Option<PathBuf>> = rows.iter().map(newest).collect();
    rows.iter_mut().zip(newest).for_each(|(row, newest)| row.went_on_in = newest);
    Ok(rows)
}

/// A run by itself, whatever other ones are beside it.
pub(crate) fn listed(dir: &Path, Kept { asked, progress }: Kept) -> ListedRun {
    ListedRun {
        dir: dir.to_owned(),
        asked,
        progress,
        points: ticked_off(dir),
        summary: summary(dir).unwrap_or(Value::Null),
        is_running: ResultFolder::hold(dir).is_err(),
        went_on_in: None,
    }
}

/// Refuses a run that another one beside it went on with: that one knows what is left. `dir` is its real path.
///
/// # Errors
/// `cannot-resume`.
pub fn check_newest(dir: &Path) -> Result<(), Failure> {
    let all = dir.parent().map_or_else(|| Ok(Vec::new()), runs)?;
    let is_it = |run: &&ListedRun| fs::canonicalize(&run.dir).is_ok_and(|other| other == dir);
    let newest = all.iter().find(is_it).and_then(|run| run.went_on_in.as_ref());
    newest.map_or(Ok(()), |newest| {
        let message = format!(
            "{} went on in {}: give that one, or what it drew would be drawn twice",
            dir.display(),
            newest.display()
        );
        Err(Failure::usage("cannot-resume", message))
    })
}

fn summary(dir: &Path) -> Option<Value> {
    let path = dir.join(SUMMARY);
    is_small(&path, MOST_BYTES)
        .then(|| fs::read(&path).ok())
        .flatten()
        .and_then(|bytes| serde_json::from_slice(&bytes).ok())
}

impl ListedRun {
    /// Whether it drew all that it was to draw.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        self.summary["run"]["finished"] == true
    }

    /// Whether something of it is left that no other run goes on with, and one can.
    #[must_use]
    pub fn is_left(&self) -> bool {
        let is_at_end = self.progress.is_some_and(|progress| progress.is_at_end());
        let is_free = !self.is_running && self.went_on_in.is_none();
        self.asked.can_resume && is_free && !self.is_finished() && !is_at_end
    }

    /// In words.
    #[must_use]
    pub fn how_far(&self) -> String {
        let before = if self.asked.before.is_empty() { "" } else { "the rest of an earlier run: " };
        let ticked_off = |(done, all)| format!("{done} of {all} points ticked off");
        let far = match self.progress {
            _ if self.is_finished() => {
                let left = self.points.filter(|(done, all)| done < all);
                return format!(
                    "{before}done{}",
                    left.map_or_else(String::new, |left| format!(", {}", ticked_off(left)))
                );
            }
            Some(progress) if progress.plan_ticks > 0 => {
                let (drawn_s, all_s) = progress.seconds();
                format!("stroke {} of {}, {drawn_s:.1} of {all_s:.1} s", progress.stroke, progress.strokes)
            }
            _ => "nothing".to_owned(),
        };
        let far = self.points.map_or(far, ticked_off);
        let why = self.summary["laser"]["faults"]
            .as_array()
            .and_then(|faults| faults.last())
            .and_then(|fault| fault["code"].as_str())
            .map_or_else(String::new, |code| format!(", then {code}"));
        let how = match &self.went_on_in {
            Some(run) => format!(", went on in {}", run.display()),
            None if self.is_running => ", running".to_owned(),
            None if self.summary.is_null() => ", killed".to_owned(),
            None => String::new(),
        };
        format!("{before}{far}{why}{how}")
    }

    /// Of what was lit, mm.
    #[must_use]
    pub fn rms_mm(&self) -> Option<f64> {
        self.summary["tracking"]["rms_mm"]
            .as_f64()
            .filter(|_| self.summary["laser"]["lit_s"].as_f64() > Some(0.0))
    }

    /// For scripts.
    #[must_use]
    pub fn json(&self) -> Value {
        let progress = self.progress.map(|p| {
            let (drawn_s, all_s) = p.seconds();
            json!({ "lap": p.lap, "stroke": p.stroke, "strokes": p.strokes, "plan_s": drawn_s, "of_s": all_s })
        });
        json!({
            "folder": self.dir,
            "begun": self.asked.begun,
            "command": self.asked.arguments,
            "width_m": self.asked.size_m[0],
            "height_m": self.asked.size_m[1],
            "strokes": self.asked.strokes,
            "points": self.points.map(|(done, count)| json!({ "count": count, "done": done })),
            "length_m": self.asked.length_m,
            "duration_s": self.summary["run"]["duration_s"],
            "rms_mm": self.rms_mm(),
            "max_mm": self.summary["tracking"]["max_mm"],
            "simulated": self.summary["simulated"],
            "finished": self.is_finished(),
            "running": self.is_running,
            "left": self.is_left(),
            "went_on_in": self.went_on_in,
            "progress": progress,
            "goes_on_with": self.asked.before.last().map(|before| &before.folder),
        })
    }
}
