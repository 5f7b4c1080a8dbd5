//! What a file holds that the user named.

use tracelight_files as files;
use tracelight_picture::{Source, decode};
use tracelight_task::Failure;

/// Reads a picture or a drawing; `-` is standard input. What it is, its content says, not its name.
pub(crate) fn read(path: &str) -> Result<Source, Failure> {
    decode(path, &files::read(path)?)
}
