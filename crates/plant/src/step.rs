use tracelight_dynamics::Lumped;
use tracelight_rig::PanTilt;

use crate::friction::{Levels, WornFriction};

/// Angles and speeds of both joints.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointState {
    /// rad.
    pub angle_rad: PanTilt<f64>,
    /// rad/s.
    pub rate_rad_s: PanTilt<f64>,
}

/// Steps the equations of motion in time, with Coulomb friction that sticks.
///
/// Semi-implicit Euler on velocities: M(v⁺ − v) = h(τ − C − G − Fv v⁺) − h f, with f in the set-valued Coulomb law,
/// so a joint whose load stays below break-away has v⁺ = 0 exactly and never creeps (Moreau's time stepping; Acary &
/// Brogliato, *Numerical Methods for Nonsmooth Dynamical Systems*, ch. 10). Positions advance with the mean of old
/// and new velocity.
#[derive(Clone, Copy, Debug)]
pub struct Stepper {
    lumped: Lumped,
    friction: PanTilt<WornFriction>,
}

impl Stepper {
    pub(crate) const fn new(lumped: Lumped, friction: PanTilt<WornFriction>) -> Self {
        Self { lumped, friction }
    }

    /// What it steps.
    pub(crate) const fn parts(&self) -> (Lumped, PanTilt<WornFriction>) {
        (self.lumped, self.friction)
    }

    /// One step of `step_s` under constant torques, N m at the joints.
    #[inline]
    pub fn step(&self, state: &mut JointState, torque_nm: PanTilt<f64>, step_s: f64) {
        let JointState { angle_rad: q, rate_rad_s: w } = *state;
        let (mass, bias) = self.lumped.mass_and_bias(q.tilt, w);
        let pan = Row::new(&self.friction.pan, q.pan, w.pan, mass.m11, step_s);
        let tilt = Row::new(&self.friction.tilt, q.tilt, w.tilt, mass.m22, step_s);
        let push_pan = mass.m11 * w.pan + mass.m12 * w.tilt + step_s * (torque_nm.pan - bias.pan);
        let push_tilt = mass.m12 * w.pan + mass.m22 * w.tilt + step_s * (torque_nm.tilt - bias.tilt);
        // Gauss–Seidel on two rows whose coupling is M12/M11 ≈ 1e-3: three sweeps leave 1e-18
        let (mut pan_new, mut tilt_new) = (w.pan, w.tilt);
        for _ in 0..3 {
            pan_new = pan.resolve(push_pan - mass.m12 * tilt_new);
            tilt_new = tilt.resolve(push_tilt - mass.m12 * pan_new);
        }
        let half = 0.5 * step_s;
        state.angle_rad = PanTilt::new(q.pan + half * (w.pan + pan_new), q.tilt + half * (w.tilt + tilt_new));
        state.rate_rad_s = PanTilt::new(pan_new, tilt_new);
    }
}

/// One joint's line of the complementarity problem, all times h.
pub(crate) struct Row {
    pos: f64,
    neg: f64,
    inverse_pos: f64,
    inverse_neg: f64,
}

impl Row {
    #[inline]
    pub(crate) fn new(
        friction: &WornFriction,
        angle_rad: f64,
        rate_rad_s: f64,
        inertia: f64,
        h: f64,
    ) -> Self {
        let Levels { pos_nm, neg_nm } = friction.levels(angle_rad, rate_rad_s);
        Self {
            pos: h * pos_nm,
            neg: h * neg_nm,
            inverse_pos: 1.0 / (inertia + h * friction.nominal.viscous_pos),
            inverse_neg: 1.0 / (inertia + h * friction.nominal.viscous_neg),
        }
    }

    /// The new speed for a momentum `b`: past either Coulomb level it slides, between them it sticks.
    #[inline]
    pub(crate) fn resolve(&self, b: f64) -> f64 {
        if b > self.pos {
            (b - self.pos) * self.inverse_pos
        } else if b < self.neg {
            (b - self.neg) * self.inverse_neg
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Wear;
    use tracelight_dynamics::{Friction, HeadBodies};

    fn stepper(coulomb_nm: f64) -> Stepper {
        let friction = WornFriction::new(Friction::symmetric(0.001, coulomb_nm), &Wear::NONE, 0.0);
        Stepper::new(HeadBodies::set_a().lumped(), PanTilt::new(friction, friction))
    }

    #[test]
    fn under_break_away_nothing_creeps_in_ten_seconds() {
        let stepper = stepper(0.05);
        let mut state = JointState::default();
        let hold = HeadBodies::set_a().lumped().gravity(0.0).tilt;
        for _ in 0..100_000 {
            stepper.step(&mut state, PanTilt::new(0.9 * 0.05, hold - 0.9 * 0.05), 1e-4);
        }
        assert_eq!(state, JointState::default());
    }

    #[test]
    fn over_break_away_it_moves() {
        let stepper = stepper(0.05);
        let mut state = JointState::default();
        for _ in 0..1000 {
            stepper.step(&mut state, PanTilt::new(1.1 * 0.05, 0.0), 1e-4);
        }
        assert!(state.angle_rad.pan > 1e-4);
    }

    #[test]
    fn without_friction_energy_stays_within_the_step_error() {
        let lumped = HeadBodies::set_a().lumped();
        let free = WornFriction::new(Friction::symmetric(0.0, 0.0), &Wear::NONE, 0.0);
        let stepper = Stepper::new(lumped, PanTilt::new(free, free));
        // height of the tilt body's centre: (gravity_s c − gravity_c s), in torque units
        let energy = |s: &JointState| {
            let m = lumped.mass(s.angle_rad.tilt);
            let (w1, w2) = (s.rate_rad_s.pan, s.rate_rad_s.tilt);
            let (sin, cos) = s.angle_rad.tilt.sin_cos();
            0.5 * (m.m11 * w1 * w1 + m.m22 * w2 * w2) + m.m12 * w1 * w2 + lumped.gravity_s * cos
                - lumped.gravity_c * sin
        };
        let mut state = JointState { rate_rad_s: PanTilt::new(2.0, -1.0), ..JointState::default() };
        let before = energy(&state);
        for _ in 0..20_000 {
            stepper.step(&mut state, PanTilt::new(0.0, 0.0), 1e-4);
        }
        let drift = (energy(&state) - before).abs();
        assert!(drift < 1e-3 * before.abs().max(0.1), "{drift:e} of {before}");
    }

    #[test]
    fn halving_the_substep_moves_a_joint_by_less_than_a_tenth_of_a_count() {
        let run = |h: f64| {
            let stepper = stepper(0.04);
            let mut state = JointState::default();
            for i in 0..(1.0 / h) as usize {
                let t = i as f64 * h;
                let u = 0.3 * (5.0 * t).sin();
                stepper.step(&mut state, PanTilt::new(u, u - 0.15), h);
            }
            state.angle_rad
        };
        let (coarse, fine) = (run(1e-4), run(5e-5));
        assert!((coarse.pan - fine.pan).abs() < 1e-4, "{:e}", coarse.pan - fine.pan);
        assert!((coarse.tilt - fine.tilt).abs() < 1e-4, "{:e}", coarse.tilt - fine.tilt);
    }
}
