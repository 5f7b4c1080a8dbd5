//! A head behind a port, as a rig.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use tracelight_device::{Host, Stage, Twin};
use tracelight_rig::wire::Greeting;
use tracelight_rig::{Command, Darkness, Rig, TICK_F64_S, Telemetry};
use tracelight_sim::RigConfig;
use tracelight_task::{Failure, Stop, Task};

use crate::port::Port;
use crate::seen::Seen;
use crate::session::{micros, new_session};
use crate::shared::{Shared, stopped};

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
    /// Those who watch it, and may disarm it; none where no socket could be made. Given up before the port is.
    shared: Option<Shared>,
    port: Option<Port>,
    path: PathBuf,
    began: Instant,
    /// When the line broke.
    broke: Option<Instant>,
    /// Whoever waits for a cable need not.
    stop: Stop,
    /// Why it is to stay dark: somebody else stopped it.
    stopped: Option<Failure>,
    /// Its last tick that was told had the board disarmed and its gate shut.
    is_dark: bool,
    remarks: Vec<String>,
}

impl Device {
    /// Greets the board at a port and, if that is one to be driven, configures it; its first tick is the next that is told. It is disarmed, and its motors hold it
    /// where it is.
    ///
    /// # Errors
    /// `port`: it cannot be opened. `board`: what is wrong with the board, or its line. `interrupted`. Why it is not one to be driven.
    pub fn connect(
        path: &Path,
        config: &RigConfig,
        mut meet: impl FnMut(&Greeting) -> Result<(), Failure>,
        stop: &Stop,
    ) -> Result<Self, Failure> {
        let port = Some(Port::open(path)?);
        let host = Host::new(config.control_config(), new_session());
        let (began, stop) = (Instant::now(), stop.clone());
        let (stopped, is_dark, remarks) = (None, false, Vec::new());
        let path = path.to_owned();
        let mut device =
            Self { host, shared: None, port, path, began, broke: None, stop, stopped, is_dark, remarks };
        device.answer();
        // until it is known how it begins
        while device.host.twin().is_none_or(|twin| twin.state().is_none()) {
            device.stop.check()?;
            device.pump();
            device
                .host
                .board()
                .map_or(Ok(()), |board| device.refuse_double(board).and_then(|()| meet(board)))?;
            if let Some(failure) = device.failure() {
                return Err(failure);
            }
        }
        Ok(device)
    }

    /// A test double may be at a pseudo-terminal only.
    fn refuse_double(&self, board: &Greeting) -> Result<(), Failure> {
        if board.board != Greeting::DOUBLE || self.port.as_ref().is_none_or(Port::is_pseudo_terminal) {
            return Ok(());
        }
        let at = self.path.display();
        let message = format!(
            "{at}: this board runs the test double of the firmware, which is for an emulator: its processor is too slow to hold a head. Flash a Pico 2 with tracelight-pico-2.uf2"
        );
        Err(Failure::failed("board", message))
    }

    /// Waits, dark, until light may be let out: whoever drove the head before may have had it anywhere. A head that has been dark for some seconds is not waited for.
    ///
    /// # Errors
    /// As of [`connect`](Self::connect), or the head is gone.
    pub fn wait_for_light(&mut self, task: Task<'_>) -> Result<(), Failure> {
        let mut is_told = false;
        // the first tick shows how it stands
        while self.next().is_some() {
            task.check()?;
            // whoever waits is there: of a port that is shared it stays his
            let _ = self.host.send(Command::KeepAlive);
            let left_s = f64::from(self.host.opens_in_ticks()) * TICK_F64_S;
            if left_s <= 0.0 {
                return Ok(());
            }
            if !std::mem::replace(&mut is_told, true) {
                task.say(&format!("note: the head was lit a moment ago, and nobody knows where: it stays dark for {left_s:.1} s more"));
            }
        }
        Err(self.failure().unwrap_or_else(Failure::interrupted))
    }

    /// Whether the head knows where it points, by the last tick that is known.
    #[must_use]
    pub fn is_homed(&self) -> bool {
        self.host.twin().and_then(Twin::state).is_some_and(|state| state.is_homed())
    }

    /// Whether a person must arm it.
    #[must_use]
    pub fn wants_a_person(&self) -> bool {
        self.host.board().is_none_or(Greeting::wants_a_person)
    }

    /// What is known of the board.
    #[must_use]
    pub const fn host(&self) -> &Host {
        &self.host
    }

    /// Answers for its port, unless it drives through another program's: whoever watches is told there.
    fn answer(&mut self) {
        // the old one first: it may lie where the new one goes
        self.shared = None;
        if !self.port.as_ref().is_some_and(Port::is_own) {
            return;
        }
        match Shared::new(&self.path, false) {
            Ok(shared) => self.shared = Some(shared),
            Err(e) => self.remarks.push(format!("no other program can watch or stop this head: {e}")),
        }
    }

    /// What there was to remark for people since it was last asked.
    pub fn remarks(&mut self) -> Vec<String> {
        let mut remarks = std::mem::take(&mut self.remarks);
        remarks.extend(
            std::iter::from_fn(|| self.host.remark()).map(|remark| format!("the board remarks: {remark}")),
        );
        remarks
    }

    /// Why no tick comes any more, if none does.
    #[must_use]
    pub fn failure(&self) -> Option<Failure> {
        let at = self.path.display();
        if let Some(why) = &self.stopped {
            return Some(why.clone());
        }
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
        if self.shared.as_mut().is_some_and(|shared| shared.hear().disarm) {
            // taken at any time, and said until it is confirmed
            let _ = self.host.send(Command::Disarm);
            self.stopped = Some(stopped(&self.path.to_string_lossy()));
        }
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
        // one that was its own is not visited at its own socket
        let opened =
            if self.shared.is_some() { Port::open_alone(&self.path) } else { Port::open(&self.path) };
        match opened {
            Ok(port) => {
                (self.port, self.broke) = (Some(port), None);
                self.host.connect_again(new_session());
                if self.shared.is_none() {
                    self.answer();
                }
            }
            Err(why) if why.code == "disarmed" => self.stopped = Some(why),
            Err(_) => {}
        }
    }
}

impl Rig for Device {
    fn send(&mut self, command: Command) -> Result<(), Command> {
        // whoever stopped it from elsewhere does not want it lit again from here
        let lights = matches!(command, Command::Arm { .. } | Command::Point(_));
        if self.stopped.is_some() && lights { Err(command) } else { self.host.send(command) }
    }

    fn next(&mut self) -> Option<Telemetry> {
        loop {
            if let Some(told) = self.host.telemetry() {
                self.is_dark = !told.actuation.lights() && told.darkness.contains(Darkness::Disarmed);
                self.shared.iter_mut().for_each(|shared| shared.tell(&Seen::of(&told)));
                return Some(told);
            }
            // who was stopped from elsewhere is told ticks until its board is dark, as far as that can be
            let goes_on = self.port.is_some() && !matches!(self.host.stage(), Stage::Failed(_));
            let is_waited_for = self.stopped.is_some() && !self.is_dark && goes_on;
            if self.failure().is_some() && !is_waited_for || self.port.is_none() && self.stop.is_wanted() {
                return None;
            }
            self.pump();
        }
    }
}
