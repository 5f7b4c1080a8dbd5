//! The studio: a page in a browser in which a picture is opened, placed on the wall, planned and traced, and the HTTP behind it.
//!
//! Nothing in the page is out of a script's reach: it asks by HTTP what anybody may ask, and whatever is asked is one of the program's own command lines, which
//! [`Program`] does. A job by the clock is attended from pages as from a terminal: one operates it, anybody stops it. The server listens on this
//! computer alone, unless devices of the network are to be invited.

mod answers;
mod assets;
mod beside;
mod calibrations;
mod cameras;
mod desk;
mod devices;
mod door;
mod flags;
mod folder;
mod foxglove;
mod guard;
mod head;
mod history;
mod house;
mod lab;
mod lan;
mod live;
mod names;
mod points;
mod program;
mod refused;
mod rigs;
mod sent;
mod serve;
mod server;
mod session;
mod socket;
mod tasks;
mod watch;
mod watching;

pub use program::{Camera, Head, Performed, Program, Seat};
pub use serve::{Invitation, Studio, open};
