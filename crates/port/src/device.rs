//! A head behind a port, as a rig.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use tracelight_device::{Host, Stage};
use tracelight_rig::{Command, Rig, Telemetry};
use tracelight_sim::RigConfig;
use tracelight_task::{Failure, Stop};

use crate::port::Port;
use crate::session::{micros, new_session};

/// For how long it waits for bytes before it looks what else is to be done.
const WAIT: Duration = Duration::from_millis(1);
/// How long a cable may be out, and how often it is looked for.
const GONE: Duration = Duration::from_secs(10);
const LOOK_AGAIN: Duration = Duration::from_millis(100);

/// A head whose board is at a port. Each tick that is [asked for](Rig::next) is waited for; between them it has to be asked soon, or the board holds its head still. A cable
/// that is pulled and put in again leaves it disarmed, and homed if the board kept its power.
#[derive(Debug)]
pub struct Device {
    host: Host,
    port: Option<Port>,
    path: PathBuf,
    began: Instant,
    /// When the line broke.
    broke: Option<Instant>,
}

impl Device {
    /// Greets the board at a port and configures it; its first tick is the next that is told. It is disarmed, and its motors hold it where it is.
    ///
    /// # Errors
    /// `port`: it cannot be opened. `board`: what is wrong with the board, or its line. `interrupted`.
    pub fn connect(path: &Path, config: &RigConfig, stop: &Stop) -> Result<Self, Failure> {
        let port = Some(Port::open(path)?);
        let host = Host::new(config.control_config(), new_session());
        let mut device = Self { host, port, path: path.to_owned(), began: Instant::now(), broke: None };
        while device.host.stage() != Stage::Running {
            stop.check()?;
            device.pump();
            if let Some(failure) = device.failure() {
                return Err(failure);
            }
        }
        Ok(device)
    }

    /// What is known of the board.
    #[must_use]
    pub const fn host(&self) -> &Host {
        &self.host
    }

    /// Why no tick comes any more, if none does.
    #[must_use]
    pub fn failure(&self) -> Option<Failure> {
        let at = self.path.display();
        match self.host.stage() {
            Stage::Failed(trouble) => Some(Failure::failed("board", format!("{at}: {trouble}"))),
            _ if self.broke.is_some_and(|broke| broke.elapsed() > GONE) => {
                let message = format!("{at}: the cable is out for {} s, and the head dark", GONE.as_secs());
                Some(Failure::failed("board", message))
            }
            _ => None,
        }
    }

    /// Says what is to be said, and hears what comes.
    fn pump(&mut self) {
        let Some(port) = &mut self.port else { return self.look_again() };
        let mut bytes = Vec::new();
        self.host.give(micros(self.began), &mut bytes);
        let said = port.write(&bytes);
        bytes.clear();
        let heard = port.read(&mut bytes, WAIT);
        self.host.take(&bytes, micros(self.began));
        if said.and(heard).is_err() {
            self.port = None;
            self.broke = Some(Instant::now());
        }
    }

    /// The port may be there again.
    fn look_again(&mut self) {
        std::thread::sleep(LOOK_AGAIN);
        if let Ok(port) = Port::open(&self.path) {
            (self.port, self.broke) = (Some(port), None);
            self.host.connect_again(new_session());
        }
    }
}

impl Rig for Device {
    fn send(&mut self, command: Command) -> Result<(), Command> {
        self.host.send(command)
    }

    fn next(&mut self) -> Option<Telemetry> {
        loop {
            if let Some(told) = self.host.telemetry() {
                return Some(told);
            }
            if self.failure().is_some() {
                return None;
            }
            self.pump();
        }
    }
}
