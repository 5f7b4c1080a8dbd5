//! The head at a port, as jobs drive it.

use tracelight_aim::HeadPose;
use tracelight_rig::wire::Greeting;
use tracelight_rig::{Command, Rig, Telemetry};
use tracelight_sim::{ByEncoders, RigConfig};
use tracelight_task::{Failure, Stop, Task};

use crate::device::Device;
use crate::grbl::{self, Grbl};

/// Where a head is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct At {
    /// The port of its board; `tcp:HOST` of one that speaks Grbl on the net.
    pub port: String,
    /// What is spoken there.
    pub speaks: Speaks,
    /// Somebody said which head it is; otherwise it is taken for that of the preset `report`, which only an emulated board may be.
    pub is_said: bool,
}

/// What a board speaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Speaks {
    /// The wire of Tracelight's own boards.
    Wire,
    /// G-code, as Grbl has it.
    Grbl,
}

/// A head at a port.
#[derive(Debug)]
pub enum Connected {
    /// On a board of Tracelight's.
    Board(Box<Device>),
    /// On a Grbl board.
    Grbl(Box<Grbl>),
}

impl At {
    /// A rig as it can be planned for: within the limits of a board that has some of its own. What people are to know of that.
    ///
    /// # Errors
    /// As of [`grbl::ask`] and [`grbl::fit`].
    pub fn fitted(&self, config: RigConfig, stop: &Stop) -> Result<(RigConfig, Vec<String>), Failure> {
        match self.speaks {
            Speaks::Wire => Ok((config, Vec::new())),
            Speaks::Grbl => grbl::fit(&self.port, &grbl::ask(&self.port, stop)?, config),
        }
    }
}

/// Connects to the board at a port, which gets to know the head: which stands so. It is disarmed, and its motors hold the head where it is.
///
/// # Errors
/// As of [`Device::connect`] and [`Grbl::connect`]; `rig-file`: nobody said which head a real board drives.
pub fn head(
    at: &At,
    config: &RigConfig,
    pose: HeadPose,
    stop: &Stop,
) -> Result<ByEncoders<Connected>, Failure> {
    if at.speaks == Speaks::Grbl {
        let grbl = Grbl::connect(&at.port, config, pose, stop)?;
        let is_simulated = grbl.board().is_simulated();
        return Ok(ByEncoders::new(Connected::Grbl(Box::new(grbl)), config, pose, is_simulated));
    }
    let mut is_emulated = false;
    let meet = |board: &Greeting| {
        is_emulated = board.is_emulated();
        if !board.wants_a_person() || at.is_said {
            return Ok(());
        }
        let port = &at.port;
        let message = format!(
            "which head does the board at {port} drive? Give its rig file: --rig {port}:my-head.toml"
        );
        Err(Failure::usage("rig-file", message))
    };
    let device = Device::connect(at.port.as_ref(), config, meet, stop)?;
    Ok(ByEncoders::new(Connected::Board(Box::new(device)), config, pose, is_emulated))
}

impl Connected {
    /// Whether the head knows where it points, by the last tick that is known.
    #[must_use]
    pub fn is_homed(&self) -> bool {
        match self {
            Self::Board(device) => device.is_homed(),
            Self::Grbl(grbl) => grbl.is_homed(),
        }
    }

    /// Whether a person must arm it.
    #[must_use]
    pub fn wants_a_person(&self) -> bool {
        match self {
            Self::Board(device) => device.wants_a_person(),
            Self::Grbl(grbl) => !grbl.board().is_simulated(),
        }
    }

    /// Waits, dark, until light may be let out: whoever drove the head before may have had it anywhere.
    ///
    /// # Errors
    /// The head is gone. `interrupted`.
    pub fn wait_for_light(&mut self, task: Task<'_>) -> Result<(), Failure> {
        match self {
            Self::Board(device) => device.wait_for_light(task),
            Self::Grbl(grbl) => grbl.wait_for_light(task),
        }
    }

    /// What there was to remark for people since it was last asked.
    pub fn remarks(&mut self) -> Vec<String> {
        match self {
            Self::Board(device) => device.remarks(),
            Self::Grbl(grbl) => grbl.remarks(),
        }
    }

    /// Why no tick comes any more, if none does.
    #[must_use]
    pub fn failure(&self) -> Option<Failure> {
        match self {
            Self::Board(device) => device.failure(),
            Self::Grbl(grbl) => grbl.failure(),
        }
    }
}

impl Rig for Connected {
    fn send(&mut self, command: Command) -> Result<(), Command> {
        match self {
            Self::Board(device) => device.send(command),
            Self::Grbl(grbl) => grbl.send(command),
        }
    }

    fn next(&mut self) -> Option<Telemetry> {
        match self {
            Self::Board(device) => device.next(),
            Self::Grbl(grbl) => grbl.next(),
        }
    }
}
