//! Experiments of the lab, asked by a page: what each may be asked, its figures, words and plot.

use std::fs;

use serde::Deserialize;
use serde_json::{Map, Value, json};
use tracelight_task::{Failure, nearest};

use crate::desk::Desk;
use crate::flags::{named_values, typed};
use crate::rig_names::Rigs;
use crate::tasks::failure_json;

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
/// Experiments that a page may ask for, and their own flags: those that take a moment, and read no file.
const EXPERIMENTS: [(&str, &[&str]); 9] = [
    ("step", &["axis", "to", "law", "observer", "reference", "gains", "anti_windup", "feedforward", "rig"]),
    ("response", &["input", "duration", "disturbance"]),
    ("bode", &["from", "to"]),
    ("nyquist", &["from", "to"]),
    ("nichols", &["from", "to"]),
    ("locus", &["damping", "gain"]),
    ("pzmap", &[]),
    ("gang", &["controller", "from", "to"]),
    ("lesson", &["answer"]),
];
/// Most systems at once, and longest formula, bytes.
const MOST_SYSTEMS: usize = 8;
const MOST_BYTES: usize = 300;

impl Experiment {
    /// The command line, without where its plot goes.
    ///
    /// # Errors
    /// `usage` of another experiment, or of what could read a file.
    fn command(&self, rigs: &Rigs) -> Result<Vec<String>, Failure> {
        let Self { command, of, flags } = self;
        let Some((_, own)) = EXPERIMENTS.iter().find(|(name, _)| name == command) else {
            let names = EXPERIMENTS.map(|(name, _)| name);
            let near =
                nearest(command, names).map_or_else(String::new, |near| format!("; did you mean {near}?"));
            let message = format!("{command:?} is no experiment of the studio: {}{near}", names.join(", "));
            return Err(Failure::usage("usage", message));
        };
        let has_systems = !["step", "lesson"].contains(&command.as_str());
        let has = |flag: &str| own.contains(&flag) || (has_systems && SYSTEM.contains(&flag));
        let mut all = vec!["lab".to_owned(), command.clone()];
        all.extend(named_values(flags, has, rigs)?);
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
    pub(crate) fn experiment(&self, asked: &Experiment) -> Result<Value, Failure> {
        let command = asked.command(&self.known_rigs())?;
        let work = self.work();
        let plot = self.folder.plot(work.id);
        let at = 2.min(command.len());
        let with = |more: &[&str]| -> Vec<String> {
            let more = more.iter().map(|&word| word.to_owned());
            command[..at].iter().cloned().chain(more).chain(command[at..].iter().cloned()).collect()
        };
        let to = plot.to_string_lossy();
        let figures =
            self.program.perform(&with(&["--json", "--quiet", "-o", &to]), None, (&*work, &work.stop));
        let svg = fs::read_to_string(&plot).unwrap_or_default();
        // what cannot be removed is written over another time
        let _ = fs::remove_file(&plot);
        let figures = figures?;
        let words = self.program.perform(&with(&["--quiet"]), None, (&*work, &work.stop))?;
        let answer: Value = serde_json::from_str(&figures.json).unwrap_or(Value::Null);
        Ok(json!({
            "command": typed(&command), "answer": answer, "words": words.text, "svg": svg,
            "failure": figures.failure.as_ref().map(failure_json),
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(asked: Value) -> Result<Vec<String>, Failure> {
        serde_json::from_value::<Experiment>(asked).unwrap().command(&Rigs::of_presets(&["report"]))
    }

    #[test]
    fn an_experiment_is_a_command_line_and_names_no_file() {
        let bode = json!({ "command": "bode", "of": ["K11*G11", "-1.5/(s+.5)"], "flags": { "closed": true, "rig": "report" } });
        assert_eq!(
            of(bode).unwrap(),
            ["lab", "bode", "--closed", "--rig=report", "--", "K11*G11", "-1.5/(s+.5)"]
        );
        for (asked, why) in [
            (json!({ "command": "bodee" }), "did you mean bode?"),
            (json!({ "command": "tune" }), "is no experiment of the studio"),
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
