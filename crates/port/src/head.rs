//! The head at a port, as jobs drive it.

use std::path::PathBuf;

use tracelight_aim::HeadPose;
use tracelight_rig::wire::Greeting;
use tracelight_sim::{ByEncoders, RigConfig};
use tracelight_task::{Failure, Stop};

use crate::device::Device;

/// Where a head is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct At {
    /// The port of its board.
    pub port: PathBuf,
    /// Somebody said which head it is; otherwise it is taken for that of the preset `report`, which only an emulated board may be.
    pub is_said: bool,
}

/// Connects to the board at a port, which gets to know the head: which stands so. It is disarmed, and its motors hold the head where it is.
///
/// # Errors
/// As of [`Device::connect`]; `rig-file`: nobody said which head a real board drives.
pub fn head(at: &At, config: &RigConfig, pose: HeadPose, stop: &Stop) -> Result<ByEncoders<Device>, Failure> {
    let mut is_emulated = false;
    let meet = |board: &Greeting| {
        is_emulated = board.is_emulated();
        if !board.wants_a_person() || at.is_said {
            return Ok(());
        }
        let port = at.port.display();
        let message = format!(
            "which head does the board at {port} drive? Give its rig file: --rig {port}:my-head.toml"
        );
        Err(Failure::usage("rig-file", message))
    };
    let device = Device::connect(&at.port, config, meet, stop)?;
    Ok(ByEncoders::new(device, config, pose, is_emulated))
}
