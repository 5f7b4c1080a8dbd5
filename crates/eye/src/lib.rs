//! What looks at the wall: what the images of cameras, real or simulated, tell of a wall, a figure, a head and its spot. No device, no
//! file.
//!
//! | part | what |
//! |---|---|
//! | [`Shot`] | an image, and when it was taken; [`coding`] how its bytes mean pixels |
//! | [`about`] | what a camera says of itself |
//! | [`Looks`] | what takes a shot when told |
//! | [`Eye`] | what sends shots by itself while a rig runs; [`Driven`], with a session that drives the rig |
//! | [`board`] | pages of markers |
//! | [`room`] | a simulated head and camera in front of a simulated wall |
//! | [`sight`] | what one image tells before anything is measured by it |
//! | [`wall`] | the camera found from markers in sight |
//! | [`figure`] | the figure on the wall, as strokes |
//! | [`spots`] | the laser's spot in shots, held against what the encoders said |
//! | [`head`] | the head found from spots; [`told`] in words and figures |
//! | [`corners`] | the head found from the corners of a rectangle, as it is told; [`pointed`] by somebody simulated |
//! | [`power`] | a rig that was just powered up, or lost power |
//! | [`homing`] | a head that was just powered up finds where it points |
//! | [`follow`] | the spot followed while a rig draws: what is off slowly, and suddenly |
//! | [`painted`] | what was seen of it, as a picture |
//! | [`trim`] | what is slowly off, taken off a plan's segments on their way |
//! | [`trouble`] | what goes wrong in a simulated room |
//! | [`figures`], [`seen`] | what was seen, as figures and as marks |

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")
)]

pub mod about;
pub mod board;
pub mod coding;
pub mod corners;
mod driven;
pub mod figure;
pub mod figures;
pub mod follow;
pub mod head;
pub mod homing;
mod looks;
mod pages;
pub mod painted;
pub mod pointed;
pub mod power;
pub mod room;
pub mod seen;
mod shot;
pub mod sight;
pub mod spots;
pub mod told;
pub mod trim;
pub mod trouble;
pub mod wall;

pub use driven::{Driven, Eye, refused};
pub use looks::{Looks, MOST_IMAGE_BYTES, PATIENCE_TICKS};
pub use shot::{Shot, grey};
