use tracelight_dynamics::Friction;
use tracelight_maths::{exp, sin};

use crate::wear::Wear;

/// Periods of the friction ripple in a turn of a joint: of the order of a gear's teeth.
const RIPPLE_PERIODS: f64 = 40.0;

/// Friction of one joint with wear: the set-valued law that the stepper resolves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WornFriction {
    pub(crate) nominal: Friction,
    excess: f64,
    stribeck_speed_rad_s: f64,
    ripple: f64,
    ripple_phase_rad: f64,
}

/// Coulomb levels and viscous slopes that hold for one substep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Levels {
    pub(crate) pos_nm: f64,
    pub(crate) neg_nm: f64,
}

impl WornFriction {
    pub(crate) fn new(nominal: Friction, wear: &Wear, ripple_phase_rad: f64) -> Self {
        Self {
            nominal,
            excess: wear.stribeck_ratio - 1.0,
            stribeck_speed_rad_s: wear.stribeck_speed_rad_s,
            ripple: wear.friction_ripple,
            ripple_phase_rad,
        }
    }

    /// Stribeck's curve (Armstrong-Hélouvry, Dupont & Canudas de Wit 1994, eq. 5 with exponent 2) times the ripple.
    #[inline]
    pub(crate) fn levels(&self, angle_rad: f64, rate_rad_s: f64) -> Levels {
        let mut scale = 1.0;
        if self.excess != 0.0 {
            let ratio = rate_rad_s / self.stribeck_speed_rad_s;
            scale += self.excess * exp(-ratio * ratio);
        }
        if self.ripple != 0.0 {
            scale *= 1.0 + self.ripple * sin(RIPPLE_PERIODS * angle_rad + self.ripple_phase_rad);
        }
        Levels { pos_nm: scale * self.nominal.coulomb_pos_nm, neg_nm: scale * self.nominal.coulomb_neg_nm }
    }
}
