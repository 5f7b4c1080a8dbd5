//! Keys of `[identified]`: what was found of a head beyond its equations.

use tracelight_sim::Identified;
use tracelight_units::ANGULAR_SPEEDS;

use crate::keys::{Key, PURE, STIFFNESS, TORQUE, real};

/// What was identified of a joint.
macro_rules! found {
    ($name:literal, $joint:ident) => {
        [
            real(
                concat!($name, ".residual"),
                PURE,
                (0.0, 1e3),
                "how far the model is off what it was identified from, rms, counts",
                (|i| &mut i.residual_counts.$joint) as fn(&mut Identified) -> &mut f64,
            ),
            real(
                concat!($name, ".break_away"),
                TORQUE,
                (0.0, 100.0),
                "what friction has on top of its Coulomb level near standstill",
                |i| &mut i.quirks.$joint.break_away_nm,
            ),
            real(
                concat!($name, ".break_away_speed"),
                ANGULAR_SPEEDS,
                (1e-6, 10.0),
                "speed at which that has fallen to 1/e",
                |i| &mut i.quirks.$joint.break_away_rad_s,
            ),
            real(
                concat!($name, ".ripple_periods"),
                PURE,
                (0.0, 1e4),
                "how often Coulomb friction ripples in a turn; 0 where it does not",
                |i| &mut i.quirks.$joint.ripple.periods,
            ),
            real(
                concat!($name, ".ripple_sin"),
                TORQUE,
                (-100.0, 100.0),
                "on top of it with the sine of so many times the angle",
                |i| &mut i.quirks.$joint.ripple.sin_nm,
            ),
            real(concat!($name, ".ripple_cos"), TORQUE, (-100.0, 100.0), "with the cosine", |i| {
                &mut i.quirks.$joint.ripple.cos_nm
            }),
            real(
                concat!($name, ".cable_load"),
                TORQUE,
                (-100.0, 100.0),
                "what its cables do at zero, besides",
                |i| &mut i.quirks.$joint.cable.load_nm,
            ),
            real(concat!($name, ".cable_spring"), STIFFNESS, (-100.0, 100.0), "and against its angle", |i| {
                &mut i.quirks.$joint.cable.spring_nm_per_rad
            }),
            real(
                concat!($name, ".edge_0"),
                PURE,
                (-0.5, 0.5),
                "how far encoder edges below counts 0, 4, 8 … lie beyond their places, counts",
                |i| &mut i.quirks.$joint.edges_counts[0],
            ),
            real(concat!($name, ".edge_1"), PURE, (-0.5, 0.5), "below counts 1, 5, 9 …", |i| {
                &mut i.quirks.$joint.edges_counts[1]
            }),
            real(concat!($name, ".edge_2"), PURE, (-0.5, 0.5), "below counts 2, 6, 10 …", |i| {
                &mut i.quirks.$joint.edges_counts[2]
            }),
            real(concat!($name, ".edge_3"), PURE, (-0.5, 0.5), "below counts 3, 7, 11 …", |i| {
                &mut i.quirks.$joint.edges_counts[3]
            }),
        ]
    };
}

/// Keys of `[identified]`; its date stands beside them.
pub(crate) fn identified_keys() -> Vec<Key<Identified>> {
    let mut keys = found!("pan", pan).to_vec();
    keys.extend(found!("tilt", tilt));
    keys
}
