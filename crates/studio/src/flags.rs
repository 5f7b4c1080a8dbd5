//! What a page asks for, as a command line has it: the same names with underscores, the same values as text.

use serde_json::{Map, Value, json};
use tracelight_task::{Failure, nearest, quoted};

use crate::names::Names;

/// Flags of `plan` and `trace` that a page may give. None of them names a file, but for rigs, heads and calibrations by their names in the folder.
const FLAGS: [&str; 39] = [
    "width",
    "height",
    "offset",
    "rotate",
    "flip",
    "from",
    "origin",
    "align",
    "paper",
    "straighten",
    "whole",
    "sheets",
    "force",
    "fit",
    "no_go",
    "layer",
    "colour",
    "distance",
    "head",
    "calibration",
    "seed",
    "rig",
    "speed",
    "lit_speed",
    "corner",
    "profile",
    "amax",
    "order",
    "mode",
    "threshold",
    "despeckle",
    "min_length",
    "tolerance",
    "unit",
    "hidden",
    "crop",
    "dashes",
    "letters",
    "hatch",
];
/// Flags of a job that a page attends.
const ATTENDED: [&str; 10] =
    ["real_time", "frame", "dry_run", "step", "points", "mark", "pace", "each", "from_stroke", "sim_trouble"];

/// Of what flags are asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Which {
    /// What is drawn, and where.
    Drawing,
    /// Likewise, and how somebody attends it.
    Attended,
    /// The rest of a run: what is drawn is as it was asked then.
    Rest,
}

impl Which {
    /// How many there are in all.
    #[cfg(test)]
    pub(crate) const fn count() -> usize {
        FLAGS.len() + ATTENDED.len()
    }

    pub(crate) fn has(self, name: &str) -> bool {
        match self {
            Self::Drawing => FLAGS.contains(&name),
            Self::Attended => FLAGS.contains(&name) || ATTENDED.contains(&name),
            Self::Rest => ["real_time", "frame"].contains(&name),
        }
    }
}

/// Longest value, bytes: none of these needs more.
const MOST_BYTES: usize = 200;
/// How often a flag may be repeated.
const MOST_TIMES: usize = 100;

/// The arguments that these flags are, with files of these names; a flag that is null, false or empty is left out.
///
/// # Errors
/// `usage`: one that there is not, or a value that none has.
pub(crate) fn arguments(
    flags: &Map<String, Value>,
    which: Which,
    names: &Names,
) -> Result<Vec<String>, Failure> {
    let is_as_before = |name: &str| which == Which::Rest && Which::Attended.has(name) && !which.has(name);
    if let Some((name, _)) = flags.iter().find(|(name, _)| is_as_before(name)) {
        return Err(refused(format!("{name} is as it was when the run was begun: leave it out")));
    }
    named_values(flags, |name| which.has(name), names)
}

/// The arguments that flags are, of those that there are; a flag that is null, false or empty is left out.
///
/// # Errors
/// `usage`: one that there is not, or a value that none has.
pub(crate) fn named_values(
    flags: &Map<String, Value>,
    has: impl Fn(&str) -> bool,
    names: &Names,
) -> Result<Vec<String>, Failure> {
    let mut arguments = Vec::new();
    for (name, value) in flags {
        if !has(name) {
            let near = nearest(name, FLAGS.into_iter().filter(|flag| has(flag)));
            let near = near.map_or_else(String::new, |near| format!("; did you mean {near}?"));
            return Err(refused(format!("{name} is no flag that the studio takes{near}")));
        }
        let flag = name.replace('_', "-");
        match value {
            Value::Null | Value::Bool(false) => {}
            Value::Bool(true) => arguments.push(format!("--{flag}")),
            Value::Array(values) if values.len() <= MOST_TIMES => {
                for value in values {
                    arguments.extend(argument(&flag, value, names)?);
                }
            }
            value => arguments.extend(argument(&flag, value, names)?),
        }
    }
    Ok(arguments)
}

fn argument(flag: &str, value: &Value, names: &Names) -> Result<Option<String>, Failure> {
    let text = match value {
        Value::String(text) => text.trim().to_owned(),
        Value::Number(number) => number.to_string(),
        _ => return Err(refused(format!("{flag} is a text, such as \"3m\"; it is {value}"))),
    };
    if text.len() > MOST_BYTES || text.contains(|c: char| c.is_control()) {
        return Err(refused(format!("{flag} is longer than {MOST_BYTES} bytes, or not one line")));
    }
    if let Some(kind) = Names::kind_of(flag).filter(|_| !text.is_empty()) {
        let all: Vec<&str> = names.all(kind).collect();
        let all = if all.is_empty() {
            "none that there is".to_owned()
        } else {
            format!("one of {}", all.join(", "))
        };
        let value =
            names.value(kind, &text).ok_or_else(|| refused(format!("{flag} is {all}; it is {text}")))?;
        return Ok(Some(format!("--{flag}={value}")));
    }
    // with its value in one argument: no value can be taken for another flag
    Ok((!text.is_empty()).then(|| format!("--{flag}={text}")))
}

/// The picture's path and the flags of a command line that [`arguments`] has made, as a page asks for them; `None` of another one, which no page can ask for.
pub(crate) fn asked_by(command: &[String]) -> Option<(&str, Map<String, Value>)> {
    let [name, picture, rest @ ..] = command else { return None };
    let mut flags = Map::new();
    let mut rest = rest.iter();
    while let Some(argument) = rest.next() {
        let flag = argument.strip_prefix("--")?;
        let (flag, value) = flag.split_once('=').map_or((flag, None), |(flag, value)| (flag, Some(value)));
        let flag = flag.replace('-', "_");
        match flag.as_str() {
            "out" if value.is_none() => drop(rest.next()?),
            "json" => {}
            _ if Which::Drawing.has(&flag) => put(&mut flags, flag, value),
            // how somebody attended it is chosen anew
            _ if Which::Attended.has(&flag) => {}
            _ => return None,
        }
    }
    (name == "trace").then_some((picture.as_str(), flags))
}

/// Whether by these flags a job draws all strokes, once, one after the other.
pub(crate) fn draws_all(flags: &Map<String, Value>) -> bool {
    let is_left_out = |value: &Value| [json!(""), json!(false), Value::Null].contains(value);
    ["from_stroke", "step", "points", "frame"].iter().all(|flag| flags.get(*flag).is_none_or(is_left_out))
}

/// How a command line draws strokes: all, one at a time, or points.
pub(crate) fn mode_of(command: &[String]) -> &'static str {
    let has = |flag: &str| command.iter().any(|argument| argument.split('=').next() == Some(flag));
    match (has("--step"), has("--points")) {
        (true, _) => "step",
        (false, true) => "points",
        (false, false) => "trace",
    }
}

/// Puts a flag in: one that is there becomes a list.
fn put(flags: &mut Map<String, Value>, flag: String, value: Option<&str>) {
    let value = value.map_or(Value::Bool(true), Value::from);
    match flags.get_mut(&flag) {
        None => drop(flags.insert(flag, value)),
        Some(Value::Array(values)) => values.push(value),
        Some(first) => *first = Value::Array(vec![first.take(), value]),
    }
}

fn refused(message: String) -> Failure {
    Failure::usage("usage", message)
}

/// A command line as somebody types it.
pub(crate) fn typed(arguments: &[String]) -> String {
    let words: Vec<String> = arguments.iter().map(|argument| quoted(argument)).collect();
    format!("tracelight {}", words.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(flags: Value) -> Result<Vec<String>, Failure> {
        let Value::Object(flags) = flags else { unreachable!() };
        arguments(&flags, Which::Drawing, &Names::of_presets(&["report", "worn"]))
    }

    #[test]
    fn flags_are_those_of_the_command_line() {
        let asked =
            json!({ "width": "3 m", "flip": true, "order": null, "lit_speed": "", "layer": ["a", "b c"] });
        assert_eq!(of(asked).unwrap(), ["--flip", "--layer=a", "--layer=b c", "--width=3 m"]);
        assert_eq!(
            typed(&["plan".to_owned(), "--layer=b c".to_owned(), "it's".to_owned()]),
            r"tracelight plan '--layer=b c' 'it'\''s'"
        );
    }

    #[test]
    fn a_run_is_asked_for_again_by_its_command() {
        let asked = json!({ "width": "3 m", "flip": true, "layer": ["a", "b=c"], "lit_speed": "exact" });
        let mut command = vec!["trace".to_owned(), "/x/house.png".to_owned()];
        command.extend(of(asked.clone()).unwrap());
        command.extend(
            ["--real-time=1", "--from-stroke=3", "--out", "/x/runs/house", "--json"].map(str::to_owned),
        );
        let (picture, flags) = asked_by(&command).unwrap();
        assert_eq!((picture, Value::Object(flags)), ("/x/house.png", asked));
        // of a terminal's own
        for other in
            [&["plan", "x.png"][..], &["trace", "x.png", "--laps=3"], &["trace", "x.png", "-o"], &["trace"]]
        {
            let other: Vec<String> = other.iter().map(|&word| word.to_owned()).collect();
            assert!(asked_by(&other).is_none(), "{other:?}");
        }
    }

    #[test]
    fn what_names_a_file_or_is_no_flag_is_refused() {
        for (flags, why) in [
            (json!({ "out": "/etc/passwd" }), "out is no flag"),
            (json!({ "widht": "3m" }), "did you mean width?"),
            (json!({ "rig": "/dev/ttyACM0" }), "rig is one of report, worn"),
            (json!({ "rig": "../../x.toml" }), "rig is one of"),
            (json!({ "rig": "COM3" }), "rig is one of"),
            (json!({ "rig": "emulated" }), "rig is one of"),
            (json!({ "width": { "m": 3 } }), "width is a text"),
            (json!({ "width": "3m\n--out" }), "not one line"),
            (json!({ "layer": ["x".repeat(300)] }), "longer than 200 bytes"),
        ] {
            let refused = of(flags).unwrap_err();
            assert!(refused.message.contains(why), "{}", refused.message);
        }
        // a value that looks like a flag stays a value
        assert_eq!(of(json!({ "width": "--out=x" })).unwrap(), ["--width=--out=x"]);
    }
}
