//! Random variation of heads of one design.

use tracelight_dynamics::Friction;
use tracelight_rig::PanTilt;

use crate::RigConfig;

/// How far heads of one kind lie apart. Shares are uniform to either side of the truth a rig has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Of each joint's Coulomb levels, both directions alike.
    pub coulomb: f64,
    /// Of each joint's viscous slopes, both directions alike.
    pub viscous: f64,
    /// Of each joint's rotor inertia: nearly all of what a geared head feels.
    pub inertia: f64,
    /// Of gravity's torque.
    pub gravity: f64,
    /// Break-away over Coulomb friction, lowest and highest.
    pub stribeck_ratio: (f64, f64),
    /// Ripple of friction, lowest and highest share.
    pub friction_ripple: (f64, f64),
    /// Largest misplacement of an encoder edge, lowest and highest, counts.
    pub edge_error_counts: (f64, f64),
}

impl Spread {
    /// What this program's figures are measured with.
    pub const USUAL: Self = Self {
        coulomb: 0.15,
        viscous: 0.3,
        inertia: 0.05,
        gravity: 0.05,
        stribeck_ratio: (1.0, 1.3),
        friction_ripple: (0.0, 0.1),
        edge_error_counts: (0.0, 0.1),
    };

    /// A rig whose truth is one of these heads. What is believed of it stays.
    pub fn draw(&self, rig: &RigConfig, seed: u64) -> RigConfig {
        let mut dice = oorandom::Rand64::new(u128::from(seed));
        let mut within = |(low, high): (f64, f64)| low + (high - low) * dice.rand_float();
        let mut drawn = rig.clone();
        let truth = &mut drawn.truth;
        let mut share = |spread: f64| within((1.0 - spread, 1.0 + spread));
        let mut friction = |f: Friction| {
            let (viscous, coulomb) = (share(self.viscous), share(self.coulomb));
            Friction {
                viscous_pos: f.viscous_pos * viscous,
                viscous_neg: f.viscous_neg * viscous,
                coulomb_pos_nm: f.coulomb_pos_nm * coulomb,
                coulomb_neg_nm: f.coulomb_neg_nm * coulomb,
            }
        };
        truth.model.friction =
            PanTilt::new(friction(truth.model.friction.pan), friction(truth.model.friction.tilt));
        let bodies = &mut truth.model.bodies;
        bodies.rotor_kg_m2 = bodies.rotor_kg_m2.map(|rotor| rotor * share(self.inertia));
        bodies.gravity_m_s2 *= share(self.gravity);
        truth.wear.stribeck_ratio = within(self.stribeck_ratio);
        truth.wear.friction_ripple = within(self.friction_ripple);
        truth.wear.edge_error_counts = within(self.edge_error_counts);
        drawn
    }
}
