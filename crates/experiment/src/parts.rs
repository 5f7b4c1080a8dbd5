//! What the commands that ask a part of each joint have in common: amplifier, backlash, encoder.

use serde_json::Value;
use tracelight_rig::{Joint, PanTilt};
use tracelight_task::Failure;

/// A joint, what was seen of it, and what that says.
pub(crate) struct Found<S, T> {
    pub(crate) joint: Joint,
    pub(crate) seen: Vec<S>,
    pub(crate) told: T,
}

/// The joints that are asked for: one, or both.
pub(crate) fn joints(only: Option<Joint>) -> impl Iterator<Item = Joint> + use<> {
    Joint::BOTH.into_iter().filter(move |&joint| only.is_none_or(|only| only == joint))
}

/// What was seen says of each joint that is asked for and was seen.
pub(crate) fn tell_each<S, T>(
    only: Option<Joint>,
    mut seen: PanTilt<Vec<S>>,
    tell: impl Fn(Joint, &[S]) -> Result<T, Failure>,
    nothing: impl FnOnce() -> Failure,
) -> Result<Vec<Found<S, T>>, Failure> {
    let mut found = Vec::new();
    for joint in joints(only) {
        let seen = std::mem::take(&mut seen[joint]);
        if !seen.is_empty() {
            let told = tell(joint, &seen)?;
            found.push(Found { joint, seen, told });
        }
    }
    if found.is_empty() { Err(nothing()) } else { Ok(found) }
}

/// An object for each joint, as one.
pub(crate) fn by_joint(objects: impl Iterator<Item = (Joint, Value)>) -> String {
    Value::Object(objects.map(|(joint, object)| (joint.name().to_owned(), object)).collect()).to_string()
}
