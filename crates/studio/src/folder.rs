//! The studio's folder: pictures that were given to it, the runs made of them, and files of rigs, cameras and heads.

use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde_json::{Value, json};
use tracelight_files as files;
use tracelight_task::Failure;

/// Largest picture that is taken, bytes.
pub(crate) const MOST_BYTES: usize = 64 << 20;
/// How a picture's name may end.
const KINDS: [(&str, &str); 15] = [
    ("png", "image/png"),
    ("jpg", "image/jpeg"),
    ("jpeg", "image/jpeg"),
    ("webp", "image/webp"),
    ("bmp", "image/bmp"),
    ("gif", "image/gif"),
    ("svg", "image/svg+xml"),
    ("pnm", "image/x-portable-anymap"),
    ("pgm", "image/x-portable-graymap"),
    ("ppm", "image/x-portable-pixmap"),
    ("tif", "image/tiff"),
    ("tiff", "image/tiff"),
    ("dxf", "application/octet-stream"),
    // what it is nobody has looked at
    ("json", "application/octet-stream"),
    ("csv", "text/csv"),
];
/// Those that browsers show.
const SHOWN: [&str; 7] = ["png", "jpg", "jpeg", "webp", "bmp", "gif", "svg"];
/// What of a run a page may show.
const RUN_KINDS: [(&str, &str); 8] = [
    ("html", "text/html; charset=utf-8"),
    ("png", "image/png"),
    ("svg", "image/svg+xml"),
    ("json", "application/json"),
    ("csv", "text/csv"),
    ("jpg", "image/jpeg"),
    ("toml", "text/plain; charset=utf-8"),
    ("mcap", "application/octet-stream"),
];
/// Where what was deleted lies, until somebody empties it.
const TRASH: &str = "trash";
/// Longest name of a picture, without its end.
const MOST_LETTERS: usize = 60;

/// What the program brings along.
pub(crate) const EXAMPLES: [(&str, &[u8]); 6] = [
    ("house.png", include_bytes!("../../../examples/house.png")),
    ("star.png", include_bytes!("../../../examples/star.png")),
    ("chalk.png", include_bytes!("../../../examples/chalk.png")),
    ("handwriting.png", include_bytes!("../../../examples/handwriting.png")),
    ("sign.svg", include_bytes!("../../../examples/sign.svg")),
    ("wall.dxf", include_bytes!("../../../examples/wall.dxf")),
];

/// A folder in which everything lies that a page shows.
#[derive(Clone, Debug)]
pub(crate) struct Folder {
    dir: PathBuf,
}

impl Folder {
    /// Makes it where it is not there, and puts the examples in.
    ///
    /// # Errors
    /// `cannot-write`.
    pub(crate) fn open(dir: &Path) -> Result<Self, Failure> {
        // from the root: no name of it is taken for a flag
        let dir = std::path::absolute(dir).map_err(|e| cannot_write(dir, &e))?;
        let folder = Self { dir };
        for part in [Kind::Pictures, Kind::Runs, Kind::Rigs, Kind::Cameras, Kind::Heads]
            .map(|kind| folder.place(kind))
        {
            fs::create_dir_all(&part).map_err(|e| cannot_write(&part, &e))?;
        }
        for (name, bytes) in EXAMPLES {
            if !folder.pictures().join(name).exists() {
                files::write(&folder.pictures().join(name).to_string_lossy(), bytes)?;
            }
        }
        Ok(folder)
    }

    pub(crate) fn dir(&self) -> &Path {
        &self.dir
    }

    /// Where what is of a kind lies.
    pub(crate) fn place(&self, kind: Kind) -> PathBuf {
        self.dir.join(kind.word())
    }

    fn pictures(&self) -> PathBuf {
        self.place(Kind::Pictures)
    }

    pub(crate) fn runs(&self) -> PathBuf {
        self.place(Kind::Runs)
    }

    /// Takes a picture in; its id. One of the same name and other bytes keeps its place.
    ///
    /// # Errors
    /// `not-a-picture` by its name; `cannot-write`.
    pub(crate) fn add(&self, name: &str, bytes: &[u8]) -> Result<String, Failure> {
        let (stem, kind) = parted(name).ok_or_else(|| {
            let known: Vec<&str> = KINDS.iter().map(|(kind, _)| *kind).collect();
            Failure::usage(
                "not-a-picture",
                format!("{name:?} does not end as a picture or a drawing does: {}", known.join(", ")),
            )
        })?;
        if bytes.is_empty() {
            return Err(Failure::usage("not-a-picture", format!("{name} is empty")));
        }
        for number in 1..=9999 {
            let id = if number == 1 { format!("{stem}.{kind}") } else { format!("{stem}-{number}.{kind}") };
            match fs::read(self.pictures().join(&id)) {
                Ok(there) if there == bytes => return Ok(id),
                Ok(_) => {}
                Err(_) => match self.put(&id, bytes) {
                    // somebody else took the name meanwhile
                    Err(e) if e.kind() == std::io::ErrorKind::AlreadyExists => {}
                    put => {
                        return put
                            .map(|()| id.clone())
                            .map_err(|e| cannot_write(&self.pictures().join(id), &e));
                    }
                },
            }
        }
        Err(Failure::failed(
            "cannot-write",
            format!("there are too many pictures of the name {stem}: delete some"),
        ))
    }

    /// Writes a picture that is not there yet.
    fn put(&self, id: &str, bytes: &[u8]) -> std::io::Result<()> {
        std::io::Write::write_all(&mut fs::File::create_new(self.pictures().join(id))?, bytes)
    }

    /// A place for what lies there for a moment, of this process alone: a plan's table, a draft, what a command makes; `ending` as a file's name has it, empty of a folder.
    pub(crate) fn moment(&self, what: &str, number: u64, ending: &str) -> PathBuf {
        self.dir.join(format!(".{what}-{}-{number}{ending}", std::process::id()))
    }

    /// Where a picture lies; `None` where there is none of that id.
    pub(crate) fn picture(&self, id: &str) -> Option<PathBuf> {
        let (stem, kind) = parted(id)?;
        let path = self.pictures().join(id);
        (id == format!("{stem}.{kind}") && path.is_file()).then_some(path)
    }

    /// Where a picture lies.
    ///
    /// # Errors
    /// `unreadable` where there is none of that id.
    pub(crate) fn picture_path(&self, id: &str) -> Result<String, Failure> {
        let path = self.picture(id).map(|path| path.to_string_lossy().into_owned());
        let missing =
            || Failure::usage("unreadable", format!("there is no picture {id:?} in the studio's folder"));
        path.ok_or_else(missing)
    }

    /// The id of a picture by its path; `None` of one that lies elsewhere, or is gone.
    pub(crate) fn id_of(&self, path: &str) -> Option<String> {
        let id = Path::new(path).file_name()?.to_str()?;
        (self.picture(id)? == Path::new(path)).then(|| id.to_owned())
    }

    /// A picture's file, opened, and its type.
    pub(crate) fn picture_file(&self, id: &str) -> Option<(fs::File, &'static str)> {
        let (_, kind) = parted(id)?;
        let of_kind = KINDS.iter().find(|(known, _)| *known == kind)?.1;
        Some((fs::File::open(self.picture(id)?).ok()?, of_kind))
    }

    /// All pictures: those that were given to it, the newest first, and the examples.
    pub(crate) fn listed(&self) -> Value {
        let entries = fs::read_dir(self.pictures()).into_iter().flatten().flatten();
        let mut all: Vec<_> = entries
            .filter_map(|entry| {
                let id = entry.file_name().into_string().ok()?;
                let (_, kind) = parted(&id)?;
                // what was put there under another name than a page can ask for
                self.picture(&id)?;
                let when = entry.metadata().and_then(|meta| meta.modified()).ok()?;
                let example = EXAMPLES.iter().position(|(name, _)| *name == id);
                let told = json!({ "id": id, "example": example.is_some(), "shows": SHOWN.contains(&kind.as_str()) });
                Some((example, std::cmp::Reverse(when), told))
            })
            .collect();
        // examples have no time that says anything
        all.sort_by_key(|(example, when, _)| (*example, example.map_or(Some(*when), |_| None)));
        all.into_iter().map(|(_, _, picture)| picture).collect()
    }

    /// Where the run of a picture goes.
    ///
    /// # Errors
    /// `cannot-write`.
    pub(crate) fn begin_run(&self, picture: &str) -> Result<(String, PathBuf), Failure> {
        let stem = parted(picture).map_or_else(|| "run".to_owned(), |(stem, _)| stem);
        // a name is given once: runs that go on with another know it by that
        let numbers = [self.runs(), self.trash(Kind::Runs)];
        let names = numbers.iter().filter_map(|dir| fs::read_dir(dir).ok()).flatten().flatten();
        let names = names.filter_map(|entry| entry.file_name().into_string().ok());
        let last = names.filter_map(|name| number_of(&name, &stem)).max().unwrap_or(0);
        for number in (last + 1..).take(1000) {
            let id = if number == 1 { stem.clone() } else { format!("{stem}-{number}") };
            let dir = self.runs().join(&id);
            match fs::create_dir(&dir) {
                Ok(()) => return Ok((id, dir)),
                Err(e) if e.kind() == std::io::ErrorKind::AlreadyExists => {}
                Err(e) => return Err(cannot_write(&dir, &e)),
            }
        }
        Err(Failure::failed(
            "cannot-write",
            format!("there are too many runs of the name {stem}: delete some"),
        ))
    }

    /// Where what was deleted of a kind lies.
    fn trash(&self, kind: Kind) -> PathBuf {
        self.dir.join(TRASH).join(kind.word())
    }

    /// Removes the folder of a run in which nothing was written.
    pub(crate) fn drop_empty(&self, dir: &Path) {
        // one that holds something stays
        let _ = fs::remove_dir(dir);
    }

    /// A run's folder; `None` where there is none of that id.
    pub(crate) fn run(&self, id: &str) -> Option<PathBuf> {
        let dir = self.runs().join(id);
        (is_plain(id) && dir.is_dir()).then_some(dir)
    }

    /// A file of a run, opened, with its type; `None` where there is none that a page may show.
    pub(crate) fn run_file(&self, run: &str, name: &str) -> Option<(fs::File, &'static str)> {
        let of_kind = run_kind(name)?;
        let path = self.run(run)?.join(name);
        // links lead out of the folder
        let is_own = is_plain(name) && fs::symlink_metadata(&path).is_ok_and(|meta| meta.is_file());
        Some((is_own.then(|| fs::File::open(path).ok())??, of_kind))
    }

    /// Names and bytes of a run's files that a page may show.
    pub(crate) fn run_files(&self, run: &str) -> Vec<Value> {
        let entries = self.run(run).and_then(|dir| fs::read_dir(dir).ok());
        let told = |entry: fs::DirEntry| {
            let name = entry.file_name().into_string().ok()?;
            let meta = entry.metadata().ok().filter(fs::Metadata::is_file)?;
            (is_plain(&name) && run_kind(&name).is_some())
                .then(|| json!({ "name": name, "bytes": meta.len() }))
        };
        let mut all: Vec<Value> = entries.into_iter().flatten().flatten().filter_map(told).collect();
        all.sort_by_key(|file| file["name"].as_str().map(str::to_owned));
        all
    }

    /// Puts a run or a picture into the trash; the name by which it is taken out again.
    ///
    /// # Errors
    /// `unreadable` where there is none; `busy` while a run is written; `usage` of an example, which would come back; `cannot-write`.
    pub(crate) fn discard(&self, kind: Kind, id: &str) -> Result<String, Failure> {
        let found = match kind {
            Kind::Runs => self.run(id),
            Kind::Pictures => self.picture(id),
            Kind::Rigs | Kind::Cameras | Kind::Heads => self.own(kind, id),
        };
        let Some(path) = found else {
            return Err(Failure::usage(
                "unreadable",
                format!("there is no {id:?} among the studio's {}", kind.word()),
            ));
        };
        if kind == Kind::Pictures && EXAMPLES.iter().any(|(name, _)| *name == id) {
            return Err(Failure::usage(
                "usage",
                format!("{id} is an example: it would be there again at the next start"),
            ));
        }
        if kind == Kind::Runs && files::ResultFolder::hold(&path).is_err() {
            return Err(Failure::failed(
                "busy",
                format!("{id} is being written: stop it, or wait until it is done"),
            ));
        }
        let trash = self.trash(kind);
        fs::create_dir_all(&trash).map_err(|e| cannot_write(&trash, &e))?;
        for number in 1..=9999 {
            let name = if number == 1 { id.to_owned() } else { format!("{id}~{number}") };
            if !trash.join(&name).exists() {
                return fs::rename(&path, trash.join(&name))
                    .map(|()| name)
                    .map_err(|e| cannot_write(&path, &e));
            }
        }
        Err(Failure::failed("cannot-write", format!("{} is full: empty it", trash.display())))
    }

    /// Takes something out of the trash again; its id.
    ///
    /// # Errors
    /// `unreadable` where it is not there; `busy` where another one has its place now; `cannot-write`.
    pub(crate) fn restore(&self, kind: Kind, name: &str) -> Result<String, Failure> {
        let id = name.split('~').next().unwrap_or_default();
        let from = self.trash(kind).join(name);
        let is_own = is_plain(id) && name.chars().all(|c| c == '~' || is_letter(c));
        if !is_own || !from.exists() {
            return Err(Failure::usage("unreadable", format!("there is no {name:?} in the studio's trash")));
        }
        let to = self.place(kind).join(id);
        // its place is taken first, so that nobody's newer one gives way
        let taken = match kind {
            Kind::Runs => fs::create_dir(&to),
            Kind::Pictures | Kind::Rigs | Kind::Cameras | Kind::Heads => fs::File::create_new(&to).map(drop),
        };
        match taken.and_then(|()| fs::rename(&from, &to)) {
            Ok(()) => Ok(id.to_owned()),
            Err(e) if e.kind() == std::io::ErrorKind::AlreadyExists => Err(Failure::failed(
                "busy",
                format!("there is another {id} now: what is in the trash stays there"),
            )),
            Err(e) => Err(cannot_write(&to, &e)),
        }
    }
}

/// What is told of a run that there is not.
pub(crate) fn no_run(id: &str) -> Failure {
    Failure::usage("unreadable", format!("there is no run {id:?} in the studio's folder"))
}

/// What lies in the folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Kind {
    Pictures,
    Runs,
    Rigs,
    Cameras,
    Heads,
}

impl Kind {
    pub(crate) const fn word(self) -> &'static str {
        match self {
            Self::Pictures => "pictures",
            Self::Runs => "runs",
            Self::Rigs => "rigs",
            Self::Cameras => "cameras",
            Self::Heads => "heads",
        }
    }
}

/// Whether a name is one of this folder alone: nothing that leads elsewhere, and no hidden one.
pub(crate) fn is_plain(name: &str) -> bool {
    !name.is_empty() && !name.starts_with('.') && name.chars().all(is_letter)
}

/// The number of a run of that name, such as 2 of `house-2`, 1 of `house`, also as it lies in the trash; `None` of another name.
fn number_of(run: &str, stem: &str) -> Option<u32> {
    let rest = run.split('~').next()?.strip_prefix(stem)?;
    if rest.is_empty() { Some(1) } else { rest.strip_prefix('-')?.parse().ok() }
}

fn is_letter(c: char) -> bool {
    c.is_ascii_alphanumeric() || "-_.".contains(c)
}

fn run_kind(name: &str) -> Option<&'static str> {
    let (_, kind) = name.rsplit_once('.')?;
    RUN_KINDS.iter().find(|(known, _)| *known == kind).map(|(_, of_kind)| *of_kind)
}

/// A name without folders as letters, digits, - and _, and how it ends; `None` of what ends as no picture does.
fn parted(name: &str) -> Option<(String, String)> {
    let name = name.rsplit(['/', '\\']).next()?;
    let (stem, kind) = name.rsplit_once('.')?;
    let kind = kind.to_ascii_lowercase();
    KINDS.iter().find(|(known, _)| *known == kind)?;
    let plain = |c: char| if c.is_ascii_alphanumeric() || c == '-' || c == '_' { c } else { '-' };
    let stem: String = stem.chars().map(plain).take(MOST_LETTERS).collect();
    let stem = stem.trim_matches('-');
    Some((if stem.is_empty() { "picture".to_owned() } else { stem.to_owned() }, kind))
}

fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    Failure::failed(
        "cannot-write",
        format!("cannot write {}: {error}; check the name and the permissions", path.display()),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_without_folders_and_end_as_pictures_do() {
        let named = |name: &str| parted(name).map(|(stem, kind)| format!("{stem}.{kind}"));
        assert_eq!(named("My house (2).PNG").as_deref(), Some("My-house--2.png"));
        assert_eq!(named("../../etc/passwd.svg").as_deref(), Some("passwd.svg"));
        assert_eq!(named(r"C:\x\y.dxf").as_deref(), Some("y.dxf"));
        assert_eq!(named("....png").as_deref(), Some("picture.png"));
        assert_eq!(named("passwd"), None);
        assert_eq!(named("x.sh"), None);
    }
}
