//! Which camera looks.

use clap::Args;

use crate::camera_file::{self, KnownCamera};
use crate::eye::room::SimulatedEye;
use crate::eye::source::Source;
use crate::eye::trouble::TroubleAt;
use crate::failure::Failure;

/// Which camera looks at the wall.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct EyeArgs {
    /// Camera: sim:PICTURE is a simulated one in front of a simulated wall with PICTURE on it; http://… one on the net, that sends a stream
    /// (MJPEG) or an image each time; or an image or a folder of them
    #[arg(long, value_name = "SOURCE")]
    pub(crate) camera: Option<String>,
    /// Which camera is simulated
    #[arg(long, value_enum, default_value_t, requires = "camera")]
    pub(crate) sim_camera: SimulatedEye,
    /// What is known of the camera: a file that `calibrate markers` or `calibrate lens` has written. Where no markers are in sight, the
    /// camera is believed to stand where it stood
    #[arg(long, value_name = "FILE.toml", requires = "camera")]
    pub(crate) calibration: Option<String>,
}

/// How a camera follows the spot while it draws.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct FollowArgs {
    /// What the camera sees while the laser draws is told, but nothing is made of it: nothing is trimmed, and a head that was bumped is not
    /// found again
    #[arg(long, requires = "camera")]
    pub(crate) open_loop: bool,
    /// Lets something go wrong in a simulated room, to see what is made of it: pan-slip=20@5 is an encoder that slips by 20 counts 5 s
    /// after drawing began; also tilt-slip=COUNTS, head-bump=DEGREES, drift=PERCENT, camera-bump=PX, camera-unplugged, camera-frozen,
    /// camera-black, camera-slow=IMAGES_A_SECOND, camera-stamps=SECONDS. May be given more than once
    #[arg(long, value_name = "TROUBLE", requires = "camera")]
    pub(crate) sim_trouble: Vec<TroubleAt>,
}

impl EyeArgs {
    /// The camera.
    pub(crate) fn source(&self) -> Result<Source<'_>, Failure> {
        let missing = "which camera? --camera sim is a simulated one, --camera http://… one on the net";
        Source::of(self.camera.as_deref().ok_or_else(|| Failure::usage("usage", missing))?)
    }

    /// Whether pages of markers hang on a simulated wall: the report's camera does not see them and a picture at once, and they are taken
    /// down once it is calibrated.
    pub(crate) fn has_pages(&self) -> Result<bool, Failure> {
        let stood = self.known()?.is_some_and(|known| known.stood.is_some());
        Ok(self.sim_camera == SimulatedEye::Webcam || !stood)
    }

    /// What is known of it.
    pub(crate) fn known(&self) -> Result<Option<KnownCamera>, Failure> {
        self.calibration.as_deref().map(camera_file::read_whole).transpose()
    }
}
