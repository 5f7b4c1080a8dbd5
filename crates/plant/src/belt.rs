use tracelight_dynamics::Lumped;
use tracelight_rig::{Joint, PanTilt};

use crate::friction::WornFriction;
use crate::step::{JointState, Row};
use crate::teeth::{Mesh, Teeth};

/// How a belt gives that is not said to, once it jumps teeth: resonance, Hz, and share of critical damping. A substep of 0.1 ms follows that well.
pub(crate) const STIFF_BELT: (f64, f64) = (200.0, 0.3);

/// A head whose belts give: rotors with gearhead and friction on one side, what the joints carry and the beam on the other, a
/// spring and a damper between them. Angles of the rotors are reckoned at the joints.
///
/// Symplectic Euler: a spring neither gains nor loses by being stepped (Hairer, Lubich & Wanner, *Geometric Numerical
/// Integration*, §I.1.2).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Belted {
    /// Of the joints without their rotors.
    carried: Lumped,
    rotor_kg_m2: PanTilt<f64>,
    friction: PanTilt<WornFriction>,
    stiffness_nm_per_rad: PanTilt<f64>,
    damping_nms_per_rad: PanTilt<f64>,
    rotors: JointState,
    joints: JointState,
    /// Of belts that are loose.
    teeth: PanTilt<Option<Teeth>>,
    /// By how much the belts are stretched at rest where the head is homed, rad.
    homed_rad: PanTilt<f64>,
}

impl Belted {
    /// At rest at `angle_rad`, the belts stretched by what the joints weigh. Each joint swings on its belt with `resonance_hz`
    /// against a rotor that is free, damped by that share of critical damping.
    pub(crate) fn new(
        lumped: Lumped,
        rotor_kg_m2: PanTilt<f64>,
        friction: PanTilt<WornFriction>,
        (resonance_hz, damping): (f64, f64),
        angle_rad: PanTilt<f64>,
    ) -> Self {
        let carried = Lumped {
            m11_fixed: lumped.m11_fixed - rotor_kg_m2.pan,
            m22: lumped.m22 - rotor_kg_m2.tilt,
            ..lumped
        };
        let swings = carried.mass(0.0).own_inertia();
        let rate = std::f64::consts::TAU * resonance_hz;
        let reduced = |j: Joint| swings[j] * rotor_kg_m2[j] / (swings[j] + rotor_kg_m2[j]);
        let stiffness = PanTilt::from_fn(|j| reduced(j) * rate * rate);
        let weight = carried.gravity(angle_rad.tilt);
        let stretched = PanTilt::from_fn(|j| angle_rad[j] + weight[j] / stiffness[j]);
        Self {
            carried,
            rotor_kg_m2,
            friction,
            stiffness_nm_per_rad: stiffness,
            damping_nms_per_rad: PanTilt::from_fn(|j| 2.0 * damping * reduced(j) * rate),
            rotors: JointState { angle_rad: stretched, rate_rad_s: PanTilt::default() },
            joints: JointState { angle_rad, rate_rad_s: PanTilt::default() },
            teeth: PanTilt::default(),
            homed_rad: PanTilt::from_fn(|j| stretched[j] - angle_rad[j]),
        }
    }

    /// Sets the speed of joints and rotors alike.
    pub(crate) fn turning(mut self, rate_rad_s: PanTilt<f64>) -> Self {
        (self.rotors.rate_rad_s, self.joints.rate_rad_s) = (rate_rad_s, rate_rad_s);
        self
    }

    /// A joint's belt jumps teeth from now on. One that has done so lies where it lies.
    pub(crate) fn loosen(&mut self, joint: Joint, teeth: Teeth) {
        let before = self.teeth[joint].unwrap_or(teeth);
        self.teeth[joint] = Some(before.holding_as(&teeth));
    }

    /// What the joints carry, and the beam.
    pub(crate) const fn joints(&self) -> &JointState {
        &self.joints
    }

    /// The rotors as encoders on their side read them that were homed where the head began.
    pub(crate) fn rotors(&self) -> JointState {
        let angle_rad = PanTilt::from_fn(|j| self.rotors.angle_rad[j] - self.homed_rad[j]);
        JointState { angle_rad, rate_rad_s: self.rotors.rate_rad_s }
    }

    /// What a belt carries now, N m.
    fn belt_nm(&mut self, j: Joint) -> f64 {
        let ahead_rad = self.rotors.angle_rad[j] - self.joints.angle_rad[j];
        let gap_rad = self.teeth[j].map_or(0.0, |teeth| teeth.gap_rad());
        let taut_nm = self.stiffness_nm_per_rad[j] * (ahead_rad - gap_rad)
            + self.damping_nms_per_rad[j] * (self.rotors.rate_rad_s[j] - self.joints.rate_rad_s[j]);
        let Some(teeth) = &mut self.teeth[j] else { return taut_nm };
        match teeth.mesh(ahead_rad, taut_nm) {
            Mesh::Carries(nm) => nm,
            Mesh::Lands => {
                self.land(j);
                0.0
            }
        }
    }

    /// Teeth that fall into gaps stop against their flanks: rotor and joint go on at the one speed that keeps their momentum.
    fn land(&mut self, j: Joint) {
        let (rotor, carried) =
            (self.rotor_kg_m2[j], self.carried.mass(self.joints.angle_rad.tilt).own_inertia()[j]);
        let momentum = rotor * self.rotors.rate_rad_s[j] + carried * self.joints.rate_rad_s[j];
        let rate = momentum / (rotor + carried);
        (self.rotors.rate_rad_s[j], self.joints.rate_rad_s[j]) = (rate, rate);
    }

    /// One step of `step_s` under torques of the motors and others at the joints, N m.
    pub(crate) fn step(&mut self, motor_nm: PanTilt<f64>, joint_nm: PanTilt<f64>, step_s: f64) {
        let belt = PanTilt::from_fn(|j| self.belt_nm(j));
        let (rotors, joints) = (&mut self.rotors, &mut self.joints);
        for j in Joint::BOTH {
            let (angle, rate, inertia) = (rotors.angle_rad[j], rotors.rate_rad_s[j], self.rotor_kg_m2[j]);
            let row = Row::new(&self.friction[j], angle, rate, inertia, step_s);
            rotors.rate_rad_s[j] = row.resolve(inertia * rate + step_s * (motor_nm[j] - belt[j]));
            rotors.angle_rad[j] += step_s * rotors.rate_rad_s[j];
        }
        let (mass, bias) = self.carried.mass_and_bias(joints.angle_rad.tilt, joints.rate_rad_s);
        let change = mass.solve(PanTilt::from_fn(|j| step_s * (belt[j] + joint_nm[j] - bias[j])));
        for j in Joint::BOTH {
            joints.rate_rad_s[j] += change[j];
            joints.angle_rad[j] += step_s * joints.rate_rad_s[j];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step::Stepper;
    use crate::{LooseBelt, Wear};
    use tracelight_dynamics::{Friction, HeadBodies};

    /// A joint that is let go swings with its resonance and dies away as its damping says.
    #[test]
    fn a_joint_swings_on_its_belt_as_often_and_as_long_as_it_is_said_to() {
        let (hz, damping) = (25.0, 0.03);
        let bodies = HeadBodies { gravity_m_s2: 0.0, ..HeadBodies::set_a() };
        let free = WornFriction::new(Friction::symmetric(0.0, 0.0), &Wear::NONE, 0.0);
        let friction = PanTilt::new(free, free);
        let mut belted =
            Belted::new(bodies.lumped(), bodies.rotor_kg_m2, friction, (hz, damping), PanTilt::default());
        belted.joints.angle_rad.pan = 1e-4;
        let zero = PanTilt::default();
        let mut peaks = Vec::new();
        let mut last = (0.0, 0.0);
        for k in 0..20_000 {
            belted.step(zero, zero, 1e-4);
            let off = belted.joints.angle_rad.pan - belted.rotors.angle_rad.pan;
            if last.1 > last.0 && last.1 > off {
                peaks.push((f64::from(k) * 1e-4, last.1));
            }
            last = (last.1, off);
        }
        let period = (peaks[10].0 - peaks[0].0) / 10.0;
        assert!((period * hz - 1.0).abs() < 0.01, "{period} s");
        let decay = (peaks[0].1 / peaks[10].1).ln() / (10.0 * std::f64::consts::TAU);
        assert!((decay / damping - 1.0).abs() < 0.05, "{decay}");
    }

    /// A head without weight and friction on belts that are nearly stiff, or none at all.
    fn free() -> (Belted, Stepper) {
        let bodies = HeadBodies { gravity_m_s2: 0.0, ..HeadBodies::set_a() };
        let none = WornFriction::new(Friction::symmetric(0.0, 0.0), &Wear::NONE, 0.0);
        let friction = PanTilt::new(none, none);
        let belted =
            Belted::new(bodies.lumped(), bodies.rotor_kg_m2, friction, STIFF_BELT, PanTilt::default());
        (belted, Stepper::new(bodies.lumped(), friction))
    }

    #[test]
    fn joints_on_stiff_belts_move_as_those_that_are_one_with_their_rotors() {
        const COUNT_RAD: f64 = std::f64::consts::TAU / 4096.0;
        let (mut belted, rigid) = free();
        let mut state = JointState::default();
        for k in 0..10_000 {
            let motor = PanTilt::new(0.3 * (5e-4 * f64::from(k)).sin(), 0.2 * (7e-4 * f64::from(k)).sin());
            belted.step(motor, PanTilt::default(), 1e-4);
            rigid.step(&mut state, motor, 1e-4);
            let off = PanTilt::from_fn(|j| belted.joints().angle_rad[j] - state.angle_rad[j]);
            assert!(off.pan.abs().max(off.tilt.abs()) < 0.1 * COUNT_RAD, "{off:?}");
        }
        assert!(state.angle_rad.pan > 0.1, "{state:?}");
    }

    /// Somebody pushes a joint: its belt carries that until its teeth climb; the joint stands a tooth from its rotor, or more, once it is let go.
    #[test]
    fn a_loose_belt_lets_its_joint_go_by_whole_teeth() {
        let belt = LooseBelt { holds_share: 0.1, teeth: 90 };
        let pitch = std::f64::consts::TAU / 90.0;
        let lost = |push_nm: f64, steps: usize| {
            let (mut belted, _) = free();
            belted.loosen(Joint::Pan, Teeth::new(belt, 1.0));
            (0..steps).for_each(|_| belted.step(PanTilt::default(), PanTilt::new(push_nm, 0.0), 1e-4));
            (0..5000).for_each(|_| belted.step(PanTilt::default(), PanTilt::default(), 1e-4));
            let by_rad = belted.joints().angle_rad.pan - belted.rotors.angle_rad.pan;
            assert!((belted.joints().rate_rad_s.pan - belted.rotors.rate_rad_s.pan).abs() < 1e-6);
            by_rad / pitch
        };
        // a load that comes at once stretches a belt twice as far as it does in the end
        assert!(lost(0.04, 1000).abs() < 1e-6, "it holds that");
        let (forth, back) = (lost(0.2, 1000), lost(-0.2, 1000));
        assert!(forth > 0.9 && (forth - forth.round()).abs() < 1e-6, "{forth} teeth");
        assert!((forth + back).abs() < 1e-6, "{forth} {back}");
        assert!(lost(0.2, 2000) > forth + 0.9, "again and again");
    }
}
