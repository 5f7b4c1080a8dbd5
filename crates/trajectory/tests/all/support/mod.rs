//! A rig of inertia and friction alone, and closed curves on its wall with exact joint derivatives.

pub(crate) mod drawings;

use std::f64::consts::TAU;

use tracelight_aim::{HeadGeometry, HeadPose, JointPath, SpotMotion};
use tracelight_dynamics::{Friction, Lumped, Motor};
use tracelight_rig::{Joint, PanTilt};
use tracelight_stroke::{Point, Vec2};
use tracelight_trajectory::{Machine, PathSample, Retimed};

/// The rig of the research's timing table: 0.075 kg m² at both joints, no gravity.
pub(crate) fn bare_rig(coulomb_nm: f64, viscous: f64) -> Machine {
    let motor = |torque_nm_per_v| Motor::by_current(torque_nm_per_v, 10.0);
    Machine {
        lumped: Lumped { m11_fixed: 0.075, m22: 0.075, ..Lumped::default() },
        friction: PanTilt::new(
            Friction::symmetric(viscous, coulomb_nm),
            Friction::symmetric(viscous, coulomb_nm),
        ),
        motors: PanTilt::new(motor(0.0619), motor(0.0774)),
        torque_share: 1.0,
        speed_limit_rad_s: PanTilt::new(24.0, 24.0),
        acceleration_limit_rad_s2: PanTilt::new(f64::INFINITY, f64::INFINITY),
        jerk_limit_rad_s3: PanTilt::new(f64::INFINITY, f64::INFINITY),
        tolerance_limit_rad: f64::INFINITY,
        geometry: HeadGeometry::centred(PanTilt::new((-3.1, 3.1), (-1.6, 1.6))),
        pose: HeadPose::square_on(0.9),
        relay_on_ticks: 5,
        relay_off_ticks: 3,
    }
}

/// The joints for a place on the wall and its derivatives.
pub(crate) fn aim(machine: &Machine, point: Point, velocity: Vec2, acceleration: Vec2) -> JointPath {
    machine.geometry.motion(&machine.pose, &SpotMotion { point, velocity, acceleration }).unwrap()
}

/// A curve on the wall over u from 0 to 2π × turns.
#[derive(Clone, Copy)]
pub(crate) struct Curve {
    pub(crate) point: fn(f64) -> (f64, f64),
    pub(crate) turns: f64,
}

impl Curve {
    pub(crate) fn at(&self, u: f64) -> JointPath {
        // central differences of a smooth curve: good to 1e-6 of its size
        const H: f64 = 1e-4;
        let p = |u: f64| {
            let (x, y) = (self.point)(u);
            Vec2::new(x, y)
        };
        let (before, here, after) = (p(u - H), p(u), p(u + H));
        let (first, second) = ((after - before) / (2.0 * H), (after - 2.0 * here + before) / (H * H));
        aim(&bare_rig(0.0, 0.0), Point::ORIGIN + here, first, second)
    }

    /// `count` cells, even in u; the cap is of du/dt.
    pub(crate) fn samples(&self, count: usize, cap: f64) -> Vec<PathSample> {
        let place = |i: usize| {
            let s = TAU * self.turns * i as f64 / count as f64;
            PathSample { s, joints: self.at(s), cap }
        };
        (0..=count).map(place).collect()
    }
}

/// Tilt alone from 0 on.
pub(crate) fn tilt_line(count: usize, angle_rad: f64) -> Vec<PathSample> {
    let place = |i: usize| {
        let s = i as f64 / count as f64;
        let joints = JointPath {
            angle_rad: PanTilt::new(0.0, s * angle_rad),
            first: PanTilt::new(0.0, angle_rad),
            second: PanTilt::new(0.0, 0.0),
        };
        PathSample { s, joints, cap: f64::INFINITY }
    };
    (0..=count).map(place).collect()
}

/// Joint rates and accelerations at a place, speed and acceleration along the path.
pub(crate) fn joint_motion(at: &JointPath, v: f64, u: f64) -> (PanTilt<f64>, PanTilt<f64>) {
    (at.first.map(|d| d * v), PanTilt::from_fn(|j| at.second[j] * v * v + at.first[j] * u))
}

/// Share of the motors' torque at a place, speed and acceleration along the path.
pub(crate) fn torque_share(machine: &Machine, at: &JointPath, v: f64, u: f64) -> PanTilt<f64> {
    let (rate, acceleration) = joint_motion(at, v, u);
    machine.fraction(machine.torque(at.angle_rad, rate, acceleration)).map(f64::abs)
}

/// By how much of the motors' torque the motion exceeds it at most, looked at `each` times within every cell.
pub(crate) fn worst_excess(machine: &Machine, motion: &Retimed, curve: &Curve, each: usize) -> f64 {
    let mut worst = f64::NEG_INFINITY;
    for (i, u) in motion.accelerations().iter().enumerate() {
        let (from, h) = (motion.samples()[i].s, motion.samples()[i + 1].s - motion.samples()[i].s);
        for k in 1..each {
            let t = k as f64 / each as f64;
            let square = motion.speeds()[i].powi(2) + h * t * (2.0 * u[0] + (u[1] - u[0]) * t);
            let share = torque_share(
                machine,
                &curve.at(from + h * t),
                square.max(0.0).sqrt(),
                u[0] + (u[1] - u[0]) * t,
            );
            for joint in Joint::BOTH {
                worst = f64::max(worst, share[joint] - machine.torque_share);
            }
        }
    }
    worst
}
