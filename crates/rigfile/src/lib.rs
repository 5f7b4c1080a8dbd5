//! Rig files, camera files and head files: text to values and back, comments kept.
//!
//! A rig file has two halves. `[model]` is what planner and controller believe; `[truth]` is what the simulated head is,
//! and defaults to the model; `[identified]` is what was identified of this very head besides. Keys that are not given keep
//! the values of the preset `report`. What a camera and a head in front of a wall are known by lies in files of their own.

pub mod camera;
mod caret;
mod found;
mod hand_tuned;
pub mod head;
mod keys;
mod pages;
mod rig;
mod safety;
mod save;
mod text;
mod timing;

pub use hand_tuned::{FEEDFORWARDS, HIGHEST_GAIN};
pub use pages::PageName;
pub use rig::{parse, read, write};
pub use save::saved;
pub use timing::Timing;
