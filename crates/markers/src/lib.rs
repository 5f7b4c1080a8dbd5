//! Detects markers and the laser spot in an image of a wall.
//!
//! [`find_tags`] finds printed square markers, [`find_spot`] the laser's spot: both to a few hundredths of a pixel, in the pixel
//! frame: x right, y down, the first pixel's centre is (0.5, 0.5). Nothing here knows strokes, cameras or metres.
//!
//! | module | what |
//! |---|---|
//! | `light` | light from levels, and less noise on it |
//! | `fiducial` | printed square markers and which they are |
//! | `spot` | the laser's spot, by an image with it and one without |

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")
)]

mod error;
mod fiducial;
mod light;
mod spot;

pub use error::SpotLost;
pub use fiducial::{TAG_COUNT, Tag, TagPlace, find_tags, tag_cells};
pub use spot::{Spot, SpotWindow, find_spot};
