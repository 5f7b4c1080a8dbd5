//! How much a reader takes.

/// Largest file that is read, bytes. The worst ones of this size take 2 s and 900 MB (measured).
pub const MAX_BYTES: usize = 16 << 20;

/// Coordinates beyond this are a broken file's. A million metres, or pixels, is more than anyone draws, and leaves
/// ten digits behind the point.
pub const MAX_COORDINATE: f64 = 1e6;
