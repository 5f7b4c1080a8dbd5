//! Checks that the laser's two switches follow their commands, as far as sensors show it.

use tracelight_rig::{Actuation, Fault, Sensed};

use crate::config::Config;
use crate::finding::Finding;

/// Ticks a laser may take longer than its switch.
pub(super) const SLACK_TICKS: u32 = 2;

/// What a switch is told, and for how long.
#[derive(Clone, Copy, Debug)]
struct Told {
    on: bool,
    ticks: u32,
}

impl Told {
    /// Off just now: nobody knows what it was told before.
    const OFF: Self = Self { on: false, ticks: 0 };

    const fn tell(&mut self, on: bool) {
        self.ticks = if on == self.on { self.ticks.saturating_add(1) } else { 1 };
        self.on = on;
    }

    /// Whether it must have followed by now, by how many ticks it takes on and off.
    const fn has_followed(self, (on_ticks, off_ticks): (u32, u32)) -> bool {
        self.ticks > (if self.on { on_ticks } else { off_ticks }) + SLACK_TICKS
    }
}

/// Watch on the laser: the gate's switch by its second contact, both by the light that leaves the head. What neither shows is not known.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LaserWatch {
    gate: Told,
    enable: Told,
}

impl LaserWatch {
    pub(super) const fn new() -> Self {
        Self { gate: Told::OFF, enable: Told::OFF }
    }

    /// What both switches are told in this tick.
    pub(crate) const fn tell(&mut self, actuation: &Actuation) {
        self.gate.tell(actuation.gate);
        self.enable.tell(actuation.enable);
    }

    /// Whether light was wanted in the last tick.
    pub(crate) const fn lights(&self) -> bool {
        self.gate.on && self.enable.on
    }

    /// Whether both switches must have done what they were told.
    pub(crate) const fn is_settled(&self, config: &Config) -> bool {
        self.gate_followed(config) && self.enable_followed(config)
    }

    const fn gate_followed(&self, config: &Config) -> bool {
        self.gate.has_followed((config.laser_on_ticks, config.laser_off_ticks))
    }

    const fn enable_followed(&self, config: &Config) -> bool {
        self.enable.has_followed((config.enable_on_ticks, config.enable_off_ticks))
    }

    /// What is seen of light that may fall, where anything is: a photodiode's word, or that of the gate's switch while the other may be closed.
    /// The worse of the two counts.
    pub(crate) fn seen_light(&self, config: &Config, sensed: &Sensed) -> Option<bool> {
        let may_pass = self.enable.on || !self.enable_followed(config);
        let through = sensed.laser_on.map(|on| on && may_pass);
        sensed.light.into_iter().chain(through).reduce(|light, other| light || other)
    }

    /// What is seen of the switches that they were not told, if anything. Light tells of both: one that was told long enough ago to open lets none
    /// through.
    pub(crate) fn sense(&self, config: &Config, sensed: &Sensed) -> Option<Finding> {
        let (gate, enable) = (self.gate_followed(config), self.enable_followed(config));
        let (is_open, is_closed) = (gate && !self.gate.on, gate && self.gate.on);
        let is_dark = is_open || (enable && !self.enable.on);
        let is_lit = is_closed && enable && self.enable.on;
        if (is_open && sensed.laser_on == Some(true)) || (is_dark && sensed.light == Some(true)) {
            return Some(Finding::of(Fault::LaserStuck));
        }
        let missing =
            (is_closed && sensed.laser_on == Some(false)) || (is_lit && sensed.light == Some(false));
        missing.then_some(Finding::of(Fault::LaserDark))
    }
}
