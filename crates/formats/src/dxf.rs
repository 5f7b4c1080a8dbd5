//! DXF: anyone's ASCII in, ours out.
//!
//! The reader is our own and small: pairs of lines, a record at a time, only what is drawn. What it was weighed
//! against, the `dxf` crate, builds an object for every entry of a file it should not trust; here memory is bounded
//! by the drawing's own geometry, and blocks that repeat each other are judged before they are unfolded. Nothing is
//! looked up by position in the file: sections may come in any order.
//!
//! Read are LINE, LWPOLYLINE, POLYLINE, ARC, CIRCLE, ELLIPSE, SPLINE and INSERT in model space, seen from above.
//! Group codes are those of Autodesk's *DXF Reference*, 2000 to 2018; older files use a part of them.

mod aci;
mod blocks;
mod curves;
mod entities;
mod groups;
mod header;
mod join;
mod read;
mod scene;
mod spline;
mod write;

pub use read::read;
pub use write::write;

#[cfg(test)]
mod tests;

/// Largest DXF that is read, bytes: the format takes some hundred bytes for a line.
const MAX_BYTES: usize = 64 << 20;

/// Elements of all strokes at most, blocks unfolded, for the memory they take.
const MAX_ELEMENTS: usize = 2_000_000;

/// An entity takes the memory of so many elements at least.
const LEAST_ELEMENTS: usize = 4;
