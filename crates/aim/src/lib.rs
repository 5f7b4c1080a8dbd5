//! Coordinate frames: pixels, target, head, joints, camera.
//!
//! | frame | axes |
//! |---|---|
//! | pixel | x right, y down; the image spans [0, w] × [0, h] |
//! | target | metres on the plane drawn on; origin at the picture's centre, x right, y up, z towards the head |
//! | head | x along the beam at zero, y left, z up; origin where the axes cross |
//! | joint | pan about z, tilt about the pan-carried y, rad; positive tilt turns the beam down |
//! | camera | x right, y down, z ahead; origin where the light passes |
//!
//! All conversions between them are in this crate and nowhere else. The crate knows no images and no clock.

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")
)]

mod align;
mod board;
mod camera;
mod corners;
mod dual;
mod head;
mod homography;
mod jet;
mod least_squares;
mod lens;
mod marks;
mod placement;
mod pose;
mod rectangle;
mod survey;
mod trim;

pub use align::{AlignError, Aligned, Alignment, AlignmentBelief, SeenSpot, align};
pub use board::Board;
pub use camera::{Camera, CameraPose, Uncertain};
pub use corners::{CorneredHead, CornersError, POINTED_M, cornered, corners_of};
pub use head::{AimError, HeadGeometry, JointPath, SpotMotion};
pub use homography::Homography;
pub use lens::Lens;
pub use marks::{MARK_DEVIATION_M, Mark, MarkError, Marked, MarkedBy, MarkedSheet, SheetMap, marked};
pub use placement::{Placement, SizeRequest};
pub use pose::HeadPose;
pub use rectangle::proportions;
pub use survey::{
    Doubt, LensBelief, PlacedPage, SeenPlace, SeenTag, Survey, SurveyError, SurveyedCamera, survey,
};
pub use trim::{Correction, Surprise, Trim, TrimBelief};
