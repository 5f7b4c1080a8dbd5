//! Which cameras are plugged in.

use std::path::PathBuf;

/// Video devices that are plugged in; not all of them send images.
#[must_use]
pub fn devices() -> Vec<PathBuf> {
    let entries = std::fs::read_dir("/dev").into_iter().flatten().flatten();
    let number = |path: &PathBuf| path.to_str()?.strip_prefix("/dev/video")?.parse::<u32>().ok();
    let mut all: Vec<(u32, PathBuf)> =
        entries.map(|entry| entry.path()).filter_map(|path| Some((number(&path)?, path))).collect();
    all.sort();
    all.into_iter().map(|(_, path)| path).collect()
}
