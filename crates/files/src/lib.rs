//! Files: read with a bound, written whole or not at all, and pictures found by name. The one room under cameras and the host that
//! opens any.

mod folder;
mod inputs;
mod pictures;
mod typed;
mod whole;

pub use folder::ResultFolder;
pub use inputs::{inputs, protect, remove_read};
pub use pictures::{Found, Picture, find, stands_for_several};
pub use typed::in_text;
pub use whole::{is_same, read, replace, write, written_whole};
