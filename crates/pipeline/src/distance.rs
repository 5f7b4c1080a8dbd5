//! Who says how far a head stands from a wall.

use serde::Serialize;

/// Who says how far a head stands from the wall.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum DistanceFrom {
    /// Nobody: 3 ft are taken for a simulated rig.
    #[default]
    Assumed,
    /// The user.
    Asked,
    /// A head file.
    File,
    /// A camera.
    Camera,
}

impl DistanceFrom {
    /// In words.
    pub(crate) const fn words(self) -> &'static str {
        match self {
            Self::Assumed => "assumed, --distance tells it",
            Self::Asked => "as told",
            Self::File => "by the head file",
            Self::Camera => "found by the camera",
        }
    }
}
