//! DXF: anyone's ASCII in, ours out.
//!
//! The reader is our own, not the `dxf` crate's: pairs of lines, a record at a time, only what is drawn. What is drawn
//! needs some forty group codes; and files come from anywhere, so memory and time must be bounded by the drawing's own
//! geometry, whatever a file declares and however its blocks repeat each other, and nothing may panic: a million
//! broken files are read by `tests/mutations.rs`. Sections may come in any order.
//!
//! Read are LINE, LWPOLYLINE, POLYLINE, ARC, CIRCLE, ELLIPSE, SPLINE, TEXT, MTEXT, ATTRIB and INSERT in model space, seen from above.
//! Group codes are those of Autodesk's *DXF Reference*, 2000 to 2018; older files use a part of them.

mod aci;
mod blocks;
mod codes;
mod curves;
mod entities;
mod groups;
mod header;
mod join;
mod mtext;
mod read;
mod scene;
mod spline;
mod text;
mod write;

pub use read::{read, read_with};
pub use write::write;

#[cfg(test)]
mod tests;

/// Largest DXF that is read, bytes: the format takes some hundred bytes for a line.
const MAX_BYTES: usize = 64 << 20;

/// Elements of all strokes at most, blocks unfolded, for the memory they take.
const MAX_ELEMENTS: usize = 2_000_000;

/// An entity takes the memory of so many elements at least.
const LEAST_ELEMENTS: usize = 4;
