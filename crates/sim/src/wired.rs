//! A board in this process, behind a wire, and the host that drives it.

use tracelight_board::{Board, Identity};
use tracelight_control::Config;
use tracelight_device::{Host, Stage, Trouble as HostTrouble};
use tracelight_rig::wire::{MOST_PACKET, Reset};
use tracelight_rig::{
    Actuation, Capabilities, Command, Darkness, DarknessSet, Fault, FaultRecord, Phase, Sensed, Telemetry,
};

use crate::link::{LinkSettings, Way};

/// The emulated board holds as many segments ahead, and can tell as many rows again, as that with pins.
pub(crate) type Firmware = Board<384, 2048>;
/// So much of a plan a board has before it begins, ticks.
const LEAD_TICKS: u32 = 200;
/// Length of a tick, µs, and how far into one the board has answered.
const TICK_US: u64 = 1000;
const ANSWERED_US: u64 = 900;
/// What comes before a tick begins comes at the end of the one before it, µs.
pub(crate) const LAST_US: u16 = 999;
/// Bytes that a board hands over in a tick at most: what USB carries.
const MOST_BYTES: usize = 8 * MOST_PACKET;

/// Board, wire and host.
#[derive(Clone, Debug)]
pub(crate) struct Wired {
    host: Host,
    board: Box<Firmware>,
    to_board: Way,
    to_host: Way,
    now_us: u64,
    /// Until then the host does nothing, µs.
    stalled_until_us: u64,
    /// Until then the cable is pulled, µs.
    unplugged_until_us: Option<u64>,
    config: Config,
    capabilities: Capabilities,
    sessions: u32,
}

impl Wired {
    /// A board that has just been powered up and configured: what the head is has been sent, what it senses is looked at in the next tick.
    pub(crate) fn new(config: Config, capabilities: Capabilities, link: LinkSettings, seed: u64) -> Self {
        // what never comes late need not be waited for
        let lead_ticks = if link == LinkSettings::default() { 0 } else { LEAD_TICKS };
        let config = Config { lead_ticks, ..config };
        let mut wired = Self {
            host: Host::new(config, 1),
            board: Box::new(Firmware::new(Identity::emulated(capabilities, Reset::PowerUp))),
            to_board: Way::new(link, seed),
            to_host: Way::new(link, seed.wrapping_add(1)),
            now_us: 0,
            stalled_until_us: 0,
            unplugged_until_us: None,
            config,
            capabilities,
            sessions: 1,
        };
        wired.shake_hands();
        wired
    }

    /// Greets and configures before time begins, through the wire as it is: nothing moves meanwhile.
    fn shake_hands(&mut self) {
        while !self.board.server().is_configuring() && !self.is_over() {
            let mut bytes = Vec::new();
            self.host.give(self.now_us, &mut bytes);
            self.to_board.send(self.now_us, &bytes);
            let came = self.to_board.come(self.now_us);
            self.board.take(&came, LAST_US);
            let said = said(&mut self.board);
            self.to_host.send(self.now_us, &said);
            let came = self.to_host.come(self.now_us);
            self.host.take(&came, self.now_us);
            self.now_us += TICK_US;
        }
    }

    /// Whether the host drives the head, or can do so no more.
    pub(crate) const fn is_over(&self) -> bool {
        matches!(self.host.stage(), Stage::Running | Stage::Failed(_))
    }

    pub(crate) const fn board(&self) -> &Firmware {
        &self.board
    }

    pub(crate) const fn host(&self) -> &Host {
        &self.host
    }

    pub(crate) fn send(&mut self, command: Command) -> Result<(), Command> {
        self.host.send(command)
    }

    /// The next tick that the host knows of.
    pub(crate) fn next(&mut self) -> Option<Telemetry> {
        self.host.telemetry()
    }

    /// The host hangs for so long from now on.
    pub(crate) const fn stall(&mut self, ms: u32) {
        self.stalled_until_us = self.now_us + ms as u64 * TICK_US;
    }

    /// A bit of the board's configuration turns.
    pub(crate) fn spoil(&mut self, word: usize, bit: u32) {
        self.board.spoil(word, bit);
    }

    /// The host is gone, and another one comes after so long.
    pub(crate) fn kill_host(&mut self, ms: u32) {
        self.sessions += 1;
        self.host = Host::new(self.config, self.sessions);
        self.stall(ms);
    }

    /// Somebody pulls the cable, and puts it in again after so long.
    pub(crate) fn unplug(&mut self, ms: u32) {
        self.unplugged_until_us = Some(self.now_us + u64::from(ms) * TICK_US);
        self.to_board.cut(true);
        self.to_host.cut(true);
    }

    /// The board loses power for a moment; the host configures it anew.
    pub(crate) fn lose_power(&mut self) {
        self.capabilities.absolute = false;
        *self.board = Firmware::new(Identity::emulated(self.capabilities, Reset::BrownOut));
        self.sessions += 1;
        self.host = Host::new(self.config, self.sessions);
        self.shake_hands();
    }

    /// Whether the host has nothing to do with the head: it hangs.
    pub(crate) const fn is_stalled(&self) -> bool {
        self.now_us < self.stalled_until_us
    }

    /// A millisecond of both: the board senses this, and does that.
    pub(crate) fn tick(&mut self, sensed: &Sensed) -> Actuation {
        if self.unplugged_until_us.is_some_and(|until| until <= self.now_us) {
            self.unplugged_until_us = None;
            self.to_board.cut(false);
            self.to_host.cut(false);
            self.sessions += 1;
            self.host.connect_again(self.sessions);
        }
        if !self.is_stalled() {
            let mut bytes = Vec::new();
            self.host.give(self.now_us, &mut bytes);
            self.to_board.send(self.now_us, &bytes);
        }
        let came = self.to_board.come(self.now_us);
        self.board.take(&came, LAST_US);
        let actuation = self.board.tick(sensed);
        let said = said(&mut self.board);
        let answered_us = self.now_us + ANSWERED_US;
        self.to_host.send(answered_us, &said);
        if !self.is_stalled() {
            let came = self.to_host.come(answered_us);
            self.host.take(&came, answered_us);
        }
        self.now_us += TICK_US;
        actuation
    }

    /// What the host tells when it can drive the head no more: the last it knew, dark, with the fault that it is.
    pub(crate) fn failed(&self, last: &Telemetry) -> Option<Telemetry> {
        let Stage::Failed(trouble) = self.host.stage() else { return None };
        let fault = match trouble {
            HostTrouble::Reset => Fault::BoardReset,
            HostTrouble::Diverged(_) | HostTrouble::Law { .. } => Fault::TwinDiverged,
            _ => Fault::LinkLost,
        };
        let tick = last.tick.wrapping_add(1);
        let number = last.fault_number.wrapping_add(u32::from(last.fault() != Some(fault)));
        let record = FaultRecord { fault, number, tick, joint: None, exceeded: None };
        let mut darkness = DarknessSet::default();
        darkness.insert_if(true, Darkness::Faulted);
        Some(Telemetry {
            tick,
            phase: Phase::Faulted,
            latched: last.latched.filter(|latched| latched.fault == fault).or(Some(record)),
            fault_number: number,
            homed: false,
            actuation: Actuation::default(),
            darkness,
            ..*last
        })
    }
}

/// What a board says.
pub(crate) fn said(board: &mut Firmware) -> Vec<u8> {
    let mut bytes = vec![0; MOST_BYTES];
    let length = board.give(&mut bytes);
    bytes.truncate(length);
    bytes
}
