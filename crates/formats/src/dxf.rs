//! DXF: anyone's in, ASCII or binary, ours out.
//!
//! The reader is our own, not the `dxf` crate's: groups of a code and a value, a record at a time, only what is drawn. What is drawn
//! needs some forty group codes; and files come from anywhere, so memory and time must be bounded by the drawing's own
//! geometry, whatever a file declares and however its blocks repeat each other, and nothing may panic: a million
//! broken files are read by `tests/mutations.rs`. Sections may come in any order.
//!
//! Read is whatever has lines in model space, seen from above: LINE, LWPOLYLINE, POLYLINE, ARC, CIRCLE, ELLIPSE, SPLINE,
//! POINT, SOLID, TRACE, 3DFACE, MESH, MLINE, LEADER, MULTILEADER, HATCH, TEXT, MTEXT, ATTRIB, INSERT and DIMENSION. All else is counted.
//! Group codes are those of Autodesk's *DXF Reference*, 2000 to 2018; older files use a part of them.

mod aci;
mod ascii;
mod binary;
mod blocks;
mod codes;
mod curves;
mod dashes;
mod entities;
mod groups;
mod hatch;
mod header;
mod join;
mod leader;
mod linetype;
mod look;
mod mesh;
mod mtext;
mod origin;
mod pattern;
mod polyline;
mod read;
mod records;
mod scene;
mod sheet;
mod skipped;
mod spline;
mod styles;
mod text;
mod twice;
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
