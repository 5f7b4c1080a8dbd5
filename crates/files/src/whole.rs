//! Files read and written whole.

use std::io::Read;

use tracelight_task::Failure;

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
        let file = std::fs::File::open(path).map_err(unreadable)?;
        if file.metadata().map_err(unreadable)?.is_dir() {
            return Err(Failure::usage("unreadable", format!("{path} is a folder; give a file in it")));
        }
        file.take(limit).read_to_end(&mut bytes).map_err(unreadable)?;
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

/// Writes a file the user named.
///
/// # Errors
/// `cannot-write`, with what the system says.
pub fn write(path: &str, bytes: impl AsRef<[u8]>) -> Result<(), Failure> {
    std::fs::write(path, bytes).map_err(|e| cannot_write(path, &e))
}

/// Writes what a file holds anew, whole or not at all. What a link leads to is changed, not the link.
///
/// # Errors
/// `cannot-write`, with what the system says; then the file is as it was.
pub fn replace(path: &str, bytes: impl AsRef<[u8]>) -> Result<(), Failure> {
    let real = std::fs::canonicalize(path).map_err(|e| cannot_write(path, &e))?;
    let fresh = format!("{}.{}.new", real.display(), std::process::id());
    write(&fresh, bytes)?;
    std::fs::rename(&fresh, &real).map_err(|e| cannot_write(path, &e))
}

fn cannot_write(path: &str, error: &std::io::Error) -> Failure {
    Failure::failed("cannot-write", format!("cannot write {path}: {error}"))
}

/// Whether two paths lead to one file that exists.
#[must_use]
pub fn is_same(one: &str, other: &str) -> bool {
    let real = |path: &str| std::fs::canonicalize(path).ok();
    real(one).is_some_and(|one| Some(one) == real(other))
}
