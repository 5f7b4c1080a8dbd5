//! Runs that were, as pages show them.

use serde_json::{Value, json};
use tracelight_task::Failure;

use crate::desk::Desk;
use crate::flags::{asked_by, mode_of};
use crate::folder::no_run;
use crate::rig_names::Rigs;

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
        let rigs = self.known_rigs();
        for run in told["runs"].as_array_mut().into_iter().flatten() {
            self.know(run, &rigs);
        }
        Ok(told)
    }

    /// Adds a run's id, its files, and the picture and flags that it was asked by; null where no page can ask so.
    fn know(&self, run: &mut Value, rigs: &Rigs) {
        let id = run["folder"]
            .as_str()
            .and_then(|dir| dir.rsplit(['/', '\\']).next())
            .unwrap_or_default()
            .to_owned();
        let command = run["command"].as_array().into_iter().flatten();
        let command: Vec<String> = command.filter_map(Value::as_str).map(str::to_owned).collect();
        let asked = asked_by(&command).and_then(|(path, flags)| {
            let picture = self.folder.id_of(path)?;
            Some((picture, flags))
        });
        let (picture, mut flags) = asked.unzip();
        if let Some(flags) = &mut flags {
            let rig = flags.remove("rig");
            // another head, or none, is there now
            let name = rig.as_ref().and_then(Value::as_str).and_then(|rig| rigs.name_of(rig));
            flags.extend(name.map(|name| ("rig".to_owned(), json!(name))));
        }
        run["rig"] = json!(rig_of(&command).map(|rig| rigs.name_of(rig).unwrap_or(rig)));
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
        let rigs = self.known_rigs();
        ["first", "second"].into_iter().for_each(|of| self.know(&mut told[of], &rigs));
        Ok(told)
    }
}
