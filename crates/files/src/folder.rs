//! A folder with the results of one job.

use std::fs::{self, File};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use tracelight_task::Failure;

use crate::inputs::check_no_input;
use crate::whole::{part_name, renamed_when_whole};

/// Where results of an earlier job lie until those of the next one are whole.
const PREVIOUS: &str = "previous";
/// Most folders of one name.
const MOST_FOLDERS: u32 = 9999;
/// What is locked where a folder itself cannot be.
#[cfg(not(unix))]
const LOCK: &str = ".tracelight-lock";

/// A folder in which one job writes its results, and no other meanwhile.
///
/// Results of an earlier job are put aside when it begins, and taken away when its own are whole: never do files of two jobs lie side by side
/// as if they were one's. Each file gets its name when it is whole, but for one that grows while the job runs; none is written through a link or
/// into a pipe that lies there under its name.
#[derive(Debug)]
pub struct ResultFolder {
    dir: PathBuf,
    /// Held as long as this is.
    _lock: File,
    names: Vec<String>,
}

impl ResultFolder {
    /// Takes a folder over, which is made if it is missing. `names` are those of all results that a job may have, the last written last;
    /// what lies there under them is an earlier job's, and put aside, but for a file that is `kept`. Whatever else lies there stays.
    ///
    /// # Errors
    /// `cannot-write` where the folder cannot be made or written, another job writes to it, or a folder has a result's name; `usage`
    /// where a file that this process has read has one, and is not kept.
    pub fn open(dir: &Path, names: &[&str], kept: Option<&Path>) -> Result<Self, Failure> {
        fs::create_dir_all(dir).map_err(|e| cannot_write(dir, &e))?;
        let lock = locked(dir)?;
        let folder =
            Self { dir: dir.to_owned(), _lock: lock, names: names.iter().map(|&name| name.into()).collect() };
        folder.put_aside(kept)?;
        Ok(folder)
    }

    /// A folder of that name, or the first of `name-2`, `name-3` … that is not there yet, which is made: nothing that was made before is lost.
    ///
    /// # Errors
    /// `cannot-write` where it cannot be made.
    pub fn unused(wanted: &Path) -> Result<PathBuf, Failure> {
        if let Some(parent) = wanted.parent() {
            fs::create_dir_all(parent).map_err(|e| cannot_write(parent, &e))?;
        }
        for number in 1..=MOST_FOLDERS {
            let mut name = wanted.as_os_str().to_owned();
            if number > 1 {
                name.push(format!("-{number}"));
            }
            let dir = PathBuf::from(name);
            match fs::create_dir(&dir) {
                Ok(()) => return Ok(dir),
                Err(e) if e.kind() == ErrorKind::AlreadyExists => {}
                Err(e) => return Err(cannot_write(&dir, &e)),
            }
        }
        let message = format!(
            "{0} and {0}-2 to {0}-{MOST_FOLDERS} are there: take some away, or give --out",
            wanted.display()
        );
        Err(Failure::failed("cannot-write", message))
    }

    /// `out/house` of `out/house-2`, where both are there: the next one is `out/house-3`.
    #[must_use]
    pub fn unnumbered(dir: &Path) -> PathBuf {
        let name = dir.file_name().unwrap_or_default().to_string_lossy();
        let first = name
            .rsplit_once('-')
            .filter(|(_, number)| number.bytes().all(|digit| digit.is_ascii_digit()))
            .map(|(name, _)| dir.with_file_name(name));
        first.filter(|first| first.is_dir()).unwrap_or_else(|| dir.to_owned())
    }

    /// Keeps jobs out of a folder for as long as what is returned lives.
    ///
    /// # Errors
    /// `cannot-write` where one writes there at present.
    pub fn hold(dir: &Path) -> Result<impl Sized + use<>, Failure> {
        locked(dir)
    }

    /// Where a result of that name is, or will be.
    #[must_use]
    pub fn path(&self, name: &str) -> PathBuf {
        self.dir.join(name)
    }

    /// The folder.
    #[must_use]
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Begins a result that grows under its own name.
    ///
    /// # Errors
    /// `cannot-write`, also where something lies there under that name.
    pub fn begin(&self, name: &str) -> Result<File, Failure> {
        let path = self.path(name);
        File::options()
            .read(true)
            .write(true)
            .create_new(true)
            .open(&path)
            .map_err(|e| cannot_write(&path, &e))
    }

    /// Writes a result, whole or not at all.
    ///
    /// # Errors
    /// `cannot-write`.
    pub fn put(&self, name: &str, bytes: impl AsRef<[u8]>) -> Result<(), Failure> {
        self.put_by(name, |file| file.write_all(bytes.as_ref()))
    }

    /// Lets `write` write a result, which gets its name when it is whole.
    ///
    /// # Errors
    /// `cannot-write`, with what the system says.
    pub fn put_by(
        &self,
        name: &str,
        write: impl FnOnce(&mut File) -> std::io::Result<()>,
    ) -> Result<(), Failure> {
        let path = self.path(name);
        let part = self.dir.join(part_name(&path));
        let failed = |e: std::io::Error| cannot_write(&path, &e);
        renamed_when_whole(&part, &path, failed, |part| {
            gone(part)
                .and_then(|()| File::create_new(part))
                .and_then(|mut file| write(&mut file))
                .map_err(failed)
        })
    }

    /// Asks the disk to keep a result and its name, also through a power cut. A file system that cannot has nothing better.
    pub fn keep(&self, name: &str) {
        let synced = File::open(self.path(name)).and_then(|file| file.sync_all());
        drop(synced.and_then(|()| File::open(&self.dir)?.sync_all()));
    }

    /// The job's results are whole: those of the earlier one are taken away.
    ///
    /// # Errors
    /// `cannot-write`; then they stay, and those of the job are whole all the same.
    pub fn finish(self) -> Result<(), Failure> {
        let previous = self.dir.join(PREVIOUS);
        self.forget(&previous)
    }

    /// Moves results of an earlier job into a folder of their own; what an even earlier one left there goes.
    fn put_aside(&self, kept: Option<&Path>) -> Result<(), Failure> {
        let previous = self.dir.join(PREVIOUS);
        let kept = kept.and_then(|path| fs::canonicalize(path).ok());
        let lies = |name: &&String| fs::symlink_metadata(self.path(name)).is_ok();
        let is_kept = |name: &str| kept.is_some() && fs::canonicalize(self.path(name)).ok() == kept;
        let old: Vec<&String> = self.names.iter().filter(lies).filter(|name| !is_kept(name)).collect();
        if let Some(folder) =
            old.iter().map(|name| self.path(name)).find(|path| path.is_dir() && !path.is_symlink())
        {
            let message = format!(
                "cannot write {0}: {0} is a folder; choose another one with --out, or call that otherwise",
                folder.display()
            );
            return Err(Failure::failed("cannot-write", message));
        }
        old.iter().try_for_each(|name| check_no_input(&self.path(name)))?;
        if old.is_empty() {
            return Ok(());
        }
        self.forget(&previous)?;
        fs::create_dir_all(&previous).map_err(|e| cannot_write(&previous, &e))?;
        old.into_iter().try_for_each(|name| {
            let path = self.path(name);
            fs::rename(&path, previous.join(name)).map_err(|e| cannot_write(&path, &e))
        })
    }

    /// Takes results away from a folder, and the folder where nothing else lies in it.
    fn forget(&self, previous: &Path) -> Result<(), Failure> {
        for name in &self.names {
            let path = previous.join(name);
            gone(&path).map_err(|e| cannot_write(&path, &e))?;
        }
        // somebody's own files may lie there
        drop(fs::remove_dir(previous));
        Ok(())
    }
}

/// Takes a file away that need not be there.
fn gone(path: &Path) -> std::io::Result<()> {
    match fs::remove_file(path) {
        Err(e) if !matches!(e.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => Err(e),
        _ => Ok(()),
    }
}

/// The folder itself, locked, so that no file is left of it.
#[cfg(unix)]
fn lockable(dir: &Path) -> std::io::Result<File> {
    File::open(dir)
}

#[cfg(not(unix))]
fn lockable(dir: &Path) -> std::io::Result<File> {
    File::options().create(true).append(true).open(dir.join(LOCK))
}

fn locked(dir: &Path) -> Result<File, Failure> {
    let lock = lockable(dir).map_err(|e| cannot_write(dir, &e))?;
    match lock.try_lock() {
        Err(fs::TryLockError::WouldBlock) => {
            let message = format!(
                "another job is writing to {}; wait for its end, or choose another folder with --out",
                dir.display()
            );
            Err(Failure::failed("cannot-write", message))
        }
        // where there are no locks it goes without
        Ok(()) | Err(fs::TryLockError::Error(_)) => Ok(lock),
    }
}

fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    Failure::failed(
        "cannot-write",
        format!(
            "cannot write {}: {error}; check the folder, its permissions and the free space, or choose another with --out",
            path.display()
        ),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: [&str; 3] = ["run.mcap", "report.html", "summary.json"];

    fn folder(name: &str) -> PathBuf {
        let dir = std::env::temp_dir().join(format!("tracelight-folder-{name}-{}", std::process::id()));
        drop(fs::remove_dir_all(&dir));
        dir
    }

    fn names_in(dir: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(dir)
            .unwrap()
            .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn results_of_two_jobs_never_lie_side_by_side() {
        let dir = folder("two");
        let first = ResultFolder::open(&dir, &NAMES, None).unwrap();
        NAMES.iter().for_each(|name| first.put(name, "first").unwrap());
        fs::write(dir.join("notes.txt"), "mine").unwrap();
        first.finish().unwrap();
        assert_eq!(names_in(&dir), ["notes.txt", "report.html", "run.mcap", "summary.json"]);
        // a job that is killed after its first file
        let second = ResultFolder::open(&dir, &NAMES, None).unwrap();
        assert_eq!(names_in(&dir), ["notes.txt", PREVIOUS]);
        second.begin("run.mcap").unwrap().write_all(b"half").unwrap();
        drop(second);
        assert_eq!(names_in(&dir), ["notes.txt", PREVIOUS, "run.mcap"]);
        assert_eq!(names_in(&dir.join(PREVIOUS)), ["report.html", "run.mcap", "summary.json"]);
        // what it left is put aside in its turn, and goes when the next job is whole
        let third = ResultFolder::open(&dir, &NAMES, None).unwrap();
        assert_eq!(names_in(&dir.join(PREVIOUS)), ["run.mcap"]);
        assert_eq!(fs::read(dir.join(PREVIOUS).join("run.mcap")).unwrap(), b"half");
        third.put("summary.json", "third").unwrap();
        third.finish().unwrap();
        assert_eq!(names_in(&dir), ["notes.txt", "summary.json"]);
        fs::remove_dir_all(dir).unwrap();
    }

    #[test]
    fn a_folder_has_one_job_at_a_time() {
        let dir = folder("one");
        let mine = ResultFolder::open(&dir, &NAMES, None).unwrap();
        mine.put("report.html", "mine").unwrap();
        let error = ResultFolder::open(&dir, &NAMES, None).unwrap_err();
        assert!(error.message.contains("another job is writing to"), "{}", error.message);
        assert_eq!(names_in(&dir), ["report.html"], "nothing was touched");
        drop(mine);
        ResultFolder::open(&dir, &NAMES, None).unwrap();
        fs::remove_dir_all(dir).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn nothing_is_written_through_a_link_and_a_folder_with_a_results_name_is_told_before_the_work() {
        let dir = folder("links");
        fs::create_dir_all(&dir).unwrap();
        let victim = dir.join("victim");
        fs::write(&victim, "precious").unwrap();
        std::os::unix::fs::symlink(&victim, dir.join("run.mcap")).unwrap();
        let results = ResultFolder::open(&dir, &NAMES, None).unwrap();
        results.begin("run.mcap").unwrap().write_all(b"log").unwrap();
        std::os::unix::fs::symlink(&victim, dir.join("report.html")).unwrap();
        results.put("report.html", "page").unwrap();
        assert_eq!(fs::read_to_string(&victim).unwrap(), "precious");
        assert!(!dir.join("report.html").is_symlink());
        drop(results);
        fs::create_dir(dir.join("summary.json")).unwrap();
        let error = ResultFolder::open(&dir, &NAMES, None).unwrap_err();
        assert!(error.message.contains("summary.json is a folder"), "{}", error.message);
        fs::remove_dir_all(dir).unwrap();
    }

    #[test]
    fn a_file_that_the_job_was_given_stays() {
        let dir = folder("kept");
        fs::create_dir_all(&dir).unwrap();
        let rig = dir.join("run.mcap");
        fs::write(&rig, "given").unwrap();
        fs::write(dir.join("report.html"), "old").unwrap();
        drop(ResultFolder::open(&dir, &NAMES, Some(&rig)).unwrap());
        assert_eq!(names_in(&dir), [PREVIOUS, "run.mcap"]);
        fs::remove_dir_all(dir).unwrap();
    }

    #[test]
    fn what_fails_half_way_leaves_nothing() {
        let dir = folder("half");
        let results = ResultFolder::open(&dir, &NAMES, None).unwrap();
        let failed = results.put_by("report.html", |file| {
            file.write_all(b"half")?;
            Err(std::io::Error::other("the disk is full"))
        });
        assert!(failed.unwrap_err().message.contains("report.html: the disk is full"));
        assert!(names_in(&dir).is_empty());
        fs::remove_dir_all(dir).unwrap();
    }
}
