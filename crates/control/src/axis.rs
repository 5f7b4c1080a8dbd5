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
    /// Joint torque per volt of command beyond the amplifier's dead band, at standstill, N m/V.
    pub torque_nm_per_v: f32,
    /// Largest command beyond the dead band, V.
    pub limit_v: f32,
    /// Voltage of the turning motor against an amplifier that gives one, as volts of command for each rad/s, V s/rad; 0 for one that gives a current. What
    /// it takes from the torque is part of `friction`: here it tells how much current flows.
    pub back_emf_v_s_per_rad: f32,
    /// Command of which nothing comes, either sign, V.
    pub dead_band_v: f32,
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

impl AxisConfig {
    /// The command at the amplifier of which that much comes, V: it is beyond the dead band, unless nothing is to come.
    pub fn command_v(&self, beyond_v: f32) -> f32 {
        if self.dead_band_v == 0.0 { beyond_v } else { self.past_dead_band(beyond_v) }
    }

    /// Command of an amplifier with a dead band, V: see [`command_v`](Self::command_v). Apart, so that a tick of all others is no longer for it.
    #[cold]
    fn past_dead_band(&self, beyond_v: f32) -> f32 {
        if beyond_v == 0.0 { 0.0 } else { beyond_v + self.dead_band_v.copysign(beyond_v) }
    }

    /// What comes of a command at the amplifier, V: what it is beyond the dead band.
    pub fn beyond_v(&self, command_v: f32) -> f32 {
        (command_v.abs() - self.dead_band_v).max(0.0).copysign(command_v)
    }

    /// Current of the motor at a share of its amplifier's limit and at a speed, as a share of the largest at standstill.
    pub(crate) fn current_share(&self, share: f32, rate_rad_s: f32) -> f32 {
        if self.back_emf_v_s_per_rad == 0.0 { share } else { self.less_back_emf(share, rate_rad_s) }
    }

    /// Share of the current that an amplifier gives which gives a voltage. Apart, so that a tick of all others is no longer for it.
    #[cold]
    fn less_back_emf(&self, share: f32, rate_rad_s: f32) -> f32 {
        let own = self.back_emf_v_s_per_rad * rate_rad_s / self.limit_v;
        // a speed that is no number is told as such elsewhere, and must not become the heat of a motor
        if own.is_finite() { share - own } else { share }
    }
}
