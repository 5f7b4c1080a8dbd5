//! What a command line means that begins with no command: a picture is traced, all else is answered with what comes near it.

use std::ffi::{OsStr, OsString};
use std::path::Path;

use tracelight_task::{Failure, nearest};

/// Endings of pictures and drawings that are read, whether or not a file of that name is there.
const ENDINGS: [&str; 20] = [
    "png", "jpg", "jpeg", "webp", "bmp", "gif", "pnm", "pbm", "pgm", "ppm", "tif", "tiff", "svg", "dxf",
    "json", "csv", "heic", "heif", "pdf", "dwg",
];

/// A command line with its command put in where it begins with a picture; `sim:PICTURE` is a camera that sees one. The first argument is the
/// program, as everywhere.
///
/// # Errors
/// `usage` where it begins with what is neither command nor picture.
pub(crate) fn meant(arguments: Vec<OsString>, program: &clap::Command) -> Result<Vec<OsString>, Failure> {
    let Some(first) = (1..arguments.len()).find(|&i| !is_voice(&arguments[i])) else { return Ok(arguments) };
    let text = arguments[first].to_string_lossy().into_owned();
    if text.starts_with('-') && text != "-" {
        return Ok(arguments);
    }
    if text == "help" {
        check_help(&arguments[first + 1..], program)?;
        return Ok(arguments);
    }
    if text == "lab" {
        return Ok(formulas_kept(arguments));
    }
    if text == "point" {
        return Ok(places_kept(arguments));
    }
    if program.find_subcommand(&text).is_some() {
        return Ok(arguments);
    }
    if text.starts_with("sim:") {
        return Ok(traced(arguments, first, &["--camera"]));
    }
    if is_picture(&text, &arguments[first]) {
        return Ok(traced(arguments, first, &[]));
    }
    Err(neither(&text, program))
}

/// A space in front of places that begin with a minus, which would be read as flags: `-10cm,0mm`. Flags whose values they are do not mind.
fn places_kept(arguments: Vec<OsString>) -> Vec<OsString> {
    let kept = |text: OsString| match text.to_str() {
        Some(place) if is_place(place) => format!(" {place}").into(),
        _ => text,
    };
    arguments.into_iter().map(kept).collect()
}

/// A space in front of formulas that begin with a minus, which would be read as flags: `-2/(s+1)`. What a flag takes is left alone.
fn formulas_kept(mut arguments: Vec<OsString>) -> Vec<OsString> {
    for i in 1..arguments.len() {
        let [before, text] = [i - 1, i].map(|at| arguments[at].to_string_lossy().into_owned());
        let is_taken =
            before.starts_with('-') && !before.contains('=') && !TAKES_NOTHING.contains(&before.as_str());
        if is_formula(&text) && !is_taken {
            arguments[i] = format!(" {text}").into();
        }
    }
    arguments
}

/// Whether a word that begins with a minus is a place, and no flag.
fn is_place(text: &str) -> bool {
    text.strip_prefix('-')
        .is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit() || c == '.') && rest.contains(','))
}

/// Whether a word that begins with a minus is a formula, and no flag.
fn is_formula(text: &str) -> bool {
    let Some(rest) = text.strip_prefix(['-', '−']) else { return false };
    let is_alone = matches!(rest, "s" | "z");
    !rest.starts_with('-') && (is_alone || rest.contains(['(', '/', '^', '*']) || rest.parse::<f64>().is_ok())
}

/// Flags of systems that take no value: what follows them may be a formula.
const TAKES_NOTHING: [&str; 5] = ["--closed", "--dark", "--json", "--positive", "--quiet"];

/// What may stand before a command's name: of `trace` it may stand behind it as well.
fn is_voice(argument: &OsStr) -> bool {
    argument == "--json" || argument == "--quiet"
}

/// The command line with `trace` in front, and the flag before the argument that names what is traced.
fn traced(mut arguments: Vec<OsString>, at: usize, flag: &[&str]) -> Vec<OsString> {
    arguments.splice(at..at, flag.iter().map(OsString::from));
    arguments.insert(1, "trace".into());
    arguments
}

fn is_picture(text: &str, path: &OsStr) -> bool {
    let ending = text.rsplit_once('.').map(|(_, ending)| ending.to_ascii_lowercase());
    let is_known = ending.is_some_and(|ending| ENDINGS.contains(&ending.as_str()));
    text == "-" || Path::new(path).is_file() || is_known && !Path::new(path).is_dir()
}

fn neither(text: &str, program: &clap::Command) -> Failure {
    let trace = "to draw a picture: tracelight trace FILE; all commands: tracelight --help";
    let message = if Path::new(text).is_dir() {
        format!(
            "{text} is a folder; the strokes of its pictures: tracelight strokes {text} -o out/; to draw one of them: tracelight trace FILE"
        )
    } else {
        let meant = nearest(text, program.get_subcommands().map(clap::Command::get_name));
        let hint = meant.map_or_else(String::new, |name| format!(" did you mean tracelight {name}?"));
        format!("{text} is no command, and no file of that name is there;{hint} {trace}")
    };
    Failure::usage("usage", message)
}

/// Refuses help on what is no command.
fn check_help(names: &[OsString], program: &clap::Command) -> Result<(), Failure> {
    let mut of = program;
    for name in names.iter().map(|name| name.to_string_lossy()) {
        let Some(found) = of.find_subcommand(name.as_ref()) else {
            let commands = || of.get_subcommands().map(clap::Command::get_name);
            let hint =
                nearest(&name, commands()).map_or_else(String::new, |near| format!("did you mean {near}? "));
            let all: Vec<_> = commands().collect();
            let known = if all.is_empty() {
                "it has none".to_owned()
            } else {
                format!("there are: {}", all.join(", "))
            };
            let message = format!("{name} is no command of {}; {hint}{known}", of.get_name());
            return Err(Failure::usage("usage", message));
        };
        of = found;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(line: &str) -> Result<String, String> {
        let words = std::iter::once("tracelight").chain(line.split_whitespace());
        let program = clap::Command::new("tracelight")
            .subcommand(clap::Command::new("trace"))
            .subcommand(clap::Command::new("strokes"))
            .subcommand(clap::Command::new("lab").subcommand(clap::Command::new("bode")));
        let meant = meant(words.map(OsString::from).collect(), &program).map_err(|e| e.message)?;
        let meant: Vec<_> = meant.iter().skip(1).map(|word| word.to_string_lossy()).collect();
        Ok(meant.join(" "))
    }

    #[test]
    fn a_formula_may_begin_with_a_minus() {
        for (typed, wanted) in [
            ("lab bode -2/(s+1) -o x.svg", "lab bode  -2/(s+1) -o x.svg"),
            ("lab bode --json -s/(s+1)", "lab bode --json  -s/(s+1)"),
            ("lab move line --angle -90deg/2", "lab move line --angle -90deg/2"),
            ("lab locus G11 -o out/(1).svg", "lab locus G11 -o out/(1).svg"),
        ] {
            assert_eq!(told(typed).as_deref(), Ok(wanted), "{typed}");
        }
    }

    #[test]
    fn a_picture_in_the_place_of_a_command_is_traced() {
        for (typed, wanted) in [
            ("house.png", "trace house.png"),
            ("A/B.JPG --width 3m", "trace A/B.JPG --width 3m"),
            ("--json plan.dxf", "trace --json plan.dxf"),
            ("sim:house.png --seed 3", "trace --camera sim:house.png --seed 3"),
            ("-", "trace -"),
            ("Cargo.toml", "trace Cargo.toml"), // it is there: what it is, its content says
            ("trace house.png", "trace house.png"),
            ("lab bode", "lab bode"),
            ("--help", "--help"),
            ("help lab bode", "help lab bode"),
            ("--version", "--version"),
            ("", ""),
        ] {
            assert_eq!(told(typed), Ok(wanted.to_owned()), "{typed}");
        }
    }

    #[test]
    fn what_is_neither_is_answered_with_what_comes_near() {
        for (typed, wanted) in [
            ("trcae house.png", "did you mean tracelight trace?"),
            ("stroke", "did you mean tracelight strokes?"),
            ("banana", "tracelight trace FILE"),
            ("src", "tracelight strokes src -o out/"),
            ("help trcae", "did you mean trace?"),
            ("help lab boda", "did you mean bode?"),
            ("help trace more", "trace; it has none"),
        ] {
            let message = told(typed).unwrap_err();
            assert!(message.contains(wanted), "{typed}: {message}");
        }
        assert!(!told("banana").unwrap_err().contains("did you mean"));
    }
}
