//! Rig files, read and written by pages: what is in them, and what is wrong with what somebody writes.

use std::fs;

use serde::Deserialize;
use serde_json::{Value, json};
use tracelight_files as files;
use tracelight_task::Failure;

use crate::desk::Desk;
use crate::folder::Kind;
use crate::names::{KIND, Names, is_own_name};
use crate::tasks::failure_json;

/// Longest rig file, bytes.
const MOST_BYTES: usize = 48 << 10;

/// What somebody writes into a rig file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Written {
    toml: String,
    /// Whether it is looked at only, and nothing is kept.
    #[serde(default)]
    only_check: bool,
    /// What the file said when it was read, empty where there was none: what says something else by now is somebody else's work, and stays.
    #[serde(default)]
    before: Option<String>,
}

impl Desk {
    /// Rigs, calibrations and heads that a page may choose.
    pub(crate) fn names(&self) -> Names {
        let own = |kind| self.folder.own_files(kind);
        Names {
            presets: self.program.rigs(),
            rigs: own(Kind::Rigs),
            cameras: own(Kind::Cameras),
            heads: own(Kind::Heads),
        }
    }

    /// All rigs: presets with what they are, and files of the folder with what is wrong with them, if anything.
    ///
    /// # Errors
    /// What the program says.
    pub(crate) fn rigs(&self) -> Result<Value, Failure> {
        let told = self.ask(&["rigs", "--json"])?;
        let presets = told["rigs"].as_array().into_iter().flatten();
        let presets = presets.map(|rig| json!({ "name": rig["name"], "own": false, "description": rig["description"], "problem": null }));
        let own = self.folder.own_names(Kind::Rigs).into_iter().filter_map(|name| {
            let text = fs::read_to_string(self.folder.own(Kind::Rigs, &name)?).ok()?;
            let problem = self.checked(&name, &text).err().as_ref().map(failure_json);
            Some(json!({ "name": name, "own": true, "description": "", "problem": problem }))
        });
        Ok(json!({ "rigs": presets.chain(own).collect::<Vec<Value>>() }))
    }

    /// What a rig file says, or would: of a preset as the program prints it.
    ///
    /// # Errors
    /// `unreadable` where there is none; what the program says.
    pub(crate) fn rig_text(&self, name: &str) -> Result<Value, Failure> {
        if let Some(path) = self.folder.own(Kind::Rigs, name) {
            let text = String::from_utf8_lossy(&files::read(&path.to_string_lossy())?).into_owned();
            return Ok(json!({ "name": name, "own": true, "toml": text }));
        }
        if !self.program.rigs().iter().any(|preset| preset == name) {
            return Err(Failure::usage("unreadable", format!("there is no rig {name:?} in the studio")));
        }
        let told = self.ask(&["rigs", "show", name, "--json", "--quiet"])?;
        Ok(json!({ "name": name, "own": false, "toml": told["toml"] }))
    }

    /// Looks whether a text is a rig file, and keeps it under that name unless it is only looked at.
    ///
    /// # Errors
    /// `usage` of a name that none has; `rig-file` with line and column; `busy` where it says something else than what it is to replace; `cannot-write`.
    pub(crate) fn write_rig(&self, name: &str, written: &Written) -> Result<Value, Failure> {
        if !is_own_name(name) {
            return Err(Failure::usage(
                "usage",
                format!(
                    "{name:?} is no name of a rig file: letters, digits, - and _, and {KIND} at its end, such as garage.toml"
                ),
            ));
        }
        if written.toml.len() > MOST_BYTES {
            let message = format!("{name} would be longer than {} kB", MOST_BYTES >> 10);
            return Err(Failure::usage("rig-file", message));
        }
        let remarks = self.checked(name, &written.toml)?;
        if !written.only_check {
            // one at a time: what was there is looked at, and then replaced
            let _writes = self.writes();
            let path = self.folder.place(Kind::Rigs).join(name);
            let is = fs::read_to_string(&path).unwrap_or_default();
            if written.before.as_ref().is_some_and(|before| *before != is) {
                let message = if written.before.as_deref() == Some("") {
                    format!("there is a rig {name} already: give the new one another name")
                } else {
                    format!(
                        "{name} was changed elsewhere since it was read: copy what you wrote, read it again, and put it in"
                    )
                };
                return Err(Failure::failed("busy", message));
            }
            fs::create_dir_all(self.folder.place(Kind::Rigs)).map_err(|e| {
                Failure::failed("cannot-write", format!("cannot write {}: {e}", path.display()))
            })?;
            let to = path.to_string_lossy();
            // one that is there was read by what was planned with it
            let write = if path.exists() { files::replace } else { files::write };
            write(&to, &written.toml)?;
        }
        Ok(json!({ "name": name, "kept": !written.only_check, "remarks": remarks }))
    }

    /// Reads a text as a rig file of that name; what is to be remarked.
    fn checked(&self, name: &str, text: &str) -> Result<Vec<String>, Failure> {
        let work = self.work();
        let path = self.folder.moment("rig", work.id, ".toml").to_string_lossy().into_owned();
        files::write(&path, text)?;
        let command = ["rigs", "show", &path, "--json"].map(str::to_owned);
        let read = self.program.perform(&command, None, (&*work, &work.stop));
        // what cannot be removed is written over another time
        let _ = files::remove_read(std::path::Path::new(&path));
        let named = |text: &str| text.replace(&path, name);
        match read {
            Ok(_) => Ok(work.remarks().iter().map(|remark| named(remark)).collect()),
            Err(failure) => Err(Failure { message: named(&failure.message), ..failure }),
        }
    }
}
