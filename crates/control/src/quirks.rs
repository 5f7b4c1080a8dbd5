//! Effects of a joint outside the rigid-body model: break-away friction, misplaced edges, ripple, cables.

use crate::elementary::sin_cos;
use crate::estimate::Learned;

/// What a joint has beyond its equations, as far as it was identified; zeros where it was not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quirks {
    /// Friction above its Coulomb level near standstill, N m.
    pub break_away_nm: f32,
    /// Speed at which that excess has fallen to 1/e, rad/s.
    pub break_away_rad_s: f32,
    /// How far the four kinds of edges lie beyond their places, counts; edge n is the one below count n, and n mod 4 its kind.
    pub edges_counts: [f32; 4],
    /// Change of Coulomb friction with the angle.
    pub ripple: Ripple,
    /// What its cables do.
    pub cable: Cable,
}

/// Cables that hang on a joint: `load_nm` − `spring_nm_per_rad` q acts on it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cable {
    /// N m at zero.
    pub load_nm: f32,
    /// N m/rad.
    pub spring_nm_per_rad: f32,
}

/// Friction that ripples over a turn of a joint, as gears make it: `sin_nm` sin(nq) + `cos_nm` cos(nq) on top of the Coulomb
/// level, either way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ripple {
    /// n, periods a turn.
    pub periods: f32,
    /// N m.
    pub sin_nm: f32,
    /// N m.
    pub cos_nm: f32,
}

impl Quirks {
    /// Of a joint of which nothing is known; break-away friction falls at such speeds on geared joints.
    pub const NONE: Self = Self {
        break_away_nm: 0.0,
        break_away_rad_s: 0.02,
        edges_counts: [0.0; 4],
        ripple: Ripple { periods: 0.0, sin_nm: 0.0, cos_nm: 0.0 },
        cable: Cable { load_nm: 0.0, spring_nm_per_rad: 0.0 },
    };

    /// Share of the break-away excess that is left at a speed. Stribeck's curve exp(−x²) as (1 + x²/8)⁻⁸, which is within
    /// 0.033 of it and has the same bits everywhere.
    pub(crate) fn break_away_share(&self, velocity_rad_s: f32) -> f32 {
        let ratio = velocity_rad_s / self.break_away_rad_s;
        let fall = 1.0 / (1.0 + 0.125 * ratio * ratio);
        let squared = fall * fall;
        squared * squared * squared * squared
    }

    /// What friction has beyond its Coulomb level at an angle and a speed, with what was learned besides, N m.
    pub(crate) fn excess_nm(&self, learned: &Learned, angle_rad: f32, velocity_rad_s: f32) -> f32 {
        self.ripple.friction_nm(angle_rad)
            + learned.friction_nm
            + self.break_away_share(velocity_rad_s) * learned.break_away_nm
    }
}

impl Cable {
    /// What acts at an angle, N m.
    pub(crate) fn torque_nm(&self, angle_rad: f32) -> f32 {
        self.load_nm - self.spring_nm_per_rad * angle_rad
    }
}

impl Ripple {
    /// What friction has on top at an angle, N m.
    pub(crate) fn friction_nm(&self, angle_rad: f32) -> f32 {
        if self.sin_nm == 0.0 && self.cos_nm == 0.0 {
            return 0.0;
        }
        let (sin, cos) = sin_cos(self.periods * angle_rad);
        self.sin_nm * sin + self.cos_nm * cos
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_of_break_away_friction_is_stribecks() {
        for k in 0..500 {
            let x = k as f32 * 0.01;
            let off = Quirks::NONE.break_away_share(x * Quirks::NONE.break_away_rad_s) - libm::expf(-x * x);
            assert!(off.abs() < 0.033, "{x}: {off}");
        }
    }
}
