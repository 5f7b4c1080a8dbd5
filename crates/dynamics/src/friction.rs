/// Viscous and Coulomb friction of one joint, each direction its own: τ = sign(ω)(Fv |ω| + Fc).
///
/// Signs as identified by fitting a line to each direction: `coulomb_neg_nm` is the intercept of the negative side
/// and negative itself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Friction {
    /// Slope for positive speeds, N m s/rad.
    pub viscous_pos: f64,
    /// Slope for negative speeds, N m s/rad.
    pub viscous_neg: f64,
    /// Intercept for positive speeds, N m, ≥ 0.
    pub coulomb_pos_nm: f64,
    /// Intercept for negative speeds, N m, ≤ 0.
    pub coulomb_neg_nm: f64,
}

impl Friction {
    /// The same in both directions.
    pub const fn symmetric(viscous: f64, coulomb_nm: f64) -> Self {
        Self {
            viscous_pos: viscous,
            viscous_neg: viscous,
            coulomb_pos_nm: coulomb_nm,
            coulomb_neg_nm: -coulomb_nm,
        }
    }

    /// The larger of the two Coulomb levels, N m.
    pub const fn coulomb_nm(&self) -> f64 {
        self.coulomb_pos_nm.max(-self.coulomb_neg_nm)
    }

    /// Mean slope of both directions, N m s/rad: what a linear model has of it.
    pub const fn mean_viscous(&self) -> f64 {
        0.5 * (self.viscous_pos + self.viscous_neg)
    }

    /// With that much more viscous friction either way, N m s/rad.
    #[must_use]
    pub fn with_viscous(self, more: f64) -> Self {
        Self { viscous_pos: self.viscous_pos + more, viscous_neg: self.viscous_neg + more, ..self }
    }

    /// Torque that a motion at `rate_rad_s` costs, N m; zero at rest, where friction takes any value between the two
    /// intercepts.
    pub fn torque(&self, rate_rad_s: f64) -> f64 {
        if rate_rad_s > 0.0 {
            self.viscous_pos * rate_rad_s + self.coulomb_pos_nm
        } else if rate_rad_s < 0.0 {
            self.viscous_neg * rate_rad_s + self.coulomb_neg_nm
        } else {
            0.0
        }
    }
}
