use tracelight_rig::{JointLimits, PanTilt};

use crate::{FrictionModel, HeadModel, LawConfig, MotorRating, ObserverConfig};

/// Everything the controller is told before it starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// The head as it is believed to be.
    pub model: HeadModel,
    /// Each axis.
    pub axes: PanTilt<AxisConfig>,
    /// Ticks the head may need to come back to its stroke before that is a fault.
    pub hold_limit_ticks: u32,
    /// From the gate's rise to light, ticks.
    pub laser_on_ticks: u32,
    /// From the gate's fall to dark, ticks.
    pub laser_off_ticks: u32,
    /// Ticks a host that has said it is there may be silent.
    pub host_silence_ticks: u32,
}

/// One axis: motor, encoder, friction, observer, law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisConfig {
    /// Joint torque per volt of command, N m/V.
    pub torque_nm_per_v: f32,
    /// Largest command, V.
    pub limit_v: f32,
    /// Width of one encoder count, rad.
    pub count_rad: f32,
    /// Friction as it is believed to be.
    pub friction: FrictionModel,
    /// Torque by which the model may be wrong, N m: what the Kalman filter's deviations are shares of. The joint's Coulomb
    /// friction, where it has any to speak of.
    pub unknown_nm: f32,
    /// How counts become position and velocity.
    pub observer: ObserverConfig,
    /// How they become torque.
    pub law: LawConfig,
    /// How much the motor may be driven.
    pub rating: MotorRating,
    /// What the joint may do.
    pub limits: JointLimits,
}
