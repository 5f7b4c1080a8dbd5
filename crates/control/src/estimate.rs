//! The estimated state of a joint, and the torques that act on it.

use tracelight_rig::Measurement;

/// What a joint has shown to be different from its model.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Learned {
    /// Torque that acts on it besides, N m.
    pub load_nm: f32,
    /// Coulomb friction beyond the model's, either way, N m.
    pub friction_nm: f32,
    /// What friction has on top of that near standstill, N m.
    pub break_away_nm: f32,
    /// Inertia beyond the model's, as a share of it.
    pub inertia_share: f32,
}

/// Estimated state of one joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// Angle, rad.
    pub position_rad: f32,
    /// Angular velocity, rad/s.
    pub velocity_rad_s: f32,
    /// Angular acceleration, rad/s².
    pub acceleration_rad_s2: f32,
    /// What the model does not know of this head; nothing for observers that have no model.
    pub learned: Learned,
    /// Counts that are to be added to what its encoder reads, because it lost some or made some up, as far as that was noticed.
    pub lost_counts: i32,
    /// Whether counts were corrected recently and the next edges must confirm the correction.
    pub is_doubtful: bool,
    /// How far off what is taken for load and friction together may be: a standard deviation, N m.
    pub torque_deviation_nm: f32,
}

impl Estimate {
    /// The count a joint is on whose encoder reads that.
    pub(crate) const fn count(&self, measured: &Measurement) -> i32 {
        measured.count.wrapping_add(self.lost_counts)
    }

    /// Whether every number of it is one.
    pub(crate) fn is_finite(&self) -> bool {
        let Learned { load_nm, friction_nm, break_away_nm, inertia_share } = self.learned;
        let motion = self.position_rad + self.velocity_rad_s + self.acceleration_rad_s2;
        let learned = load_nm + friction_nm + break_away_nm + inertia_share;
        (motion + learned + self.torque_deviation_nm).is_finite()
    }
}

/// What acted on a joint during the last tick, as far as is known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Effort {
    /// Torque of the motor, N m.
    pub torque_nm: f32,
    /// Torque of gravity, Coriolis, the other joint's acceleration and cables, N m.
    pub bias_nm: f32,
    /// Inertia the joint feels, kg m².
    pub inertia_kg_m2: f32,
}
