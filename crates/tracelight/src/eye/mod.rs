//! What looks at the wall: cameras, real or simulated, and what their images tell of a head.
//!
//! | part | what |
//! |---|---|
//! | [`Shot`] | an image, and when it was taken |
//! | [`Eye`] | where shots come from |
//! | [`room`] | a simulated head and camera in front of a simulated wall |
//! | [`wall`] | the camera found from markers in sight |
//! | [`figure`] | the figure on the wall, as strokes |
//! | [`spots`] | the laser's spot in shots, held against what the encoders said |
//! | [`head`] | the head found from spots |

pub(crate) mod figure;
pub(crate) mod head;
mod pages;
pub(crate) mod room;
mod shot;
pub(crate) mod spots;
pub(crate) mod wall;

pub(crate) use shot::{Shot, grey};

/// Something that takes images of the wall, by the clock of the rig's ticks.
pub(crate) trait Eye {
    /// How long each row is to be exposed from the next image on, s.
    fn expose(&mut self, exposure_s: f64);

    /// Longest that a row can be exposed, s.
    fn longest_s(&self) -> f64;

    /// The oldest image that is there and was not asked for yet.
    fn shot(&mut self) -> Option<Shot>;
}
