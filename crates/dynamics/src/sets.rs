//! The two parameter sets that came with the original rig.

use tracelight_rig::PanTilt;

use crate::{Body, HeadBodies, Inertia};

/// Motor rotor inertia the rig's builders assumed, kg m².
const ROTOR_KG_M2: f64 = 2.3e-4;
/// Gearhead × belt.
const RATIO: f64 = 6.3 * 2.8435;
/// Centre of mass of what tilt carries, m; the same in both sets.
const TILT_CENTRE_M: [f64; 3] = [0.0750, 0.0151, 0.0046];
/// m/s².
const GRAVITY: f64 = 9.807;

impl HeadBodies {
    /// Set A, from the model file; its rotor inertia acts through the gears. This reading gives the printed
    /// linearization, and it is the default.
    pub const fn set_a() -> Self {
        let rotor = ROTOR_KG_M2 * RATIO * RATIO;
        Self {
            pan_body: Body {
                mass_kg: 0.5507,
                centre_m: [-0.0122, 0.0066, 0.0549 + 0.1048], // the model file measures z from l1 = −0.1048
                inertia: Inertia {
                    xx: 1.162e-3,
                    xy: -5.938e-5,
                    xz: -7.951e-5,
                    yy: 7.658e-4,
                    yz: -1.269e-4,
                    zz: 7.469e-4,
                },
            },
            tilt_body: Body {
                mass_kg: 0.2035,
                centre_m: TILT_CENTRE_M,
                inertia: Inertia { xx: 3e-4, xy: 0.0, xz: 0.0, yy: 6.957e-5, yz: -6.931e-6, zz: 3.041e-4 },
            },
            rotor_kg_m2: PanTilt::new(rotor, rotor),
            gravity_m_s2: GRAVITY,
        }
    }

    /// Set B, from the simulation's start file; its rotor inertia is "as seen by encoder", so it stands as left,
    /// without the ratio.
    pub const fn set_b() -> Self {
        Self {
            pan_body: Body {
                mass_kg: 0.5603,
                centre_m: [-0.0126, -0.0228, -0.0003],
                inertia: Inertia { xx: 1.2e-3, xy: 0.0, xz: -1e-4, yy: 7e-4, yz: -1e-4, zz: 8e-4 },
            },
            tilt_body: Body {
                mass_kg: 0.3611,
                centre_m: TILT_CENTRE_M,
                inertia: Inertia { xx: 3e-4, xy: -1e-4, xz: 0.0, yy: 6e-4, yz: 0.0, zz: 7e-4 },
            },
            rotor_kg_m2: PanTilt::new(ROTOR_KG_M2, ROTOR_KG_M2),
            gravity_m_s2: GRAVITY,
        }
    }
}
