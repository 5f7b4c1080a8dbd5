//! Detects square markers of the AprilTag family 36h11, to a few hundredths of a pixel.
//!
//! What is darker than its surroundings is cut from the rest (`local`), its patches with four straight sides are found (`quad`), the cells
//! between them are read and looked up (`cells`, `codes`), and every boundary between black and white cells, inside as well, is placed on
//! the grey levels (`boundary`, `placing`). The way is that of Wang & Olson, *AprilTag 2: Efficient and robust fiducial detection*, IROS
//! 2016. A patch that is no marker may be one with something beside it: four straight pieces of its border are tried (`pieces`), and what
//! of it is darker than a stricter threshold (`search`). Where cells can not be read, sides are moved to where the grey levels fall
//! (`side`), and what blur mixed into each cell is taken out.

mod boundary;
mod cells;
mod codes;
mod local;
mod part;
mod pieces;
mod place;
mod placing;
mod quad;
mod search;
mod side;
mod square;
mod tag;

use tracelight_image::Grey;

pub use place::TagPlace;
pub use tag::{TAG_COUNT, Tag, tag_cells};

/// Finds every marker whose sides are at least 10 px long and all in sight, with white about it half as wide as one of its cells or wider.
pub fn find_tags(image: &Grey) -> Vec<Tag> {
    search::found(image.plane())
}

#[cfg(test)]
mod tests;
