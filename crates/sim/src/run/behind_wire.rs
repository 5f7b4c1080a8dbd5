//! A simulated head behind a wire: time passes until its host knows of another tick.

use std::collections::VecDeque;

use tracelight_board::Identity;
use tracelight_device::Host;
use tracelight_rig::wire::Reset;
use tracelight_rig::{Capabilities, TICK_F64_S};

use super::{Brain, SimulatedRig, Tick, open_loop};
use crate::RigConfig;
use crate::link::{Emulation, LinkSettings};
use crate::wired::{Firmware, LAST_US, Wired, said};

impl SimulatedRig {
    /// Puts a wire and a board there if the rig is to have them.
    pub(super) fn emulated(mut self, config: &RigConfig, seed: u64) -> Self {
        let Some(Emulation { link, troubles }) = &config.emulated else { return self };
        let tick = |s: f64| (s / TICK_F64_S) as u32;
        self.coming = troubles.iter().map(|&(s, trouble)| (tick(s), trouble)).collect();
        self.behind_wire(*link, seed)
    }

    /// Puts a wire with a board at its other end between the host and the head, which passes its first tick, in which nothing can be asked of it; it is the first
    /// that is told. Whether the head is homed stays as it is.
    #[must_use]
    pub fn behind_wire(mut self, link: LinkSettings, seed: u64) -> Self {
        let Brain::Here(brain) = &self.brain else { return self };
        let capabilities = self.capabilities();
        let wired = Wired::new(*brain.0.config(), capabilities, link, seed);
        self.brain = Brain::Wired(Box::new(wired), VecDeque::new());
        while matches!(&self.brain, Brain::Wired(wired, _) if !wired.is_over()) {
            self.pass_wired();
        }
        self
    }

    /// What its board would say that it has.
    fn capabilities(&self) -> Capabilities {
        Capabilities {
            stamps: self.open_loop.is_none(),
            gate_watched: self.sensed.laser_on.is_some(),
            light_watched: self.sensed.light.is_some(),
            gyroscope: self.has_gyroscope,
            times_ticks: true,
            absolute: matches!(&self.brain, Brain::Here(brain) if brain.1.is_homed()),
            inputs: self.sensed.inputs.opened_by(0),
        }
    }

    /// Gives it a board whose host is another program.
    pub fn served(self) -> ServedRig {
        let board = Box::new(Firmware::new(Identity::emulated(self.capabilities(), Reset::PowerUp)));
        ServedRig { rig: self, board, is_held: false }
    }

    /// The host of a head behind a wire.
    pub fn host(&self) -> Option<&Host> {
        match &self.brain {
            Brain::Here(_) => None,
            Brain::Wired(wired, _) => Some(wired.host()),
        }
    }

    /// Lets time pass until the host knows of another tick.
    pub(super) fn tick_wired(&mut self) -> Tick {
        loop {
            let Brain::Wired(wired, unseen) = &mut self.brain else { return self.truth() };
            if !wired.is_stalled()
                && let Some(telemetry) = wired.next()
            {
                // ticks of which no host will ever know are before those of which one knows
                let mut seen = unseen.pop_front();
                while seen.is_some_and(|(tick, _)| tick != telemetry.tick) {
                    seen = unseen.pop_front();
                }
                self.told = telemetry;
                let truth = seen.map_or_else(|| self.truth(), |(_, truth)| truth);
                return Tick { asked: self.asked(&telemetry), telemetry, ..truth };
            }
            let failed = wired.failed(&self.told);
            self.pass_wired();
            if let Some(telemetry) = failed {
                self.told = telemetry;
                return Tick { asked: self.asked(&telemetry), telemetry, ..self.truth() };
            }
        }
    }

    /// A millisecond of a head behind a wire.
    fn pass_wired(&mut self) {
        self.strike();
        self.stretch += self.stretch_per_tick;
        let truth = self.truth();
        let sensed = self.sensed;
        let Brain::Wired(wired, unseen) = &mut self.brain else { return };
        let actuation = wired.tick(&sensed);
        let machine = wired.board().machine();
        let open_loop = machine.state().map(open_loop).unwrap_or_default();
        unseen.push_back((machine.tick_number().wrapping_sub(1), truth));
        self.exchange(&actuation, &open_loop);
    }

    /// Lets happen what is due.
    fn strike(&mut self) {
        let Brain::Wired(wired, _) = &self.brain else { return };
        let now = wired.board().machine().tick_number();
        let (due, later) = self.coming.drain(..).partition::<Vec<_>, _>(|&(tick, _)| tick <= now);
        self.coming = later;
        due.into_iter().for_each(|(_, trouble)| self.suffer(trouble));
    }

    /// Does something with a board behind a wire, if there is one.
    pub(super) fn wired(&mut self, what: impl FnOnce(&mut Wired)) {
        if let Brain::Wired(wired, _) = &mut self.brain {
            what(wired);
        }
    }
}

/// A simulated head with its board, whose host is another program: bytes come in, bytes go out. A board without a configuration drives no motors, and the head
/// sinks as it would.
#[derive(Clone, Debug)]
pub struct ServedRig {
    rig: SimulatedRig,
    board: Box<Firmware>,
    /// Somebody holds it until its motors do.
    is_held: bool,
}

impl ServedRig {
    /// Has the board say that it is of another kind, to practise with: whoever drives it asks a person to arm.
    #[must_use]
    pub fn posing_as(self, kind: u16) -> Self {
        let identity =
            Identity { board: kind, ..Identity::emulated(self.rig.capabilities(), Reset::PowerUp) };
        Self { board: Box::new(Firmware::new(identity)), ..self }
    }

    /// Has somebody hold the head where it is until its board is configured.
    #[must_use]
    pub fn held(self) -> Self {
        Self { is_held: true, ..self }
    }

    /// A millisecond in which these bytes came; what the board says, if it may.
    pub fn pass(&mut self, came: &[u8], may_say: bool) -> Vec<u8> {
        self.board.take(came, LAST_US);
        let actuation = self.board.tick(&self.rig.sensed);
        let state = self.board.machine().state();
        if state.is_some() || !self.is_held {
            self.rig.exchange(&actuation, &state.map(open_loop).unwrap_or_default());
        }
        if may_say { said(&mut self.board) } else { Vec::new() }
    }

    /// Whether light falls.
    pub fn is_lit(&self) -> bool {
        self.rig.plant.light()
    }
}
