//! What is tried in a lesson, and what a plot shows of it.

use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_sim::BenchTick;

use crate::step::StepFigures;

/// Distance of the target in mm that angles are shown at: 3 ft.
const DISTANCE_MM: f64 = 914.4;

/// What an angle is on a target 3 ft away, mm.
pub(super) fn mm(angle_rad: f64) -> f64 {
    DISTANCE_MM * angle_rad
}

/// Something a joint did.
#[derive(Clone, Debug)]
pub struct Experiment {
    /// What was done.
    pub name: String,
    /// Which joint is looked at.
    pub joint: Joint,
    /// What happened.
    pub ticks: Vec<BenchTick>,
}

impl Experiment {
    /// True angles, rad, a tick each.
    pub(super) fn angles_rad(&self) -> Vec<f64> {
        self.ticks.iter().map(|tick| tick.angle_rad[self.joint]).collect()
    }

    /// Of a step to `to_rad`.
    pub(super) fn figures(&self, to_rad: f64) -> StepFigures {
        StepFigures::of(&self.angles_rad(), to_rad, TICK_F64_S)
    }
}

/// What a panel shows over time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// True angle, °.
    Angle,
    /// Setpoint less true angle, mm on a target 3 ft away.
    Error,
    /// V at the amplifier.
    Command,
    /// What the observer says, rad/s.
    Speed,
}

impl Quantity {
    /// With its unit.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Angle => "angle, °",
            Self::Error => "error, mm",
            Self::Command => "command, V",
            Self::Speed => "speed as seen, rad/s",
        }
    }

    /// In a tick.
    pub fn of(self, tick: &BenchTick, joint: Joint) -> f64 {
        match self {
            Self::Angle => tick.angle_rad[joint].to_degrees(),
            Self::Error => mm(f64::from(tick.setpoint[joint].position_rad) - tick.angle_rad[joint]),
            Self::Command => f64::from(tick.command_v[joint]),
            Self::Speed => f64::from(tick.estimates[joint].velocity_rad_s),
        }
    }
}
