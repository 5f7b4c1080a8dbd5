//! SVG: anyone's in, ours out.

mod dash;
mod gates;
mod guard;
mod ink;
mod lines;
mod names;
mod paint;
mod painted;
mod paper;
mod read;
mod remarks;
mod seen;
mod shape;
mod style;
mod swell;
mod tags;
mod text;
mod write;

pub use read::{read, read_with};
pub use write::write;

#[cfg(test)]
mod tests;
