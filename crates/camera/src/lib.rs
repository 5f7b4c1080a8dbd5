//! Where images come from that are not simulated: cameras that are plugged in or on the net, films, and files.

#[cfg(target_os = "linux")]
mod device;
mod devices;
mod film;
#[cfg(test)]
mod hostile;
mod latest;
mod looked;
mod net;
mod redirect;
mod shown;
mod source;
mod stream;

pub use devices::{devices, named_devices};
pub use looked::{NamedCamera, SeenCamera, camera_json, camera_text, look_at, look_at_all, no_camera_text};
pub use shown::shown;
pub use source::{Opened, Source};
