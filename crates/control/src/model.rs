use crate::elementary::sin_cos;
use crate::limit::within;
use tracelight_rig::{Joint, PanTilt};

/// The head's inertia and gravity in nine sums, `f32`; s and c are sine and cosine of tilt.
///
/// M₁₁ = `m11_fixed` + `m11_ss` s² + `m11_sc` s c + `m11_cc` c², M₁₂ = `m12_s` s + `m12_c` c, M₂₂ = `m22`, all
/// kg m²; gravity's torque on tilt is −(`gravity_c` c + `gravity_s` s), N m.
#[allow(missing_docs, reason = "the formula above names every field")]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HeadModel {
    pub m11_fixed: f32,
    pub m11_ss: f32,
    pub m11_sc: f32,
    pub m11_cc: f32,
    pub m12_s: f32,
    pub m12_c: f32,
    pub m22: f32,
    pub gravity_c: f32,
    pub gravity_s: f32,
}

/// Mass matrix and velocity- and position-dependent torques at one pose.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Terms {
    pub(crate) m11: f32,
    pub(crate) m12: f32,
    pub(crate) m22: f32,
    pub(crate) bias_nm: PanTilt<f32>,
}

impl HeadModel {
    /// A bound on the inertia a joint feels, kg m².
    pub(crate) fn own_inertia_at_most(&self, joint: Joint) -> f32 {
        match joint {
            Joint::Pan => self.m11_fixed + self.m11_ss.max(0.0) + self.m11_sc.abs() + self.m11_cc.max(0.0),
            Joint::Tilt => self.m22,
        }
    }

    /// M(q) and C(q, q̇) + G(q).
    pub(crate) fn terms(&self, tilt_rad: f32, rate_rad_s: PanTilt<f32>) -> Terms {
        let (s, c) = sin_cos(tilt_rad);
        let d11 = 2.0 * s * c * (self.m11_ss - self.m11_cc) + (c * c - s * s) * self.m11_sc;
        let d12 = c * self.m12_s - s * self.m12_c;
        let (w1, w2) = (rate_rad_s.pan, rate_rad_s.tilt);
        let coriolis = d11 * w1 * w2 + d12 * w2 * w2;
        let centrifugal = -0.5 * d11 * w1 * w1;
        Terms {
            m11: self.m11_fixed + s * s * self.m11_ss + s * c * self.m11_sc + c * c * self.m11_cc,
            m12: s * self.m12_s + c * self.m12_c,
            m22: self.m22,
            bias_nm: PanTilt::new(coriolis, centrifugal - self.gravity_c * c - self.gravity_s * s),
        }
    }
}

impl Terms {
    /// M·a.
    pub(crate) fn inertial(&self, acceleration: PanTilt<f32>) -> PanTilt<f32> {
        PanTilt::new(
            self.m11 * acceleration.pan + self.m12 * acceleration.tilt,
            self.m12 * acceleration.pan + self.m22 * acceleration.tilt,
        )
    }

    /// Each joint's own inertia.
    pub(crate) const fn own_inertia(&self) -> PanTilt<f32> {
        PanTilt::new(self.m11, self.m22)
    }
}

/// Friction of one joint: τ = Fv ω + Fc for ω > 0, with the negative side's own slope and (negative) intercept.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrictionModel {
    /// Slope for positive speeds, N m s/rad.
    pub viscous_pos: f32,
    /// Slope for negative speeds, N m s/rad.
    pub viscous_neg: f32,
    /// Intercept for positive speeds, N m, ≥ 0.
    pub coulomb_pos_nm: f32,
    /// Intercept for negative speeds, N m, ≤ 0.
    pub coulomb_neg_nm: f32,
}

impl FrictionModel {
    /// Speed after one step for a joint with momentum `b` (friction not yet taken): it slides past either Coulomb
    /// level and sticks between them.
    pub(crate) fn resolve(&self, b: f32, inertia: f32, step_s: f32) -> f32 {
        let (pos, neg) = (step_s * self.coulomb_pos_nm, step_s * self.coulomb_neg_nm);
        if b > pos {
            (b - pos) / (inertia + step_s * self.viscous_pos)
        } else if b < neg {
            (b - neg) / (inertia + step_s * self.viscous_neg)
        } else {
            0.0
        }
    }

    /// Adds `excess_nm` to the Coulomb friction of both directions; the sum never becomes negative friction.
    pub(crate) fn with_excess(&self, excess_nm: f32) -> Self {
        Self {
            coulomb_pos_nm: (self.coulomb_pos_nm + excess_nm).max(0.0),
            coulomb_neg_nm: (self.coulomb_neg_nm - excess_nm).min(0.0),
            ..*self
        }
    }

    /// Torque that keeps a motion at `rate_rad_s` going, the Coulomb part faded in over `fade_rad_s`.
    pub(crate) fn feedforward(&self, rate_rad_s: f32, fade_rad_s: f32) -> f32 {
        let share = within(rate_rad_s / fade_rad_s, 1.0);
        if rate_rad_s >= 0.0 {
            self.viscous_pos * rate_rad_s + share * self.coulomb_pos_nm
        } else {
            self.viscous_neg * rate_rad_s - share * self.coulomb_neg_nm
        }
    }
}
