use tracelight_rig::{JointLimits, PanTilt};

use crate::{FrictionModel, HeadModel};

/// Everything the controller is told before it starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// The head as it is believed to be.
    pub model: HeadModel,
    /// Each axis' electronics and gains.
    pub axes: PanTilt<AxisConfig>,
    /// Ticks the head may need to come back to its stroke before that is a fault.
    pub hold_limit_ticks: u32,
}

/// One axis: motor, encoder, friction, gains.
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
    /// Feedback.
    pub gains: Gains,
    /// What the joint may do.
    pub limits: JointLimits,
    /// How far the observer trusts model and encoder.
    pub observer: ObserverTuning,
}

/// PID gains from error to acceleration: kp in 1/s², ki in 1/s³, kd in 1/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains {
    /// Proportional.
    pub kp: f32,
    /// Integral.
    pub ki: f32,
    /// Derivative.
    pub kd: f32,
}

impl Gains {
    /// All three closed-loop poles of a double integrator at −ω: (s + ω)³ = s³ + 3ω s² + 3ω² s + ω³.
    pub const fn triple_pole(bandwidth_rad_s: f32) -> Self {
        let w = bandwidth_rad_s;
        Self { kp: 3.0 * w * w, ki: w * w * w, kd: 3.0 * w }
    }
}

/// Noise the observer assumes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObserverTuning {
    /// Spectral density of accelerations no model explains, (rad/s²)²·s.
    pub acceleration_noise: f32,
    /// Spectral density of the drift of unexplained torque, (N m)²/s.
    pub torque_drift: f32,
    /// Standard deviation of an edge's place, counts.
    pub edge_noise_counts: f32,
}

impl ObserverTuning {
    /// Found by sweeping each over four decades on 60 simulated heads with friction ±15 %, inertia and gravity ±5 %
    /// and 0.1-count edges; the minimum is flat within a decade.
    pub const DEFAULT: Self = Self { acceleration_noise: 1e-3, torque_drift: 1e-4, edge_noise_counts: 0.08 };
}
