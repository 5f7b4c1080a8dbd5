use tracelight_rig::PanTilt;

use crate::Lumped;

/// Inertia tensor about a body's centre of mass, kg m²: entries of the symmetric matrix, products with their sign
/// in the matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inertia {
    /// Entry 11.
    pub xx: f64,
    /// Entry 12.
    pub xy: f64,
    /// Entry 13.
    pub xz: f64,
    /// Entry 22.
    pub yy: f64,
    /// Entry 23.
    pub yz: f64,
    /// Entry 33.
    pub zz: f64,
}

/// A rigid body in its joint's frame (origin where the axes cross).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Body {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Centre of mass, m.
    pub centre_m: [f64; 3],
    /// Inertia about the centre of mass.
    pub inertia: Inertia,
}

/// Everything of the head that has mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadBodies {
    /// What pan carries, without what tilt carries.
    pub pan_body: Body,
    /// What tilt carries.
    pub tilt_body: Body,
    /// Rotor inertias as felt at the joints (motor inertia × ratio²), kg m².
    pub rotor_kg_m2: PanTilt<f64>,
    /// Gravity along −z, m/s².
    pub gravity_m_s2: f64,
}

impl HeadBodies {
    /// Gathers the bodies' parameters into the few sums the equations of motion need.
    ///
    /// Derived from the kinetic energy of both bodies with R = Rz(pan) Ry(tilt): the tilt body's centre is at
    /// (c·b₁ + s·b₃, b₂, c·b₃ − s·b₁) in the pan frame (c, s of tilt), and the z row of Ry is (−s, 0, c).
    pub fn lumped(&self) -> Lumped {
        let (a, b) = (&self.pan_body, &self.tilt_body);
        let [a1, a2, _] = a.centre_m;
        let [b1, b2, b3] = b.centre_m;
        let (m, i) = (b.mass_kg, &b.inertia);
        Lumped {
            m11_fixed: self.rotor_kg_m2.pan + a.inertia.zz + a.mass_kg * (a1 * a1 + a2 * a2) + m * b2 * b2,
            m11_ss: i.xx + m * b3 * b3,
            m11_sc: 2.0 * (m * b1 * b3 - i.xz),
            m11_cc: i.zz + m * b1 * b1,
            m12_s: m * b2 * b1 - i.xy,
            m12_c: i.yz - m * b2 * b3,
            m22: self.rotor_kg_m2.tilt + i.yy + m * (b1 * b1 + b3 * b3),
            gravity_c: m * self.gravity_m_s2 * b1,
            gravity_s: m * self.gravity_m_s2 * b3,
        }
    }
}
