use thiserror::Error;
use tracelight_stroke::Point;

/// Why no spot is found.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum SpotLost {
    /// The images are not of one size.
    #[error("images of {} × {} and of {} × {} px can not be held against each other", .lit.0, .lit.1, .dark.0, .dark.1)]
    Sizes {
        /// Width and height of the image with the spot.
        lit: (usize, usize),
        /// Of the one without.
        dark: (usize, usize),
    },
    /// Too little of the window is in the image.
    #[error("the spot is awaited at ({:.0}, {:.0}) px, out of the camera's sight", .0.x, .0.y)]
    OutOfSight(Point),
    /// Nothing stands out.
    #[error(
        "no spot: the brightest change is {change:.2} % of full light, and {least:.2} % stand out from the noise; more light or a longer exposure helps"
    )]
    Dim {
        /// The brightest change, %.
        change: f64,
        /// What would stand out, %.
        least: f64,
    },
    /// The spot reaches beyond the window.
    #[error("the spot at ({:.1}, {:.1}) px reaches beyond where it is looked for; look in a larger window", .0.x, .0.y)]
    Cut(Point),
}
