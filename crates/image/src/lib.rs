//! Pixel operations.
//!
//! A [`Grey`] is an image of brightnesses, a [`Plane`] any values on its grid, a [`Mask`] one bit a pixel: what is set is called ink,
//! what is not paper, whatever they are of. In the pixel frame x is right, y down; the image spans [0, width] × [0, height], the
//! first pixel's centre is (0.5, 0.5). Nothing here knows what is seen in an image: no lines, no sheets, no markers.
//!
//! | module | what |
//! |---|---|
//! | `grey`, `plane` | images of brightnesses; values of any kind on a grid of pixels |
//! | `mask`, `mask::morphology` | a bit a pixel; made thinner and thicker |
//! | `region`, [`border`] | patches of ink and of paper; the edges round them and what these enclose |
//! | [`distance`] | from ink to the nearest paper |
//! | [`levels`], [`threshold`] | how often each level comes; which pixels are over one |
//! | [`smooth`] | pixel noise, and less of it |
//! | [`median`], [`solve`] | the middle of some values; few linear equations, the straight line nearest to places |
//! | `projection` | a rectangle seen at a slant |

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")
)]

pub mod border;
pub mod distance;
mod error;
mod grey;
pub mod levels;
mod mask;
pub mod median;
mod plane;
mod projection;
mod region;
pub mod smooth;
pub mod solve;
pub mod threshold;

pub use error::ImageError;
pub use grey::Grey;
pub use mask::{Cell, Mask, Neighbours};
pub use plane::Plane;
pub use projection::Projection;
pub use region::{Region, Run, any_spans, ink_runs, long_axis, mask_of, pinholes, regions};
