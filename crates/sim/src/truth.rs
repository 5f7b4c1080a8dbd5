//! True state of a simulated head, independent of its encoders.

use tracelight_plant::Plant;
use tracelight_rig::{Head, PanTilt};

/// A simulated head whose truth can be looked at.
pub(crate) trait Truth: Head {
    /// Joint angles, rad.
    fn angle_rad(&self) -> PanTilt<f64>;

    /// What the beam makes of them, rad.
    fn beam_rad(&self) -> PanTilt<f64> {
        self.angle_rad()
    }
}

impl Truth for Plant {
    fn angle_rad(&self) -> PanTilt<f64> {
        Plant::angle_rad(self)
    }

    fn beam_rad(&self) -> PanTilt<f64> {
        Plant::beam_rad(self)
    }
}
