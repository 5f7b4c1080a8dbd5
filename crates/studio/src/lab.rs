//! Experiments of the lab, asked by a page: what each may be asked, its figures, words and plot.

use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

use serde::Deserialize;
use serde_json::{Map, Value, json};
use tracelight_files as files;
use tracelight_task::{Failure, nearest};

use crate::desk::Desk;
use crate::flags::{named_values, typed};
use crate::folder::Folder;
use crate::names::Names;
use crate::program::Performed;
use crate::tasks::{AtLast, Work, failure_json};

/// What a page asks.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Experiment {
    /// A command of `tracelight lab`.
    command: String,
    /// Systems as formulas, or a lesson's number.
    #[serde(default)]
    of: Vec<String>,
    #[serde(default)]
    flags: Map<String, Value>,
}

/// Flags of systems that are formulas.
const SYSTEM: [&str; 7] = ["set", "rig", "at", "keep_cancellations", "period", "sample", "closed"];
/// What an experiment works on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Subject {
    /// A head, by its rig.
    Head,
    /// Systems as formulas.
    Systems,
    /// The number of a lesson.
    Lesson,
}

/// An experiment that a page may ask for.
struct Kind {
    /// The words after `tracelight lab`.
    name: &'static str,
    of: Subject,
    /// Its own flags: none of them names a file.
    flags: &'static [&'static str],
    /// Whether it writes a folder with its plot and a rig file, and not a plot alone.
    makes_rig: bool,
    /// Whether it can take long: it is for who operates.
    is_long: bool,
}

const fn kind(name: &'static str, of: Subject, flags: &'static [&'static str]) -> Kind {
    Kind { name, of, flags, makes_rig: false, is_long: false }
}

/// All of them: those that take a moment, and read no file.
const EXPERIMENTS: [Kind; 15] = [
    kind(
        "step",
        Subject::Head,
        &["axis", "to", "law", "observer", "reference", "gains", "anti_windup", "feedforward", "rig"],
    ),
    kind("response", Subject::Systems, &["input", "duration", "disturbance"]),
    kind("bode", Subject::Systems, &["from", "to"]),
    kind("nyquist", Subject::Systems, &["from", "to"]),
    kind("nichols", Subject::Systems, &["from", "to"]),
    kind("locus", Subject::Systems, &["damping", "gain"]),
    kind("pzmap", Subject::Systems, &[]),
    kind("gang", Subject::Systems, &["controller", "from", "to"]),
    kind(
        "design pid",
        Subject::Systems,
        &["type", "crossover", "phase_margin", "overshoot", "filter", "modulus"],
    ),
    Kind {
        makes_rig: true,
        is_long: true,
        ..kind(
            "tune",
            Subject::Head,
            &[
                "law",
                "laws",
                "observer",
                "gain_margin",
                "lag",
                "plants",
                "shape",
                "speed",
                "lit_speed",
                "seed",
                "rig",
            ],
        )
    },
    Kind {
        is_long: true,
        ..kind(
            "montecarlo",
            Subject::Head,
            &["plants", "shape", "law", "observer", "laps", "speed", "lit_speed", "seed", "rig"],
        )
    },
    kind(
        "relay",
        Subject::Head,
        &["axis", "level", "hysteresis", "crossover", "phase_margin", "to", "seed", "rig"],
    ),
    kind("profile", Subject::Head, &["distance", "vmax", "amax", "dmax", "profile"]),
    Kind {
        is_long: true,
        ..kind("velocity", Subject::Head, &["speeds", "intervals", "law", "observer", "seed", "rig"])
    },
    kind("lesson", Subject::Lesson, &["answer"]),
];
/// Counts that would take minutes, and the most of them.
const COUNTS: [(&str, u32); 2] = [("plants", 500), ("laps", 20)];
/// Most systems at once, and longest formula, bytes.
const MOST_SYSTEMS: usize = 8;
const MOST_BYTES: usize = 300;

impl Experiment {
    fn kind(&self) -> Result<&'static Kind, Failure> {
        let command = &self.command;
        EXPERIMENTS.iter().find(|kind| kind.name == command).ok_or_else(|| {
            let names = EXPERIMENTS.iter().map(|kind| kind.name);
            let near = nearest(command, names.clone())
                .map_or_else(String::new, |near| format!("; did you mean {near}?"));
            let names = names.collect::<Vec<_>>().join(", ");
            Failure::usage("usage", format!("{command:?} is no experiment of the studio: {names}{near}"))
        })
    }

    /// Whether it can take long; an experiment that there is not takes no time.
    pub(crate) fn is_long(&self) -> bool {
        self.kind().is_ok_and(|kind| kind.is_long)
    }

    /// The command line, without where its plot goes.
    ///
    /// # Errors
    /// `usage` of another experiment, or of what could read a file.
    fn command(&self, names: &Names) -> Result<Vec<String>, Failure> {
        let Self { command, of, flags } = self;
        let kind = self.kind()?;
        let has = |flag: &str| {
            kind.flags.contains(&flag) || (kind.of == Subject::Systems && SYSTEM.contains(&flag))
        };
        let mut all: Vec<String> =
            std::iter::once("lab").chain(command.split(' ')).map(str::to_owned).collect();
        all.extend(named_values(flags, has, names)?);
        all.iter().try_for_each(|word| is_quick(word))?;
        // however often it is given
        all.iter().filter_map(|word| word.strip_prefix("--controller=")).try_for_each(is_formula)?;
        if of.len() > MOST_SYSTEMS {
            return Err(Failure::usage(
                "usage",
                format!("{} systems are more than {MOST_SYSTEMS}", of.len()),
            ));
        }
        of.iter().try_for_each(|formula| is_formula(formula))?;
        // whatever it begins with it is no flag
        all.extend((!of.is_empty()).then(|| "--".to_owned()));
        all.extend(of.iter().cloned());
        Ok(all)
    }
}

/// Refuses what takes minutes, and a shape that could be a file's name.
fn is_quick(word: &str) -> Result<(), Failure> {
    let shape = word.strip_prefix("--shape=");
    if let Some(shape) = shape.filter(|shape| !["circle", "line"].contains(shape)) {
        let message = format!("shape is circle or line; it is {shape}; pictures are the terminal's");
        return Err(Failure::usage("usage", message));
    }
    for (flag, most) in COUNTS {
        let count = word.strip_prefix(&format!("--{flag}=")).and_then(|count| count.parse::<f64>().ok());
        if let Some(count) = count.filter(|&count| count > f64::from(most)) {
            let message = format!(
                "{flag} is {most} at most in the studio; it is {count}; more take minutes: tracelight lab montecarlo --{flag} {count}"
            );
            return Err(Failure::usage("usage", message));
        }
    }
    Ok(())
}

/// Refuses what is no formula, and could be a file's name: that has a letter behind a dot, as no number does.
fn is_formula(text: &str) -> Result<(), Failure> {
    let is_name = |pair: &[u8]| pair[0] == b'.' && !pair[1].is_ascii_digit() && pair[1] != b'*';
    let names_file = text.as_bytes().windows(2).any(is_name) || text.contains(['\\', ':']);
    if text.len() > MOST_BYTES || names_file || text.chars().any(char::is_control) {
        let message = format!(
            "{text:?} is no formula of at most {MOST_BYTES} letters, such as 3(s+6)^2/(s(s+1)^2); files are the terminal's"
        );
        return Err(Failure::usage("usage", message));
    }
    Ok(())
}

impl Desk {
    /// Makes an experiment: its command, figures, words and plot. What is wrong with an answer to a lesson is told with them.
    ///
    /// # Errors
    /// What is wrong with it; what the program says.
    pub(crate) fn experiment(
        &self,
        asked: &Experiment,
        (work, operates): (Arc<Work>, bool),
    ) -> Result<Value, Failure> {
        work.stop.check()?;
        let command = asked.command(&self.names())?;
        let kind = asked.kind()?;
        let _last = AtLast(Arc::clone(&work));
        self.begin_experiment(&work);
        let (plot, made) =
            (self.folder.moment("lab", work.id, ".svg"), self.folder.moment("lab", work.id, ""));
        let at = 1 + kind.name.split(' ').count();
        let with = |more: &[&str]| -> Vec<String> {
            let more = more.iter().map(|&word| word.to_owned());
            command[..at].iter().cloned().chain(more).chain(command[at..].iter().cloned()).collect()
        };
        let to = if kind.makes_rig { &made } else { &plot }.to_string_lossy();
        let out = ["--out", &to];
        let done = self.program.perform(
            &with(&[&["--json", "--words", "--quiet"], &out[..]].concat()),
            None,
            (&*work, &work.stop),
        );
        let svg = fs::read_to_string(if kind.makes_rig { made.join("tune.svg") } else { plot.clone() });
        let rig = fs::read_to_string(made.join("rig.toml")).ok();
        // what cannot be removed is written over another time
        let _ = fs::remove_file(&plot);
        let _ = fs::remove_dir_all(&made);
        let Performed { json, text, failure } = done?;
        let answer: Value = serde_json::from_str(&json).unwrap_or(Value::Null);
        let answers = command.iter().any(|word| word.starts_with("--answer="));
        if operates && kind.of == Subject::Lesson && failure.is_none() && answers {
            self.folder.passed(asked.of.first().map_or("", String::as_str))?;
        }
        // where its files were is nobody's to know
        let words: Vec<&str> = text.lines().filter(|line| !line.contains(&*to)).collect();
        Ok(json!({
            "command": typed(&command), "answer": answer, "words": words.join("\n").trim_end(), "svg": svg.unwrap_or_default(), "rig": rig,
            "failure": failure.as_ref().map(failure_json),
        }))
    }

    /// The lessons whose questions were answered rightly.
    pub(crate) fn lessons(&self) -> Value {
        json!({ "passed": self.folder.lessons_passed() })
    }
}

impl Folder {
    fn lessons(&self) -> PathBuf {
        self.dir().join("lessons.json")
    }

    /// Numbers of the lessons that were passed; none where that is not known.
    fn lessons_passed(&self) -> Vec<u32> {
        let text = fs::read_to_string(self.lessons()).unwrap_or_default();
        let kept: Value = serde_json::from_str(&text).unwrap_or_default();
        let numbers = kept["passed"].as_array().into_iter().flatten();
        numbers.filter_map(|number| u32::try_from(number.as_u64()?).ok()).collect()
    }

    /// Takes note of a lesson that was passed.
    fn passed(&self, lesson: &str) -> Result<(), Failure> {
        let mut all = self.lessons_passed();
        let Ok(number) = lesson.parse() else { return Ok(()) };
        if all.contains(&number) {
            return Ok(());
        }
        all.push(number);
        all.sort_unstable();
        files::write(&self.lessons().to_string_lossy(), json!({ "passed": all }).to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(asked: Value) -> Result<Vec<String>, Failure> {
        serde_json::from_value::<Experiment>(asked).unwrap().command(&Names::of_presets(&["report"]))
    }

    #[test]
    fn all_experiments_are_described() {
        let described: Value = serde_json::from_str(include_str!("openapi.json")).unwrap();
        let asked =
            &described["paths"]["/lab"]["post"]["requestBody"]["content"]["application/json"]["schema"];
        let names: Vec<&str> = EXPERIMENTS.iter().map(|kind| kind.name).collect();
        let mut described: Vec<&str> = asked["properties"]["command"]["enum"]
            .as_array()
            .unwrap()
            .iter()
            .filter_map(Value::as_str)
            .collect();
        described.sort_unstable_by_key(|name| names.iter().position(|known| known == name));
        assert_eq!(described, names);
    }

    #[test]
    fn an_experiment_is_a_command_line_and_names_no_file() {
        let bode = json!({ "command": "bode", "of": ["K11*G11", "-1.5/(s+.5)"], "flags": { "closed": true, "rig": "report" } });
        assert_eq!(
            of(bode).unwrap(),
            ["lab", "bode", "--closed", "--rig=report", "--", "K11*G11", "-1.5/(s+.5)"]
        );
        let design = json!({ "command": "design pid", "of": ["G11"], "flags": { "crossover": "60rad/s" } });
        assert_eq!(of(design).unwrap(), ["lab", "design", "pid", "--crossover=60rad/s", "--", "G11"]);
        for (asked, why) in [
            (json!({ "command": "bodee" }), "did you mean bode?"),
            (json!({ "command": "identify" }), "is no experiment of the studio"),
            (json!({ "command": "montecarlo", "flags": { "plants": 100_000 } }), "500 at most"),
            (
                json!({ "command": "montecarlo", "flags": { "shape": "/etc/x.png" } }),
                "shape is circle or line",
            ),
            (json!({ "command": "tune", "flags": { "out": "/tmp/x" } }), "out is no flag"),
            (json!({ "command": "tune", "flags": { "save": true } }), "save is no flag"),
            (json!({ "command": "bode", "of": ["/etc/x.toml"] }), "is no formula"),
            (json!({ "command": "bode", "of": ["G11", "a.mat:G"] }), "is no formula"),
            (
                json!({ "command": "gang", "of": ["G11"], "flags": { "controller": "k.json" } }),
                "is no formula",
            ),
            (
                json!({ "command": "gang", "of": ["G11"], "flags": { "controller": ["K11", "k.json"] } }),
                "is no formula",
            ),
            (json!({ "command": "bode", "flags": { "with": "P=x.toml" } }), "with is no flag"),
            (json!({ "command": "bode", "flags": { "rig": "/tmp/x.toml" } }), "rig is one of"),
            (json!({ "command": "step", "flags": { "set": "A" } }), "set is no flag"),
            (json!({ "command": "bode", "of": vec!["s"; 9] }), "9 systems"),
        ] {
            let told = of(asked.clone()).unwrap_err().message;
            assert!(told.contains(why), "{asked}: {told}");
        }
    }
}
