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
        let (s, c) = tilt_rad.sin_cos();
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
        let (s, c) = tilt_rad.sin_cos();
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
        let (s, c) = tilt_rad.sin_cos();
        (self.mass_at(s, c), self.bias_at(s, c, rate_rad_s))
    }

    /// G(q) alone, N m: the torque that holds the head still.
    pub fn gravity(&self, tilt_rad: f64) -> PanTilt<f64> {
        self.bias(tilt_rad, PanTilt::new(0.0, 0.0))
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
