//! Rig files, camera files and head files: text to values and back, comments kept.
//!
//! A rig file has two halves. `[model]` is what planner and controller believe; `[truth]` is what the simulated head is,
//! and defaults to the model; `[identified]` is what was identified of this very head besides. A file has every key, or
//! names with `base` the preset whose the others are. What a camera and a head in front of a wall are known by lies in files of their own.

mod calibrated;
mod calibration;
pub mod camera;
mod caret;
mod drives;
mod found;
mod hand_tuned;
pub mod head;
mod homing;
mod keys;
mod names;
mod pages;
mod possible;
mod rig;
mod safety;
mod save;
mod text;
mod timing;
mod whole;

pub use calibrated::{Calibrated, Of, Verdict};
pub use calibration::read as calibrated;
pub use drives::{measured, set_law};
pub use hand_tuned::{FEEDFORWARDS, HIGHEST_GAIN};
pub use homing::homing_section;
pub use names::{at_port, emulated, on_grbl};
pub use pages::PageName;
pub use rig::{RigFile, parse, read, write};
pub use save::saved;
pub use timing::Timing;
