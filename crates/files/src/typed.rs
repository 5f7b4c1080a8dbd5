//! Names that were typed.

use std::ffi::OsString;

use tracelight_task::Failure;

/// Whether all that was typed is text: names of files go into messages, tables and results.
///
/// # Errors
/// `usage`, with the name as it is.
pub fn in_text(arguments: &[OsString]) -> Result<(), Failure> {
    match arguments.iter().find(|argument| argument.to_str().is_none()) {
        Some(name) => {
            let message = format!(
                "the name {name:?} is not UTF-8 text, as names of files have to be: rename the file, or give a link to it \
                 (ln -s)"
            );
            Err(Failure::usage("usage", message))
        }
        None => Ok(()),
    }
}
