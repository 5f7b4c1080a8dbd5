//! SVG: anyone's in, ours out.

mod guard;
mod lines;
mod names;
mod read;
mod style;
mod swell;
mod tags;
mod text;
mod write;

pub use read::{read, read_with};
pub use write::write;

#[cfg(test)]
mod tests;
