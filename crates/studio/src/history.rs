//! Runs that were, as pages show them.

use serde_json::{Value, json};
use tracelight_task::Failure;

use crate::desk::Desk;
use crate::flags::{asked_by, mode_of};
use crate::folder::{Kind, no_run};
use crate::names::Names;

/// The head that a command line names.
fn rig_of(command: &[String]) -> Option<&str> {
    let at = command.iter().position(|argument| argument.starts_with("--rig"))?;
    command[at].strip_prefix("--rig=").or_else(|| command.get(at + 1).map(String::as_str))
}

impl Desk {
    /// All runs, the oldest first: what `tracelight runs` tells, and by what a page asks for them again.
    ///
    /// # Errors
    /// What the program says.
    pub(crate) fn runs(&self) -> Result<Value, Failure> {
        let mut told = self.ask(&["runs", &self.folder.runs().to_string_lossy(), "--json"])?;
        let names = self.names();
        for run in told["runs"].as_array_mut().into_iter().flatten() {
            self.know(run, &names);
        }
        Ok(told)
    }

    /// Adds a run's id, its files, and the picture and flags that it was asked by; null where no page can ask so.
    fn know(&self, run: &mut Value, names: &Names) {
        let id = run["folder"]
            .as_str()
            .and_then(|dir| dir.rsplit(['/', '\\']).next())
            .unwrap_or_default()
            .to_owned();
        let command = run["command"].as_array().into_iter().flatten();
        let command: Vec<String> = command.filter_map(Value::as_str).map(str::to_owned).collect();
        let asked = asked_by(&command).and_then(|(path, flags)| {
            let picture = self.id_of_source(path)?;
            Some((picture, flags))
        });
        let (picture, mut flags) = asked.unzip();
        for flag in ["rig", "head", "calibration"] {
            let Some(flags) = &mut flags else { break };
            let value = flags.remove(flag);
            // another one, or none, is there now
            let name = Names::kind_of(flag).zip(value.as_ref().and_then(Value::as_str));
            let name = name.and_then(|(kind, value)| names.name_of(kind, value));
            flags.extend(name.map(|name| (flag.to_owned(), json!(name))));
        }
        run["rig"] = json!(rig_of(&command).map(|rig| names.name_of(Kind::Rigs, rig).unwrap_or(rig)));
        run["mode"] = json!(mode_of(&command));
        run["files"] = json!(self.folder.run_files(&id));
        (run["id"], run["picture"], run["flags"]) = (json!(id), json!(picture), json!(flags));
    }

    /// One run, by its id; `None` where there is none.
    ///
    /// # Errors
    /// What the program says.
    pub(crate) fn run(&self, id: &str) -> Result<Option<Value>, Failure> {
        let runs = self.runs()?;
        Ok(runs["runs"].as_array().into_iter().flatten().find(|run| run["id"] == id).cloned())
    }

    /// Where a run's results are, by its id.
    ///
    /// # Errors
    /// `unreadable` where there is none.
    pub(crate) fn run_dir(&self, id: &str) -> Result<String, Failure> {
        let dir = self.folder.run(id).map(|dir| dir.to_string_lossy().into_owned());
        dir.ok_or_else(|| no_run(id))
    }

    /// Two runs side by side, by their ids.
    ///
    /// # Errors
    /// `unreadable`; what the program says.
    pub(crate) fn compare(&self, first: &str, second: &str) -> Result<Value, Failure> {
        let mut told = self.ask(&["compare", &self.run_dir(first)?, &self.run_dir(second)?, "--json"])?;
        let names = self.names();
        ["first", "second"].into_iter().for_each(|of| self.know(&mut told[of], &names));
        Ok(told)
    }
}
