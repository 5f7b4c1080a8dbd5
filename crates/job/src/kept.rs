//! A room whose every tick is kept, whoever lets them pass.

use tracelight_eye::{Eye, Shot};
use tracelight_rig::{Command, Rig, Telemetry};
use tracelight_sim::{Room, Simulated, Tick};

/// A room, and who keeps its ticks.
pub(crate) struct Kept<'a> {
    pub(crate) room: &'a mut Room,
    pub(crate) keep: &'a mut dyn FnMut(&Tick),
}

impl Rig for Kept<'_> {
    fn send(&mut self, command: Command) -> Result<(), Command> {
        self.room.send(command)
    }

    fn next(&mut self) -> Option<Telemetry> {
        Some(self.step().telemetry)
    }
}

impl Simulated for Kept<'_> {
    fn step(&mut self) -> Tick {
        let tick = self.room.step();
        (self.keep)(&tick);
        tick
    }

    fn told(&self) -> &Telemetry {
        self.room.told()
    }

    fn patience_ticks(&self) -> usize {
        self.room.patience_ticks()
    }
}

impl Eye for Kept<'_> {
    fn expose(&mut self, exposure_s: f64) {
        Eye::expose(self.room, exposure_s);
    }

    fn longest_s(&self) -> f64 {
        self.room.longest_s()
    }

    fn shot(&mut self) -> Option<Shot> {
        self.room.shot()
    }
}
