use thiserror::Error;

/// Why levels are no image. The message says what was given, what is needed, and what to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ImageError {
    /// Number of levels and size do not agree.
    #[error("an image of {width} × {height} px needs width × height levels, not {levels}")]
    Levels {
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
        /// Levels given.
        levels: usize,
    },
    /// Too few pixels for a drawing.
    #[error(
        "the image is {width} × {height} px; a drawing needs at least {least} px either way: use a larger picture"
    )]
    TooSmall {
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
        /// Least of either.
        least: usize,
    },
}
