use tracelight_dynamics::{Friction, HeadBodies, Motor};
use tracelight_rig::PanTilt;

use crate::Stepper;
use crate::foot::{FootConfig, GyroscopeConfig};
use crate::friction::WornFriction;
use crate::wear::Wear;

/// An incremental encoder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EncoderConfig {
    /// Counts per revolution of the joint.
    pub counts_per_rev: u32,
    /// Whether the hardware stamps edges with their time.
    pub edge_stamps: bool,
}

impl EncoderConfig {
    /// Width of one count, rad.
    pub fn count_rad(&self) -> f64 {
        std::f64::consts::TAU / f64::from(self.counts_per_rev)
    }
}

/// A switch of the laser: the relay between gate and laser, or what the enable drives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelayConfig {
    /// From its command's rise to light, s.
    pub on_s: f64,
    /// From its command's fall to dark, s.
    pub off_s: f64,
}

/// Everything a plant is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlantConfig {
    /// Masses.
    pub bodies: HeadBodies,
    /// Friction as identified at speed.
    pub friction: PanTilt<Friction>,
    /// Amplifiers and motors.
    pub motors: PanTilt<Motor>,
    /// Encoders, both alike.
    pub encoder: EncoderConfig,
    /// The laser's relay.
    pub relay: RelayConfig,
    /// The laser's second switch, in series with it.
    pub enable: RelayConfig,
    /// What it stands on.
    pub foot: FootConfig,
    /// What is fixed to that.
    pub gyroscope: GyroscopeConfig,
    /// What is worse than that.
    pub wear: Wear,
}

impl PlantConfig {
    /// The equations of motion ready to be stepped; `ripple_phase_rad` places the friction ripple of each joint.
    pub fn stepper(&self, ripple_phase_rad: PanTilt<f64>) -> Stepper {
        Stepper::new(self.bodies.lumped(), self.friction(ripple_phase_rad))
    }

    pub(crate) fn friction(&self, ripple_phase_rad: PanTilt<f64>) -> PanTilt<WornFriction> {
        PanTilt::from_fn(|j| WornFriction::new(self.friction[j], &self.wear, ripple_phase_rad[j]))
    }
}
