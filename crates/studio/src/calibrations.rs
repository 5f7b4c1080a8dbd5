//! Calibrations: made by pages, kept in the folder, and chosen by their names where something is planned or traced.

use std::fs;
use std::sync::Arc;

use axum::body::Bytes;
use serde::Deserialize;
use serde_json::{Map, Value, json};
use tracelight_files as files;
use tracelight_task::Failure;

use crate::desk::Desk;
use crate::flags::{named_values, typed};
use crate::folder::Kind;
use crate::names::{KIND, is_own_name};
use crate::tasks::{AtLast, Work, failure_json};

/// What a page has calibrated.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Wanted {
    /// Of what.
    of: Of,
    /// What it is to be called, such as `wall.toml`.
    name: String,
    /// The camera that takes the image.
    #[serde(default)]
    camera: Option<String>,
    /// Images of the folder instead.
    #[serde(default)]
    pictures: Vec<String>,
    #[serde(default)]
    flags: Map<String, Value>,
}

/// Of what.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Of {
    Markers,
    Lens,
    Head,
    Corners,
}

/// Most images of a lens.
const MOST_PICTURES: usize = 40;
/// Flags of pages of markers.
const PRINTED: [&str; 2] = ["paper", "board"];

impl Of {
    /// The command of `calibrate`.
    const fn word(self) -> &'static str {
        match self {
            Self::Markers => "markers",
            Self::Lens => "lens",
            Self::Head => "head",
            Self::Corners => "corners",
        }
    }

    const fn kind(self) -> Kind {
        match self {
            Self::Markers | Self::Lens => Kind::Cameras,
            Self::Head | Self::Corners => Kind::Heads,
        }
    }

    /// Flags that a page may give. None of them names a file but by its name in the folder.
    const fn flags(self) -> &'static [&'static str] {
        match self {
            Self::Markers => &["lens", "bar", "camera_size", "sim_camera", "seed"],
            Self::Lens => &["bar"],
            Self::Head => &[
                "rig",
                "distance",
                "width",
                "height",
                "offset",
                "speed",
                "calibration",
                "sim_camera",
                "home",
                "seed",
            ],
            Self::Corners => {
                &["size", "bottom_left", "bottom_right", "top_right", "top_left", "simulate", "rig", "seed"]
            }
        }
    }
}

impl Wanted {
    /// The camera that is used meanwhile, if one is.
    pub(crate) fn camera(&self) -> Option<&str> {
        self.camera.as_deref()
    }
}

impl Desk {
    /// The command line of a calibration, without where its file goes.
    fn calibration_command(&self, wanted: &Wanted) -> Result<Vec<String>, Failure> {
        let Wanted { of, name, camera, pictures, flags } = wanted;
        if !is_own_name(name) {
            let message = format!(
                "{name:?} is no name of a calibration: letters, digits, - and _, and {KIND} at its end, such as wall.toml"
            );
            return Err(Failure::usage("usage", message));
        }
        if pictures.len() > MOST_PICTURES {
            let message = format!("{} images are more than {MOST_PICTURES}", pictures.len());
            return Err(Failure::usage("usage", message));
        }
        let mut command = vec!["calibrate".to_owned(), of.word().to_owned()];
        command.extend(named_values(flags, |flag| of.flags().contains(&flag), &self.names())?);
        // a head is that of the studio, where the page chooses no other
        if let Some(head) = self.head_of(flags).filter(|_| of.kind() == Kind::Heads) {
            command.push(format!("--rig={}", head.planned_as));
        }
        let looks = matches!(of, Of::Markers | Of::Head);
        match camera.as_ref().filter(|_| looks) {
            Some(camera) => command.push(format!("--camera={}", self.source(camera)?)),
            None if camera.is_some() => {
                let message = format!("calibrate {} asks no camera: leave it out", of.word());
                return Err(Failure::usage("usage", message));
            }
            None => {}
        }
        for id in pictures {
            command.push(self.folder.picture_path(id)?);
        }
        Ok(command)
    }

    /// Calibrates, and keeps what is found under its name; what had that name lies in the trash then.
    ///
    /// # Errors
    /// What is wrong with it; what the program says.
    pub(crate) fn calibrate(&self, wanted: &Wanted, work: Arc<Work>) -> Result<Value, Failure> {
        work.stop.check()?;
        let mut command = self.calibration_command(wanted)?;
        let kind = wanted.of.kind();
        let _last = AtLast(Arc::clone(&work));
        self.begin_experiment(&work);
        let made = self.folder.moment("calibration", work.id, ".toml").to_string_lossy().into_owned();
        command.push(format!("--output={made}"));
        let done = self.program.perform(
            &[&command[..], &["--json".to_owned()]].concat(),
            None,
            (&*work, &work.stop),
        );
        let kept = done.and_then(|done| {
            let before = self.keep(kind, &wanted.name, &made)?;
            Ok((done, before))
        });
        // what cannot be removed is written over another time
        let _ = files::remove_read(std::path::Path::new(&made));
        let (done, before) = kept?;
        // where it lay for a moment is nobody's to know
        let named = |text: &str| text.replace(&made, &wanted.name);
        command.pop();
        command.push(format!("--output={}", wanted.name));
        let answer: Value = serde_json::from_str(&done.json).unwrap_or(Value::Null);
        Ok(json!({
            "command": typed(&command), "answer": answer, "words": named(&done.text), "remarks": work.remarks(),
            "calibration": self.calibration(kind, &wanted.name)?, "replaced": before,
        }))
    }

    /// Puts a file that was made under its name; the name in the trash of what had it before.
    fn keep(&self, kind: Kind, name: &str, made: &str) -> Result<Option<String>, Failure> {
        let _writes = self.writes();
        let place = self.folder.place(kind);
        let failed = |e: std::io::Error| {
            Failure::failed("cannot-write", format!("cannot write {}: {e}", place.join(name).display()))
        };
        fs::create_dir_all(&place).map_err(failed)?;
        let before = match self.folder.own(kind, name) {
            Some(_) => Some(self.folder.discard(kind, name)?),
            None => None,
        };
        fs::rename(made, place.join(name)).map_err(failed)?;
        Ok(before)
    }

    /// All calibrations, with what they say of themselves, or what is wrong with them.
    pub(crate) fn calibrations(&self) -> Value {
        let of = |kind: Kind| -> Vec<Value> {
            let names = self.folder.own_names(kind).into_iter();
            names
                .map(|name| {
                    self.calibration(kind, &name).unwrap_or_else(|failure| {
                        json!({ "name": name, "kind": kind.word(), "problem": failure_json(&failure) })
                    })
                })
                .collect()
        };
        let all = [of(Kind::Cameras), of(Kind::Heads)].concat();
        json!({ "calibrations": all })
    }

    /// What a calibration says of itself.
    fn calibration(&self, kind: Kind, name: &str) -> Result<Value, Failure> {
        let missing =
            || Failure::usage("unreadable", format!("there is no calibration {name:?} in the studio"));
        let path = self.folder.own(kind, name).ok_or_else(missing)?;
        let path = path.to_string_lossy();
        let named = |failure: Failure| Failure { message: failure.message.replace(&*path, name), ..failure };
        let mut told = self.ask(&["calibrate", "show", &path, "--json"]).map_err(named)?;
        let mut told = told["calibrations"][0].take();
        (told["name"], told["kind"], told["problem"]) = (json!(name), json!(kind.word()), Value::Null);
        // by its name it is known
        told.as_object_mut().map(|told| told.remove("file"));
        Ok(told)
    }

    /// Pages of markers to be printed, as PDF.
    ///
    /// # Errors
    /// What is wrong with the flags; what the program says.
    pub(crate) fn printed(&self, flags: &Map<String, Value>) -> Result<Bytes, Failure> {
        let work = self.work();
        let _last = AtLast(Arc::clone(&work));
        let made = self.folder.moment("pages", work.id, ".pdf").to_string_lossy().into_owned();
        let mut command = vec!["calibrate".to_owned(), "sheet".to_owned(), format!("--output={made}")];
        command.extend(named_values(flags, |flag| PRINTED.contains(&flag), &self.names())?);
        command.push("--json".to_owned());
        let done =
            self.program.perform(&command, None, (&*work, &work.stop)).and_then(|_| files::read(&made));
        // what cannot be removed is written over another time
        let _ = files::remove_read(std::path::Path::new(&made));
        Ok(Bytes::from(done?))
    }
}
