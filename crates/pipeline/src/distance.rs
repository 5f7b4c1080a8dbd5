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
