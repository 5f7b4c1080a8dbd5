//! The studio: a page in a browser in which a picture is opened, placed on the wall, planned and traced, and the HTTP behind it.
//!
//! Nothing in the page is out of a script's reach: it asks by HTTP what anybody may ask, and whatever is asked is one of the program's own command lines, which
//! [`Program`] does. The server listens on this computer alone.

mod assets;
mod desk;
mod flags;
mod folder;
mod guard;
mod points;
mod program;
mod serve;
mod server;
mod tasks;

pub use program::{Performed, Program};
pub use serve::{Studio, open};
