use tracelight_maths::sin_cos;
use tracelight_rig::PanTilt;

/// The head's inertial and gravitational parameters, gathered: s and c are sine and cosine of tilt.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lumped {
    /// Part of M₁₁ that does not change, kg m².
    pub m11_fixed: f64,
    /// M₁₁ per s².
    pub m11_ss: f64,
    /// M₁₁ per s·c.
    pub m11_sc: f64,
    /// M₁₁ per c².
    pub m11_cc: f64,
    /// M₁₂ per s.
    pub m12_s: f64,
    /// M₁₂ per c.
    pub m12_c: f64,
    /// M₂₂, constant.
    pub m22: f64,
    /// Gravity torque on tilt is −(gravity_c c + gravity_s s), N m.
    pub gravity_c: f64,
    /// See [`gravity_c`](Self::gravity_c).
    pub gravity_s: f64,
}

/// Symmetric 2×2 mass matrix, kg m²; 1 is pan, 2 is tilt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassMatrix {
    /// Pan on pan.
    pub m11: f64,
    /// Coupling.
    pub m12: f64,
    /// Tilt on tilt.
    pub m22: f64,
}

/// What the torques of [`Lumped::bias`] change by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BiasSlopes {
    /// A radian of tilt, N m/rad.
    pub by_tilt: PanTilt<f64>,
    /// A rad/s of pan, N m s/rad.
    pub by_pan_rate: PanTilt<f64>,
    /// A rad/s of tilt, N m s/rad.
    pub by_tilt_rate: PanTilt<f64>,
}

impl MassMatrix {
    /// Each joint's own inertia, kg m².
    pub const fn own_inertia(&self) -> PanTilt<f64> {
        PanTilt::new(self.m11, self.m22)
    }

    /// M·a.
    pub fn times(&self, a: PanTilt<f64>) -> PanTilt<f64> {
        PanTilt::new(self.m11 * a.pan + self.m12 * a.tilt, self.m12 * a.pan + self.m22 * a.tilt)
    }

    /// M⁻¹·b. Never singular for bodies with mass.
    pub fn solve(&self, b: PanTilt<f64>) -> PanTilt<f64> {
        let det = self.m11 * self.m22 - self.m12 * self.m12;
        PanTilt::new(
            (self.m22 * b.pan - self.m12 * b.tilt) / det,
            (self.m11 * b.tilt - self.m12 * b.pan) / det,
        )
    }
}

impl Lumped {
    /// M(tilt).
    #[inline]
    pub fn mass(&self, tilt_rad: f64) -> MassMatrix {
        let (s, c) = sin_cos(tilt_rad);
        self.mass_at(s, c)
    }

    #[inline]
    fn mass_at(&self, s: f64, c: f64) -> MassMatrix {
        MassMatrix {
            m11: self.m11_fixed + s * s * self.m11_ss + s * c * self.m11_sc + c * c * self.m11_cc,
            m12: s * self.m12_s + c * self.m12_c,
            m22: self.m22,
        }
    }

    /// C(q, q̇) + G(q): Coriolis, centrifugal and gravity torques, N m.
    #[inline]
    pub fn bias(&self, tilt_rad: f64, rate_rad_s: PanTilt<f64>) -> PanTilt<f64> {
        let (s, c) = sin_cos(tilt_rad);
        self.bias_at(s, c, rate_rad_s)
    }

    /// Christoffel symbols of a mass matrix that depends on tilt alone: with ′ = d/dtilt,
    /// C₁ = M₁₁′ q̇₁q̇₂ + M₁₂′ q̇₂², C₂ = −½ M₁₁′ q̇₁².
    #[inline]
    fn bias_at(&self, s: f64, c: f64, rate_rad_s: PanTilt<f64>) -> PanTilt<f64> {
        let d11 = 2.0 * s * c * (self.m11_ss - self.m11_cc) + (c * c - s * s) * self.m11_sc;
        let d12 = c * self.m12_s - s * self.m12_c;
        let (w1, w2) = (rate_rad_s.pan, rate_rad_s.tilt);
        PanTilt::new(
            d11 * w1 * w2 + d12 * w2 * w2,
            -0.5 * d11 * w1 * w1 - self.gravity_c * c - self.gravity_s * s,
        )
    }

    /// Mass matrix and bias with one sine and cosine between them.
    #[inline]
    pub fn mass_and_bias(&self, tilt_rad: f64, rate_rad_s: PanTilt<f64>) -> (MassMatrix, PanTilt<f64>) {
        let (s, c) = sin_cos(tilt_rad);
        (self.mass_at(s, c), self.bias_at(s, c, rate_rad_s))
    }

    /// G(q) alone, N m: the torque that holds the head still.
    pub fn gravity(&self, tilt_rad: f64) -> PanTilt<f64> {
        self.bias(tilt_rad, PanTilt::new(0.0, 0.0))
    }

    /// How C + G changes with tilt and with the rates, N m/rad and N m s/rad: the derivatives of [`bias`](Self::bias) on paper.
    pub fn bias_slopes(&self, tilt_rad: f64, rate_rad_s: PanTilt<f64>) -> BiasSlopes {
        let (s, c) = sin_cos(tilt_rad);
        let (w1, w2) = (rate_rad_s.pan, rate_rad_s.tilt);
        let (twice_sin, twice_cos) = (2.0 * s * c, c * c - s * s);
        // M₁₁′, M₁₂′ and how they go on
        let d11 = twice_sin * (self.m11_ss - self.m11_cc) + twice_cos * self.m11_sc;
        let d12 = c * self.m12_s - s * self.m12_c;
        let dd11 = 2.0 * twice_cos * (self.m11_ss - self.m11_cc) - 2.0 * twice_sin * self.m11_sc;
        let dd12 = -s * self.m12_s - c * self.m12_c;
        BiasSlopes {
            by_tilt: PanTilt::new(
                dd11 * w1 * w2 + dd12 * w2 * w2,
                -0.5 * dd11 * w1 * w1 + self.gravity_c * s - self.gravity_s * c,
            ),
            by_pan_rate: PanTilt::new(d11 * w2, -d11 * w1),
            by_tilt_rate: PanTilt::new(d11 * w1 + 2.0 * d12 * w2, 0.0),
        }
    }

    /// Torque that makes the head move as asked, without friction: M q̈ + C + G, N m.
    pub fn inverse(
        &self,
        tilt_rad: f64,
        rate_rad_s: PanTilt<f64>,
        acceleration_rad_s2: PanTilt<f64>,
    ) -> PanTilt<f64> {
        let (mass, bias) = self.mass_and_bias(tilt_rad, rate_rad_s);
        let inertial = mass.times(acceleration_rad_s2);
        PanTilt::new(inertial.pan + bias.pan, inertial.tilt + bias.tilt)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::HeadBodies;

    #[test]
    fn slopes_are_those_of_the_torques() {
        const STEP: f64 = 1e-6;
        let lumped = HeadBodies::set_b().lumped();
        for (tilt, w1, w2) in [(0.3, 2.0, -1.5), (-1.2, 0.0, 0.0), (0.46, -3.0, 4.0)] {
            let bias = |tilt: f64, w1: f64, w2: f64| lumped.bias(tilt, PanTilt::new(w1, w2));
            let slope = |up: PanTilt<f64>, down: PanTilt<f64>| {
                PanTilt::new((up.pan - down.pan) / (2.0 * STEP), (up.tilt - down.tilt) / (2.0 * STEP))
            };
            let slopes = lumped.bias_slopes(tilt, PanTilt::new(w1, w2));
            for (paper, numbers) in [
                (slopes.by_tilt, slope(bias(tilt + STEP, w1, w2), bias(tilt - STEP, w1, w2))),
                (slopes.by_pan_rate, slope(bias(tilt, w1 + STEP, w2), bias(tilt, w1 - STEP, w2))),
                (slopes.by_tilt_rate, slope(bias(tilt, w1, w2 + STEP), bias(tilt, w1, w2 - STEP))),
            ] {
                let off = (paper.pan - numbers.pan).abs().max((paper.tilt - numbers.tilt).abs());
                assert!(off < 1e-9, "{tilt} {w1} {w2}: {paper:?} {numbers:?}");
            }
        }
    }
}
