//! Configuration of one axis.

use tracelight_rig::JointLimits;

use crate::creep::Creep;
use crate::law::LawConfig;
use crate::model::FrictionModel;
use crate::observer::config::ObserverConfig;
use crate::quirks::Quirks;
use crate::watch::MotorRating;

/// One axis: motor, encoder, friction, observer, law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisConfig {
    /// Joint torque per volt of command, N m/V.
    pub torque_nm_per_v: f32,
    /// Largest command, V.
    pub limit_v: f32,
    /// Width of one encoder count, rad.
    pub count_rad: f32,
    /// The friction model.
    pub friction: FrictionModel,
    /// Torque by which the model may be wrong, N m: what the Kalman filter's deviations are shares of. The joint's Coulomb
    /// friction, where it has any to speak of.
    pub unknown_nm: f32,
    /// By how much what the encoder shows of a motion may differ from what the motor's torque must have made, as a share: what is not known of
    /// motor, inertia and friction together.
    pub scale_tolerance: f32,
    /// What this very joint has beyond its equations.
    pub quirks: Quirks,
    /// How counts become position and velocity.
    pub observer: ObserverConfig,
    /// How they become torque.
    pub law: LawConfig,
    /// How it follows a plan slower than friction lets go; `None`: as any other.
    pub creep: Option<Creep>,
    /// How much the motor may be driven.
    pub rating: MotorRating,
    /// What the joint may do.
    pub limits: JointLimits,
}
