//! What a failure is for scripts: one object, with what to do.

use tracelight_camera::shown;
use tracelight_task::{Failure, meaning};

/// A failure as JSON; what to do is what its code means, as `explain` has it.
pub(crate) fn json(failure: &Failure) -> String {
    let help = meaning(failure.code).unwrap_or_default();
    shown(&failure.json(&help))
}

/// A command line that the parser refused, as a failure: what it says first.
pub(crate) fn refused(error: &clap::Error) -> Failure {
    let text = error.render().to_string();
    let first = text.split("\n\n").next().unwrap_or_default();
    let words: Vec<&str> = first.trim_start_matches("error: ").split_whitespace().collect();
    Failure::usage("usage", words.join(" "))
}

/// A command line that the parser refused: what it says first is the message, the rest and what is known beside it is what to do.
pub(crate) fn refused_json(error: &clap::Error, more: &[String]) -> String {
    let text = error.render().to_string();
    let mut parts = text.split("\n\n").map(|part| part.split_whitespace().collect::<Vec<_>>().join(" "));
    let first = parts.next().unwrap_or_default();
    let message = first.trim_start_matches("error: ");
    let rest = parts.filter(|part| !part.is_empty() && !part.starts_with("For more information"));
    let help: Vec<String> = rest.chain(more.iter().cloned()).collect();
    let help = if help.is_empty() { meaning("usage").unwrap_or_default() } else { help.join("; ") };
    Failure::usage("usage", message).json(&help)
}
