//! A marker, and what the family knows of it.

use tracelight_stroke::Point;

use super::codes;
use super::place::TagPlace;

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
