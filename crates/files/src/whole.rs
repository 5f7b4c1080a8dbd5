//! Files read and written whole.

use std::ffi::OsStr;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::Read;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use tracelight_task::Failure;

use crate::inputs::{check_no_input, protect};

/// Largest file that is read, bytes: a picture of 100 megapixels at 16 bit and four channels, uncompressed.
const MOST_BYTES: u64 = 800_000_000;

/// The whole of a file, or of standard input where `path` is `-`, bounded.
///
/// # Errors
/// `unreadable`, `too-large` or `empty-file`, all of them of usage.
pub fn read(path: &str) -> Result<Vec<u8>, Failure> {
    let unreadable = |e: std::io::Error| {
        Failure::usage("unreadable", format!("cannot read {path}: {e}; check the name and the permissions"))
    };
    let mut bytes = Vec::new();
    let limit = MOST_BYTES + 1;
    if path == "-" {
        std::io::stdin().lock().take(limit).read_to_end(&mut bytes).map_err(unreadable)?;
    } else {
        let file = fs::File::open(path).map_err(unreadable)?;
        if file.metadata().map_err(unreadable)?.is_dir() {
            return Err(Failure::usage("unreadable", format!("{path} is a folder; give a file in it")));
        }
        file.take(limit).read_to_end(&mut bytes).map_err(unreadable)?;
        protect(Path::new(path));
    }
    if bytes.len() as u64 > MOST_BYTES {
        let most = MOST_BYTES / 1_000_000;
        return Err(Failure::usage(
            "too-large",
            format!("{path} is larger than {most} MB; give a smaller one"),
        ));
    }
    if bytes.is_empty() {
        return Err(Failure::usage(
            "empty-file",
            format!("{path} is empty; give a file with something in it"),
        ));
    }
    Ok(bytes)
}

/// Writes a file the user named, whole or not at all; into a pipe or a device as it comes. Its folder is made if there is none. What a
/// link leads to is changed, not the link, and who may read a file that was there stays who may.
///
/// # Errors
/// `cannot-write`, with what the system says; `usage` for a file that this process has read. Then a file that was there is as it was.
pub fn write(path: &str, bytes: impl AsRef<[u8]>) -> Result<(), Failure> {
    check_no_input(Path::new(path))?;
    if let Some(folder) = Path::new(path).parent() {
        fs::create_dir_all(folder).map_err(|e| {
            let advice = "name a folder that is there, or that can be made";
            Failure::failed("cannot-write", format!("cannot write {path}: its folder: {e}; {advice}"))
        })?;
    }
    put(path, bytes)
}

fn put(path: &str, bytes: impl AsRef<[u8]>) -> Result<(), Failure> {
    let failed = |e: std::io::Error| cannot_write(path, &e);
    let old = fs::metadata(path).ok();
    if old.as_ref().is_some_and(|old| !old.is_file() && !old.is_dir()) {
        return fs::write(path, bytes).map_err(failed);
    }
    let real =
        if old.is_some() { fs::canonicalize(path).map_err(failed)? } else { Path::new(path).to_owned() };
    // a file may be written by two at once, in one process or several: each has a part of its own
    static PART: AtomicU64 = AtomicU64::new(0);
    let mut part = real.clone().into_os_string();
    part.push(format!(".{}-{}.new", std::process::id(), PART.fetch_add(1, Ordering::Relaxed)));
    renamed_when_whole(part.as_ref(), &real, failed, |part| {
        fs::write(part, bytes).map_err(failed)?;
        old.map_or(Ok(()), |old| fs::set_permissions(part, old.permissions()).map_err(failed))
    })
}

/// Writes what a file holds anew, as [`write`] does, also one that was read.
///
/// # Errors
/// `cannot-write`, with what the system says, also where there is none.
pub fn replace(path: &str, bytes: impl AsRef<[u8]>) -> Result<(), Failure> {
    fs::metadata(path).map_err(|e| cannot_write(path, &e))?;
    put(path, bytes)
}

/// Lets `write` write a file beside `path`, and gives it that name when it is whole: whoever looks sees the old file,
/// the new one, or none, whenever the process ends. The folder is made if there is none.
///
/// # Errors
/// `cannot-write`, what `write` fails with, or `usage` for a file that this process has read; then the old file stands.
pub fn written_whole<T>(path: &Path, write: impl FnOnce(&Path) -> Result<T, Failure>) -> Result<T, Failure> {
    check_no_input(path)?;
    let failed = |e: std::io::Error| {
        let advice = "check the folder, its permissions and the free space";
        Failure::failed("cannot-write", format!("cannot write {}: {e}; {advice}", path.display()))
    };
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    fs::create_dir_all(folder).map_err(failed)?;
    renamed_when_whole(&folder.join(part_name(path)), path, failed, write)
}

/// Lets `write` write `part` and then calls that `path`, or takes it away: no other name is left behind.
pub(crate) fn renamed_when_whole<T>(
    part: &Path,
    path: &Path,
    failed: impl FnOnce(std::io::Error) -> Failure,
    write: impl FnOnce(&Path) -> Result<T, Failure>,
) -> Result<T, Failure> {
    let written = write(part).and_then(|made| {
        fs::rename(part, path).map_err(failed)?;
        Ok(made)
    });
    if written.is_err() {
        drop(fs::remove_file(part)); // it may never have been begun
    }
    written
}

/// The name of a file that is not whole yet: hidden, short even where `path` is not, of the same kind, and the same
/// each time, so that the next run replaces what a killed one left.
pub(crate) fn part_name(path: &Path) -> String {
    let mut hasher = DefaultHasher::new();
    path.file_name().hash(&mut hasher);
    let extension = path.extension().map(OsStr::to_string_lossy).unwrap_or_default();
    format!(".tracelight-part-{:016x}.{extension}", hasher.finish())
}

fn cannot_write(path: &str, error: &std::io::Error) -> Failure {
    Failure::failed("cannot-write", format!("cannot write {path}: {error}"))
}

/// Whether two paths lead to one file that exists.
#[must_use]
pub fn is_same(one: &str, other: &str) -> bool {
    let real = |path: &str| fs::canonicalize(path).ok();
    real(one).is_some_and(|one| Some(one) == real(other))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_written_whole_or_not_at_all() {
        let folder = std::env::temp_dir().join(format!("tracelight-whole-{}", std::process::id()));
        let path = folder.join("below/a.svg");
        written_whole(&path, |part| fs::write(part, "old").map_err(|e| Failure::failed("cannot-write", e)))
            .unwrap();
        let failed = written_whole(&path, |part| -> Result<(), Failure> {
            fs::write(part, "half").unwrap();
            Err(Failure::failed("cannot-write", "the disk is full"))
        });
        assert_eq!(failed.unwrap_err().message, "the disk is full");
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(fs::read_dir(folder.join("below")).unwrap().count(), 1, "the half is gone");
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn what_is_replaced_is_what_a_link_leads_to_and_no_other_file_is_left() {
        let folder = std::env::temp_dir().join(format!("tracelight-replace-{}", std::process::id()));
        let (real, link) = (folder.join("rig.toml"), folder.join("link.toml"));
        fs::create_dir_all(&folder).unwrap();
        fs::write(&real, "old").unwrap();
        std::os::unix::fs::symlink(&real, &link).unwrap();
        replace(&link.to_string_lossy(), "new").unwrap();
        assert_eq!(fs::read_to_string(&real).unwrap(), "new");
        assert!(link.is_symlink());
        // a folder takes no file's name: the rename fails
        let failed = replace(&folder.to_string_lossy(), "new").unwrap_err();
        assert!(failed.message.starts_with(&format!("cannot write {}: ", folder.display())), "{failed:?}");
        let part = folder.with_file_name(format!("tracelight-replace-{0}.{0}.new", std::process::id()));
        assert!(!part.exists(), "the part is gone");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 2, "nothing else lies there");
        fs::remove_dir_all(folder).unwrap();
    }
}
