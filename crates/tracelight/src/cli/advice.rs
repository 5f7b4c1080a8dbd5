//! What to say of wrong flags where the parser's own words leave people alone.

use std::error::Error as _;
use std::ffi::OsString;

use clap::error::{ContextKind, ErrorKind};
use tracelight_task::Failure;

/// A better message for a wrong command line, where there is one.
pub(crate) fn advice(error: &clap::Error) -> Option<Failure> {
    let message = number(error).or_else(|| words(error).map(str::to_owned))?;
    Some(Failure::usage("usage", message))
}

fn words(error: &clap::Error) -> Option<&'static str> {
    let names =
        |kind: ContextKind, name: &str| error.get(kind).is_some_and(|value| value.to_string().contains(name));
    let is_about = |name: &str| names(ContextKind::InvalidArg, name);
    let are_both = |one: &str, other: &str| {
        is_about(one) && names(ContextKind::PriorArg, other)
            || is_about(other) && names(ContextKind::PriorArg, one)
    };
    let words = match error.kind() {
        ErrorKind::MissingRequiredArgument if is_about("<PICTURE>...") => {
            "of which pictures? tracelight strokes drawing.jpg -o drawing.svg"
        }
        ErrorKind::MissingRequiredArgument if is_about("<DRAWING>") => {
            "of which drawing, or picture? tracelight plan examples/star.png -o star.csv"
        }
        ErrorKind::MissingRequiredArgument if is_about("<PICTURE>") => {
            "what is to be drawn? Name a PICTURE: tracelight trace examples/house.png --open; or for what a camera sees on the wall --camera SOURCE"
        }
        ErrorKind::ArgumentConflict if are_both("--camera", "PICTURE") => {
            "what is to be drawn? Either a PICTURE, or what a camera sees on the wall; to have a simulated camera look at a picture: --camera sim:PICTURE, and no PICTURE beside it"
        }
        ErrorKind::ArgumentConflict if are_both("--width", "--height") => {
            "either --width or --height: the other one follows from the picture's shape"
        }
        ErrorKind::ArgumentConflict if are_both("--text", "PICTURE") || are_both("--text", "DRAWING") => {
            "what is to be drawn? Either a picture, or the words of --text"
        }
        _ => return None,
    };
    Some(words)
}

/// What is wrong with a number that should be whole and within bounds.
fn number(error: &clap::Error) -> Option<String> {
    if error.kind() != ErrorKind::ValueValidation {
        return None;
    }
    let flag = error.get(ContextKind::InvalidArg)?.to_string();
    let flag = flag.split(' ').next().unwrap_or_default();
    let value = error.get(ContextKind::InvalidValue)?.to_string();
    let why = error.source()?.to_string();
    if let Some((_, range)) = why.split_once(" is not in ") {
        // as the parser writes bounds: 1..=1000, or 0..1000 without the last
        let (least, most) = range.split_once("..=").or_else(|| range.split_once(".."))?;
        let least = if least.is_empty() { "0" } else { least };
        return Some(format!("{flag} {value}: give a whole number from {least} to {most}"));
    }
    let is_wrong = ["invalid digit", "number too large", "number too small", "cannot parse integer"];
    is_wrong.into_iter().any(|start| why.starts_with(start)).then(|| {
        format!("{flag} {value}: give a whole number that is not below zero and not too large, such as 3")
    })
}

/// What there is instead, where the parser names nothing, and how the command that was meant is used; a line each.
pub(crate) fn more(error: &clap::Error, program: &clap::Command, arguments: &[OsString]) -> Vec<String> {
    let command = meant(program, arguments);
    let mut lines = Vec::new();
    if error.kind() == ErrorKind::InvalidSubcommand && error.get(ContextKind::SuggestedSubcommand).is_none() {
        let known: Vec<_> = command.get_subcommands().map(clap::Command::get_name).collect();
        lines.push(format!("there are: {}", known.join(", ")));
    }
    let is_one = ["trace", "plan"].contains(&command.get_name());
    let unknown = error.get(ContextKind::InvalidArg).map(ToString::to_string).unwrap_or_default();
    if is_one && error.kind() == ErrorKind::UnknownArgument && !unknown.starts_with('-') {
        lines.push("one picture at a time; the strokes of many: tracelight strokes PICTURE… -o out/".into());
    }
    lines.extend(example(command).map(|line| format!("example: {line}")));
    lines
}

/// The command that a line is for, as far as it is known.
fn meant<'a>(program: &'a clap::Command, arguments: &[OsString]) -> &'a clap::Command {
    let words =
        arguments.iter().skip(1).filter_map(|word| word.to_str()).filter(|word| !word.starts_with('-'));
    let mut command = program;
    for word in words {
        let Some(found) = command.find_subcommand(word) else { break };
        command = found;
    }
    command
}

/// The first example of a command's help.
fn example(command: &clap::Command) -> Option<String> {
    let help = command.get_after_help()?.to_string();
    let (_, example) = help.lines().find_map(|line| line.split_once("tracelight "))?;
    Some(format!("tracelight {}", example.trim_end()))
}
