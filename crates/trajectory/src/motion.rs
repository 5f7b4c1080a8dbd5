//! State of motion of a joint at one time.

use tracelight_rig::TICK_F64_S;

use crate::retime::along::{Along, hermite};

/// Angle, speed and acceleration of one joint, in `f64`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointMotion {
    /// Angle, rad.
    pub position_rad: f64,
    /// Speed, rad/s.
    pub velocity_rad_s: f64,
    /// Acceleration, rad/s².
    pub acceleration_rad_s2: f64,
}

impl JointMotion {
    /// Standing still.
    pub fn at_rest(position_rad: f64) -> Self {
        Self { position_rad, ..Self::default() }
    }

    /// Returns the quintic that joins this state to `there` after `ticks`; coefficients per tickⁱ.
    pub fn quintic_to(&self, there: &Self, ticks: f64) -> [f64; 6] {
        let per_tick = |m: &Self| Along {
            s: m.position_rad,
            v: m.velocity_rad_s * TICK_F64_S,
            a: m.acceleration_rad_s2 * TICK_F64_S * TICK_F64_S,
        };
        hermite(per_tick(self), per_tick(there), ticks)
    }
}
