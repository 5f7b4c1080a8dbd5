//! Where images come from that are not simulated: cameras that are plugged in or on the net, films, and files.

#[cfg(target_os = "linux")]
mod device;
mod devices;
mod film;
mod latest;
mod source;
mod stream;

pub use devices::devices;
pub use source::{Opened, Source};
