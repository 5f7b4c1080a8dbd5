//! Which cameras there are, and the command lines by which they are looked through.

use serde_json::{Value, json};
use tracelight_task::{Failure, nearest};

use crate::desk::Desk;
use crate::folder::Kind;
use crate::watch::{AS_PICTURE, SIMULATED};

impl Desk {
    /// All cameras.
    pub(crate) fn cameras(&self) -> Value {
        let simulated = json!({ "id": SIMULATED, "name": "A simulated room", "simulated": true });
        let own = self.program.cameras().into_iter();
        let own = own.map(|camera| json!({ "id": camera.id, "name": camera.name, "simulated": false }));
        json!({ "cameras": std::iter::once(simulated).chain(own).collect::<Vec<_>>() })
    }

    /// The value of `--camera` for a camera's id.
    ///
    /// # Errors
    /// `no-camera` of one that there is not; `unreadable` of a picture on a simulated wall that there is not.
    pub(crate) fn source(&self, id: &str) -> Result<String, Failure> {
        if id == SIMULATED {
            return Ok(SIMULATED.to_owned());
        }
        if let Some(picture) = id.strip_prefix(SIMULATED).and_then(|rest| rest.strip_prefix(':')) {
            return Ok(format!("{SIMULATED}:{}", self.folder.picture_path(picture)?));
        }
        let all = self.program.cameras();
        let found = all.iter().find(|camera| camera.id == id).map(|camera| camera.source.clone());
        found.ok_or_else(|| {
            let names = all.iter().map(|camera| camera.id.as_str()).chain([SIMULATED]);
            let near = nearest(id, names).map_or_else(String::new, |near| format!("; did you mean {near}?"));
            Failure::usage("no-camera", format!("there is no camera {id:?} in the studio{near}; those on the net are named when it is opened: tracelight studio --camera http://…"))
        })
    }

    /// What a page calls what a command line has as its first word behind `trace`: a picture of the folder, or a camera; `None` of what no page can ask for.
    pub(crate) fn id_of_source(&self, word: &str) -> Option<String> {
        let Some(source) = word.strip_prefix("--camera=") else { return self.folder.id_of(word) };
        let id = match source.strip_prefix(SIMULATED) {
            Some("") => SIMULATED.to_owned(),
            Some(rest) if rest.starts_with(':') => format!("{SIMULATED}:{}", self.folder.id_of(&rest[1..])?),
            _ => self.program.cameras().into_iter().find(|camera| camera.source == source)?.id,
        };
        Some(format!("{AS_PICTURE}{id}"))
    }

    /// The command that looks through a camera, holding its images against a calibration unless that has no name.
    fn look_command(&self, id: &str, held: &str) -> Result<Vec<String>, Failure> {
        let mut command = ["calibrate", "look"].map(str::to_owned).to_vec();
        command.push(format!("--camera={}", self.source(id)?));
        if !held.is_empty() {
            let path = self.folder.own(Kind::Cameras, held).ok_or_else(|| {
                Failure::usage("unreadable", format!("there is no calibration {held:?} in the studio"))
            })?;
            command.push(format!("--calibration={}", path.to_string_lossy()));
        }
        Ok(command)
    }

    /// What a camera sees in an image newer than that number; opens it where nobody looks through it yet.
    ///
    /// # Errors
    /// What is wrong with it, or what it fails with.
    pub(crate) async fn look(&self, id: &str, held: &str, after: u64) -> Result<Value, Failure> {
        let command = self.look_command(id, held)?;
        self.watching.look(&self.program, (id, held), command, after).await
    }
}
