//! What the commands that ask a part of each joint have in common: amplifier, backlash, encoder.

use std::path::Path;

use serde_json::Value;
use tracelight_files as files;
use tracelight_rig::{Joint, PanTilt};
use tracelight_task::Failure;

use super::make_folder;
use super::step::Axis;

/// A joint, what was seen of it, and what that says.
pub(super) struct Found<S, T> {
    pub(super) joint: Joint,
    pub(super) seen: Vec<S>,
    pub(super) told: T,
}

/// The joints that are asked for: one, or both.
pub(super) fn joints(axis: Option<Axis>) -> impl Iterator<Item = Joint> + use<> {
    let only = axis.map(Axis::joint);
    Joint::BOTH.into_iter().filter(move |&joint| only.is_none_or(|only| only == joint))
}

/// What was seen says of each joint that is asked for and was seen.
pub(super) fn tell_each<S, T>(
    axis: Option<Axis>,
    mut seen: PanTilt<Vec<S>>,
    tell: impl Fn(Joint, &[S]) -> Result<T, Failure>,
    nothing: impl FnOnce() -> Failure,
) -> Result<Vec<Found<S, T>>, Failure> {
    let mut found = Vec::new();
    for joint in joints(axis) {
        let seen = std::mem::take(&mut seen[joint]);
        if !seen.is_empty() {
            let told = tell(joint, &seen)?;
            found.push(Found { joint, seen, told });
        }
    }
    if found.is_empty() { Err(nothing()) } else { Ok(found) }
}

/// Leaves files in a folder, which is made if missing.
pub(super) fn leave(out: &Path, files: &[(&str, String)]) -> Result<(), Failure> {
    make_folder(out, "--out")?;
    files.iter().try_for_each(|(name, text)| files::write(&out.join(name).display().to_string(), text))
}

/// An object for each joint, as one.
pub(super) fn by_joint(objects: impl Iterator<Item = (Joint, Value)>) -> String {
    Value::Object(objects.map(|(joint, object)| (joint.name().to_owned(), object)).collect()).to_string()
}

/// To so many digits, and without a sign where that is none.
pub(super) fn rounded(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    match text.strip_prefix('-') {
        Some(size) if size.bytes().all(|b| matches!(b, b'0' | b'.')) => size.to_owned(),
        _ => text,
    }
}
