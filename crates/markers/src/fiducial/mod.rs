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

use tracelight_image::Grey;
use tracelight_stroke::Point;

pub use place::TagPlace;

/// A marker that was found, pixel frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Tag {
    /// Its number in the family 36h11.
    pub id: u16,
    /// Corners of its black border: upper left as printed, then clockwise.
    pub corners: [Point; 4],
    /// Where black meets white.
    pub places: Vec<TagPlace>,
    /// Standard deviation of these places across their boundaries, px.
    pub deviation_px: f64,
    /// Number of corrected cells.
    pub wrong_cells: u8,
}

/// How many ids the family has.
pub const TAG_COUNT: u16 = codes::CODES.len() as u16;

/// The cells of a marker with its black border, row by row from the upper left as printed; `true` is black. `None` of an id that
/// the family does not have.
pub fn tag_cells(id: u16) -> Option<[[bool; 8]; 8]> {
    let code = *codes::CODES.get(usize::from(id))?;
    let inner = |row: usize, column: usize| code >> (35 - (6 * (row - 1) + column - 1)) & 1 == 0;
    let black = |row: usize, column: usize| {
        !((1..7).contains(&row) && (1..7).contains(&column)) || inner(row, column)
    };
    Some(std::array::from_fn(|row| std::array::from_fn(|column| black(row, column))))
}

/// Finds every marker whose sides are at least 10 px long and all in sight, with white about it half as wide as one of its cells or wider.
pub fn find_tags(image: &Grey) -> Vec<Tag> {
    search::found(image.plane())
}

#[cfg(test)]
mod tests;
