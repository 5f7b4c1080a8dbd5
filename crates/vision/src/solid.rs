//! Ink that is thicker than any pen: squares that fit into it.

use crate::mask::Mask;
use crate::region::Region;

/// Which regions hold an upright square of `side` pixels.
pub(crate) fn hold_a_square(mask: &Mask, regions: &[Region], side: usize) -> Vec<bool> {
    let corners = mask.clone().eroded(side);
    regions.iter().map(|region| region.cells(&corners).next().is_some()).collect()
}
