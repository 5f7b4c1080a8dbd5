use tracelight_rig::{Fault, TICK_S};

use crate::finding::Finding;

/// Share of an amplifier's limit from which on it is saturated.
const SATURATED: f32 = 0.999;
/// For how long an amplifier may give all it has in one direction, ticks: the longest move of a joint at full torque,
/// half a turn, speeds up for 0.64 s and is planned at less; what goes on for half of that is stuck.
pub(super) const SATURATED_TICKS: u32 = 300;

/// How much a motor may be driven.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotorRating {
    /// Share of the current at its amplifier's limit that it stands for ever, 0 to 1.
    pub continuous_share: f32,
    /// Time constant of its temperature, s.
    pub heating_s: f32,
}

/// Watch on one motor and its amplifier.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct MotorWatch {
    saturated_ticks: u32,
    upwards: bool,
    /// Temperature over its surroundings, as a share of what full drive would make of it: the square of the current,
    /// smoothed (I²t).
    heat: f32,
}

impl MotorWatch {
    /// One tick with that share of its amplifier's limit, −1 to 1, and that current as a share of the largest at standstill; the fault it shows, if any.
    pub(super) fn tick(&mut self, rating: &MotorRating, share: f32, current: f32) -> Option<Finding> {
        let (saturated, upwards) = (share.abs() >= SATURATED, share > 0.0);
        let goes_on = saturated && upwards == self.upwards;
        self.saturated_ticks = if goes_on { self.saturated_ticks + 1 } else { u32::from(saturated) };
        self.upwards = upwards;
        self.heat += TICK_S / rating.heating_s * (current * current - self.heat);
        let most = rating.continuous_share * rating.continuous_share;
        if self.saturated_ticks > SATURATED_TICKS {
            Some(Finding::after(Fault::AmplifierSaturated, self.saturated_ticks, SATURATED_TICKS))
        } else {
            (self.heat > most).then(|| Finding::beyond(Fault::MotorHot, self.heat, most))
        }
    }

    pub(super) const fn heat(&self) -> f32 {
        self.heat
    }

    pub(super) const fn set_heat(&mut self, heat: f32) {
        self.heat = heat;
    }

    /// A motor stays as hot as it is, whoever arms.
    pub(super) fn rearm(&mut self) {
        self.saturated_ticks = 0;
    }
}
