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
    let first = in_a_line(text.split("\n\n").next().unwrap_or_default());
    Failure::usage("usage", first.trim_start_matches("error: "))
}

/// A paragraph without its line ends.
fn in_a_line(part: &str) -> String {
    part.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A command line that the parser refused: what it says first is the message, the rest and what is known beside it is what to do.
pub(crate) fn refused_json(error: &clap::Error, more: &[String]) -> String {
    let text = error.render().to_string();
    let parts = text.split("\n\n").skip(1).map(in_a_line);
    let rest = parts.filter(|part| !part.is_empty() && !part.starts_with("For more information"));
    let help: Vec<String> = rest.chain(more.iter().cloned()).collect();
    let help = if help.is_empty() { meaning("usage").unwrap_or_default() } else { help.join("; ") };
    refused(error).json(&help)
}
