use tracelight_control::{Config, FrictionModel, HeadModel};
use tracelight_rig::{Actuation, Head, Joint, Measurement, PanTilt, Sensed, TICK_F64_S};

use crate::config::RigConfig;
use crate::truth::Truth;

/// Counts a turn of an encoder that quantizes nothing that matters: 60 nrad.
const COUNTS_PER_REV: f64 = 1e8;
/// Substeps in a tick.
const SUBSTEPS: u32 = 10;
/// A voltage that limits nothing.
const NO_LIMIT_V: f32 = 1e9;

/// Two joints by themselves, J q̈ + b q̇ + k q = τ: what is left of a head at rest in a pose once Coulomb friction,
/// quantizer, amplifier's limit and coupling are left out, and the constant part of gravity with them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinearHead {
    inertia_kg_m2: PanTilt<f64>,
    viscous: PanTilt<f64>,
    stiffness: PanTilt<f64>,
    torque_nm_per_v: PanTilt<f64>,
    angle_rad: PanTilt<f64>,
    rate_rad_s: PanTilt<f64>,
}

impl LinearHead {
    pub(crate) fn new(rig: &RigConfig, pose_rad: PanTilt<f64>) -> Self {
        /// Step of the central difference, rad: the slope's error is 1e-9 of it.
        const STEP_RAD: f64 = 1e-4;
        let truth = &rig.truth.model;
        let lumped = truth.bodies.lumped();
        let gravity = |tilt: f64| lumped.gravity(tilt).tilt;
        let slope =
            (gravity(pose_rad.tilt + STEP_RAD) - gravity(pose_rad.tilt - STEP_RAD)) / (2.0 * STEP_RAD);
        Self {
            inertia_kg_m2: lumped.mass(pose_rad.tilt).own_inertia(),
            viscous: PanTilt::from_fn(|j| truth.felt_friction(j).mean_viscous()),
            stiffness: PanTilt::new(0.0, slope),
            torque_nm_per_v: truth.motors.map(|m| m.torque_nm_per_v),
            angle_rad: PanTilt::default(),
            rate_rad_s: PanTilt::default(),
        }
    }

    /// What a law that drives this head is told: the rig's settings, and nothing that is not linear.
    pub(crate) fn control_config(&self, rig: &RigConfig) -> Config {
        let mut config = rig.control_config();
        config.model = HeadModel { gravity_c: 0.0, gravity_s: 0.0, ..config.model };
        for joint in Joint::BOTH {
            let axis = &mut config.axes[joint];
            axis.count_rad = (std::f64::consts::TAU / COUNTS_PER_REV) as f32;
            (axis.limit_v, axis.dead_band_v) = (NO_LIMIT_V, 0.0);
            let viscous = self.viscous[joint] as f32;
            axis.friction =
                FrictionModel { viscous_pos: viscous, viscous_neg: viscous, ..FrictionModel::default() };
        }
        config
    }
}

impl Head for LinearHead {
    fn exchange(&mut self, actuation: &Actuation) -> Sensed {
        let step_s = TICK_F64_S / f64::from(SUBSTEPS);
        for joint in Joint::BOTH {
            let torque = f64::from(actuation.command_v[joint]) * self.torque_nm_per_v[joint];
            let (angle, rate) = (&mut self.angle_rad[joint], &mut self.rate_rad_s[joint]);
            for _ in 0..SUBSTEPS {
                let before = *rate;
                let drive = torque - self.viscous[joint] * before - self.stiffness[joint] * *angle;
                *rate += step_s * drive / self.inertia_kg_m2[joint];
                *angle += 0.5 * step_s * (before + *rate);
            }
        }
        let count = |angle: f64| (angle * COUNTS_PER_REV / std::f64::consts::TAU).round() as i32;
        let encoders = self.angle_rad.map(|angle| Measurement { count: count(angle), edge_age_ticks: None });
        Sensed { encoders, ..Sensed::default() }
    }
}

impl Truth for LinearHead {
    fn angle_rad(&self) -> PanTilt<f64> {
        self.angle_rad
    }
}
