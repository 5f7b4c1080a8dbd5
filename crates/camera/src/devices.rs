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

/// Cameras that are plugged in, and what their makers call them: of a camera's devices the one that sends images.
#[must_use]
pub fn named_devices() -> Vec<(PathBuf, String)> {
    let told = |path: &PathBuf, what: &str| {
        let name = path.file_name()?.to_str()?;
        let text = std::fs::read_to_string(format!("/sys/class/video4linux/{name}/{what}")).ok()?;
        Some(text.trim().to_owned())
    };
    // the others tell of its images, and send none
    let sends = |path: &PathBuf| told(path, "index").is_none_or(|index| index == "0");
    let named = |path: PathBuf| {
        let name = told(&path, "name").filter(|name| !name.is_empty());
        let name = name.unwrap_or_else(|| path.display().to_string());
        (path, name)
    };
    devices().into_iter().filter(sends).map(named).collect()
}
