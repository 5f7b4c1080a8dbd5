//! Which runs a folder holds.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use tracelight_task::Failure;

use crate::folder::SUMMARY;
use crate::journal::{self, Asked, Kept, Progress};

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
    /// What stands in its summary; null where none was written.
    pub summary: Value,
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
        if let Ok(Kept { asked, progress }) = journal::read(&dir) {
            let summary = summary(&dir).unwrap_or(Value::Null);
            rows.push(ListedRun { dir, asked, progress, summary });
        }
    }
    rows.sort_by(|a, b| (&a.asked.begun, &a.dir).cmp(&(&b.asked.begun, &b.dir)));
    Ok(rows)
}

fn summary(dir: &Path) -> Option<Value> {
    let path = dir.join(SUMMARY);
    let is_small = fs::metadata(&path).is_ok_and(|of| of.is_file() && of.len() <= MOST_BYTES);
    is_small.then(|| fs::read(&path).ok()).flatten().and_then(|bytes| serde_json::from_slice(&bytes).ok())
}

impl ListedRun {
    /// Whether it drew all that it was to draw.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        self.summary["run"]["finished"] == true
    }

    /// In words.
    #[must_use]
    pub fn how_far(&self) -> String {
        let before = if self.asked.before.is_empty() { "" } else { "the rest of an earlier run: " };
        let far = match self.progress {
            _ if self.is_finished() => return format!("{before}done"),
            Some(progress) if progress.plan_ticks > 0 => {
                let (drawn_s, all_s) = progress.seconds();
                format!("stroke {} of {}, {drawn_s:.1} of {all_s:.1} s", progress.stroke, progress.strokes)
            }
            _ => "nothing".to_owned(),
        };
        let why = self.summary["laser"]["faults"]
            .as_array()
            .and_then(|faults| faults.last())
            .and_then(|fault| fault["code"].as_str())
            .map_or_else(String::new, |code| format!(", then {code}"));
        let killed = if self.summary.is_null() { ", no results: killed, or still running" } else { "" };
        format!("{before}{far}{why}{killed}")
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
            "length_m": self.asked.length_m,
            "duration_s": self.summary["run"]["duration_s"],
            "rms_mm": self.rms_mm(),
            "max_mm": self.summary["tracking"]["max_mm"],
            "simulated": self.summary["simulated"],
            "finished": self.is_finished(),
            "progress": progress,
            "goes_on_with": self.asked.before.last().map(|before| &before.folder),
        })
    }
}
