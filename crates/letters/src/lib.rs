//! Text as paths. A line of text in a face becomes lines and cubics, by letter; several lines become a block.
//!
//! Two kinds of faces: outlines (TrueType, OpenType) give the edges of letters, fonts in SVG give what they hold, mostly the strokes of a
//! pen. What a single-line face lacks of the letters of Europe's languages is composed of a base and marks.
//!
//! Nothing here opens a file. Sizes are in em or in heights of capitals, y is up.

#![cfg_attr(test, allow(clippy::unwrap_used, reason = "a test fails by panicking"))]

mod block;
mod composed;
mod drawn;
mod error;
mod faces;
mod glyph;
mod letter;
mod line_face;
mod marks;
mod outline_face;
mod own_marks;
mod remarks;
mod slug;
mod svg_font;
#[cfg(test)]
mod tests;

pub use block::{Align, Block, LINE_SPACING, block};
pub use error::LettersError;
pub use faces::{Faces, Kind, Run, bundled, kind_of};
pub use letter::Letter;
pub use remarks::{named, remarks};
pub use slug::slug;

/// The examples of `README.md`, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
