//! Which camera looks.

use clap::Args;
use tracelight_aim::LensBelief;

use crate::camera_file;
use crate::eye::room::SimulatedEye;
use crate::failure::Failure;

/// Which camera looks at the wall.
#[derive(Args, Clone, Debug)]
pub(crate) struct EyeArgs {
    /// Camera: sim:PICTURE is a simulated one in front of a simulated wall with PICTURE on it, sim one without
    #[arg(long, value_name = "SOURCE")]
    pub(crate) camera: Option<String>,
    /// Which camera is simulated
    #[arg(long, value_enum, default_value_t)]
    pub(crate) sim_camera: SimulatedEye,
    /// The camera's lens, if it was calibrated before: a file that `calibrate lens` or `calibrate markers` has written
    #[arg(long, value_name = "FILE.toml")]
    lens: Option<String>,
}

impl EyeArgs {
    /// The picture on the simulated wall, if there is one.
    pub(crate) fn picture(&self) -> Result<Option<&str>, Failure> {
        match self.camera.as_deref() {
            None | Some("sim") => Ok(None),
            Some(source) => {
                source.strip_prefix("sim:").filter(|path| !path.is_empty()).map(Some).ok_or_else(|| {
                    let message =
                        format!("--camera {source} is no camera that is known; give sim, or sim:PICTURE");
                    Failure::usage("usage", message)
                })
            }
        }
    }

    /// What is known of its lens.
    pub(crate) fn lens(&self) -> Result<Option<LensBelief>, Failure> {
        self.lens.as_deref().map(camera_file::read).transpose()
    }
}
