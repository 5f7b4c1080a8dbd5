//! Files that this process has read: no result takes the place of one.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use tracelight_task::Failure;

/// Real paths. One list for the whole process: whichever part of a command reads a file, no other part may write over it.
static INPUTS: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Protects a file that the user named as an input. What is no file, such as a pipe or a device, is left alone.
pub fn protect(path: &Path) {
    let is_file = fs::metadata(path).is_ok_and(|of| of.is_file());
    if let (true, Ok(real)) = (is_file, fs::canonicalize(path)) {
        INPUTS.lock().unwrap_or_else(PoisonError::into_inner).insert(real);
    }
}

/// Removes a file that was made to be read once, and is nobody's: another one of its name may be written.
///
/// # Errors
/// What the system says.
pub fn remove_read(path: &Path) -> std::io::Result<()> {
    if let Ok(real) = fs::canonicalize(path) {
        INPUTS.lock().unwrap_or_else(PoisonError::into_inner).remove(&real);
    }
    fs::remove_file(path)
}

/// The files that this process has read, by their real paths.
#[must_use]
pub fn inputs() -> Vec<PathBuf> {
    INPUTS.lock().unwrap_or_else(PoisonError::into_inner).iter().cloned().collect()
}

/// Refuses to write where an input lies, by whatever name or link it was read.
///
/// # Errors
/// `usage`, with what to do.
pub(crate) fn check_no_input(path: &Path) -> Result<(), Failure> {
    let Ok(real) = fs::canonicalize(path) else { return Ok(()) };
    match INPUTS.lock().unwrap_or_else(PoisonError::into_inner).contains(&real) {
        true => {
            let path = path.display();
            let message = format!(
                "{path} is read by this command and would be overwritten: give the result another name or folder"
            );
            Err(Failure::usage("usage", message))
        }
        false => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::whole::{read, replace, write, written_whole};

    #[test]
    fn what_was_read_is_not_written_over_by_any_name() {
        let folder = std::env::temp_dir().join(format!("tracelight-inputs-{}", std::process::id()));
        fs::create_dir_all(folder.join("below")).unwrap();
        let file = folder.join("a.svg");
        let name = file.to_string_lossy();
        write(&name, "drawing").unwrap();
        write(&name, "a newer drawing").unwrap();
        read(&name).unwrap();
        let other = folder.join("below/../a.svg");
        for path in [&file, &other] {
            let refused = write(&path.to_string_lossy(), "strokes").unwrap_err();
            assert!(refused.message.contains("would be overwritten"), "{refused:?}");
            let refused = written_whole(path, |part| write(&part.to_string_lossy(), "strokes")).unwrap_err();
            assert!(refused.message.contains("would be overwritten"), "{refused:?}");
        }
        assert_eq!(fs::read_to_string(&file).unwrap(), "a newer drawing");
        remove_read(&file).unwrap();
        write(&name, "another").unwrap();
        // a rig file with what was identified of it is meant to be replaced
        replace(&name, "saved").unwrap();
        assert_eq!(fs::read_to_string(&file).unwrap(), "saved");
        fs::remove_dir_all(folder).unwrap();
    }
}
