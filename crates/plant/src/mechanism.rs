use tracelight_rig::PanTilt;

use crate::belt::{Belted, STIFF_BELT};
use crate::{JointState, PlantConfig, Stepper};

/// What turns: joints that are one with their rotors, or hang on belts.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Mechanism {
    Rigid(Stepper),
    Belted { belted: Belted, encoders_at_motors: bool },
}

impl Mechanism {
    /// As a configuration has it, at rest.
    pub(crate) fn new(config: &PlantConfig, ripple_phase_rad: PanTilt<f64>, rest_rad: PanTilt<f64>) -> Self {
        let wear = &config.wear;
        if wear.belt_resonance_hz == 0.0 {
            return Self::Rigid(config.stepper(ripple_phase_rad));
        }
        let belt = (wear.belt_resonance_hz, wear.belt_damping);
        let (lumped, rotors) = (config.bodies.lumped(), config.bodies.rotor_kg_m2);
        let belted = Belted::new(lumped, rotors, config.friction(ripple_phase_rad), belt, rest_rad);
        Self::Belted { belted, encoders_at_motors: wear.encoders_at_motors }
    }

    /// Where the joints are, which carry the beam, and how fast they turn.
    pub(crate) const fn joints(&self, seen: &JointState) -> JointState {
        match self {
            Self::Rigid(_) => *seen,
            Self::Belted { belted, .. } => *belted.joints(),
        }
    }

    /// Steps what the encoders see; where the joints are, which carry the beam, rad.
    pub(crate) fn step(
        &mut self,
        seen: &mut JointState,
        motor_nm: PanTilt<f64>,
        others_nm: PanTilt<f64>,
        step_s: f64,
    ) -> PanTilt<f64> {
        match self {
            Self::Rigid(stepper) => {
                let all = PanTilt::from_fn(|j| motor_nm[j] + others_nm[j]);
                stepper.step(seen, all, step_s);
                seen.angle_rad
            }
            Self::Belted { belted, encoders_at_motors } => {
                belted.step(motor_nm, others_nm, step_s);
                *seen = if *encoders_at_motors { belted.rotors() } else { *belted.joints() };
                belted.joints().angle_rad
            }
        }
    }

    /// Returns the mechanism with belts. On stiff belts, rotors and joints move as one.
    pub(crate) fn on_belts(&self, state: &JointState, rotor_kg_m2: PanTilt<f64>) -> Belted {
        match *self {
            Self::Rigid(stepper) => {
                let (lumped, friction) = stepper.parts();
                let belted = Belted::new(lumped, rotor_kg_m2, friction, STIFF_BELT, state.angle_rad);
                belted.turning(state.rate_rad_s)
            }
            Self::Belted { belted, .. } => belted,
        }
    }
}
