//! Bytes of a picture or a drawing to upright pixels or strokes, and pixels back to bytes. What a file is, its content says.

mod cost;
mod decode;
mod jpeg;
mod quiet;
mod raster;
mod turned;

pub use decode::{Pixels, Source, decode, decode_with, jpeg_is_whole};
pub use quiet::unless_it_panics;
pub use raster::Raster;
