use tracelight_dynamics::Lumped;
use tracelight_rig::{Joint, PanTilt};

use crate::friction::WornFriction;
use crate::step::{JointState, Row};

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
            homed_rad: PanTilt::from_fn(|j| stretched[j] - angle_rad[j]),
        }
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

    /// One step of `step_s` under torques of the motors and others at the joints, N m.
    pub(crate) fn step(&mut self, motor_nm: PanTilt<f64>, joint_nm: PanTilt<f64>, step_s: f64) {
        let (rotors, joints) = (&mut self.rotors, &mut self.joints);
        let belt = PanTilt::from_fn(|j| {
            self.stiffness_nm_per_rad[j] * (rotors.angle_rad[j] - joints.angle_rad[j])
                + self.damping_nms_per_rad[j] * (rotors.rate_rad_s[j] - joints.rate_rad_s[j])
        });
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
    use crate::Wear;
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
}
