use tracelight_aim::{AimError, HeadGeometry, HeadPose};
use tracelight_dynamics::{Friction, Lumped, Motor};
use tracelight_rig::{Joint, PanTilt, Segment, TICK_F64_S};
use tracelight_stroke::{Point, Vec2};

use crate::binding::Binding;
use crate::motion::JointMotion;
use crate::turn::turn;

/// What the planner believes of head, motors and target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Machine {
    /// Inertia and gravity.
    pub lumped: Lumped,
    /// Friction of each joint.
    pub friction: PanTilt<Friction>,
    /// Amplifier and motor of each joint.
    pub motors: PanTilt<Motor>,
    /// Share of the motors' torque a plan may use.
    pub torque_share: f64,
    /// Highest joint speeds, rad/s.
    pub speed_limit_rad_s: PanTilt<f64>,
    /// Highest joint accelerations wished for, rad/s².
    pub acceleration_limit_rad_s2: PanTilt<f64>,
    /// Highest jerk of each joint, from tick to tick, rad/s³; infinite where there is none.
    pub jerk_limit_rad_s3: PanTilt<f64>,
    /// Furthest that a joint may be allowed to stray, rad.
    pub tolerance_limit_rad: f64,
    /// Laser and joint ranges.
    pub geometry: HeadGeometry,
    /// Where the head stands.
    pub pose: HeadPose,
    /// From the gate's rise to light, ticks.
    pub relay_on_ticks: u32,
    /// From the gate's fall to dark, ticks.
    pub relay_off_ticks: u32,
}

/// What a joint acceleration would need, against what the motor has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AccelerationDemand {
    /// Which joint.
    pub joint: Joint,
    /// Requested acceleration, rad/s².
    pub asked_rad_s2: f64,
    /// Command it would need, V.
    pub needed_v: f64,
    /// Command there is, V.
    pub limit_v: f64,
    /// Acceleration that command gives against friction and gravity, rad/s².
    pub possible_rad_s2: f64,
}

impl Machine {
    /// Torque of both motors for a motion, N m. At rest friction is left out: it holds by itself.
    pub fn torque(
        &self,
        angle_rad: PanTilt<f64>,
        rate_rad_s: PanTilt<f64>,
        acceleration: PanTilt<f64>,
    ) -> PanTilt<f64> {
        let rigid = self.lumped.inverse(angle_rad.tilt, rate_rad_s, acceleration);
        PanTilt::from_fn(|j| rigid[j] + self.friction[j].torque(rate_rad_s[j]))
    }

    /// Torque of both motors for a motion, as a share of what the amplifiers can do; signed.
    pub(crate) fn fraction_of(&self, joints: &PanTilt<JointMotion>) -> PanTilt<f64> {
        let torque = self.torque(
            joints.map(|j| j.position_rad),
            joints.map(|j| j.velocity_rad_s),
            joints.map(|j| j.acceleration_rad_s2),
        );
        self.fraction(torque)
    }

    /// How fast the acceleration changes from one tick to the next, as a share of the highest jerk.
    pub(crate) fn jerk_share(
        &self,
        before: &PanTilt<JointMotion>,
        after: &PanTilt<JointMotion>,
    ) -> PanTilt<f64> {
        PanTilt::from_fn(|j| {
            let change = after[j].acceleration_rad_s2 - before[j].acceleration_rad_s2;
            change.abs() / (TICK_F64_S * self.jerk_limit_rad_s3[j])
        })
    }

    /// The window that rounds an acceleration from nothing to all there is, or back, within the highest jerk, s.
    pub(crate) fn least_ramp_s(&self) -> f64 {
        let of_joint = |j: Joint| {
            let friction = &self.friction[j];
            let helped = friction.coulomb_pos_nm.abs().max(friction.coulomb_neg_nm.abs())
                + self.lumped.gravity(0.0)[j].abs();
            self.acceleration_rad_s2(j, 0.0, self.usable_nm(j) + helped) / self.jerk_limit_rad_s3[j]
        };
        of_joint(Joint::Pan).max(of_joint(Joint::Tilt))
    }

    /// A dark segment that turns both joints from rest to rest, rad, as [`turn`](crate::turn) does: no faster than that many rad/s and no more suddenly than that many
    /// rad/s², nor than either joint may.
    pub fn turn(
        &self,
        from_rad: PanTilt<f64>,
        to_rad: PanTilt<f64>,
        (speed_rad_s, acceleration_rad_s2): (f64, f64),
    ) -> Segment {
        let least = |limits: PanTilt<f64>, wish: f64| limits.pan.min(limits.tilt).min(wish);
        let speed_rad_s = least(self.speed_limit_rad_s, speed_rad_s);
        let acceleration_rad_s2 = least(self.acceleration_limit_rad_s2, acceleration_rad_s2);
        turn(from_rad, to_rad, (speed_rad_s, acceleration_rad_s2))
    }

    /// What a plan may use of a motor's torque, N m.
    pub(crate) fn usable_nm(&self, joint: Joint) -> f64 {
        self.torque_share * self.motors[joint].torque_limit_nm()
    }

    /// What a torque makes of a joint, and is wished for at most, rad/s².
    pub(crate) fn acceleration_rad_s2(&self, joint: Joint, tilt_rad: f64, torque_nm: f64) -> f64 {
        (torque_nm / self.own_inertia(joint, tilt_rad)).min(self.acceleration_limit_rad_s2[joint])
    }

    /// A torque as a share of what the amplifiers can do.
    pub fn fraction(&self, torque_nm: PanTilt<f64>) -> PanTilt<f64> {
        PanTilt::from_fn(|j| torque_nm[j] / self.motors[j].torque_limit_nm())
    }

    /// The limit that a motion comes nearest to, if it uses nine tenths of one. `torque_fraction` is a share of what
    /// the amplifiers can do, `speed_share` one of the set speed.
    pub(crate) fn binding(
        &self,
        joints: &PanTilt<JointMotion>,
        torque_fraction: PanTilt<f64>,
        speed_share: f64,
    ) -> Option<Binding> {
        const BINDS: f64 = 0.9;
        let of_joint = |j: Joint| {
            let motion = &joints[j];
            [
                (Binding::Torque(j), torque_fraction[j].abs() / self.torque_share),
                (Binding::JointSpeed(j), motion.velocity_rad_s.abs() / self.speed_limit_rad_s[j]),
                (
                    Binding::Acceleration(j),
                    motion.acceleration_rad_s2.abs() / self.acceleration_limit_rad_s2[j],
                ),
            ]
        };
        let all = Joint::BOTH.into_iter().flat_map(of_joint).chain([(Binding::SpeedCap, speed_share)]);
        all.filter(|(_, used)| *used >= BINDS).max_by(|a, b| a.1.total_cmp(&b.1)).map(|(limit, _)| limit)
    }

    /// Joint angles for a point of the target.
    pub fn angles(&self, point: Point) -> Result<PanTilt<f64>, AimError> {
        self.geometry.angles(&self.pose, point)
    }

    /// What the wished-for accelerations would need near `tilt_rad`, for joints whose motor cannot give them.
    pub fn impossible_wishes(&self, tilt_rad: f64) -> Vec<AccelerationDemand> {
        let demands = Joint::BOTH.map(|j| self.demand(j, self.acceleration_limit_rad_s2[j], tilt_rad));
        demands.into_iter().filter(|d| d.needed_v > d.limit_v).collect()
    }

    /// Inertia and friction are counted in what is needed; gravity, which helps one way and hinders the other, in
    /// what is possible for sure.
    fn demand(&self, joint: Joint, asked_rad_s2: f64, tilt_rad: f64) -> AccelerationDemand {
        let inertia = self.own_inertia(joint, tilt_rad);
        let motor = &self.motors[joint];
        let friction = self.friction[joint].coulomb_pos_nm;
        let held = self.lumped.gravity(tilt_rad)[joint].abs() + friction;
        AccelerationDemand {
            joint,
            asked_rad_s2,
            needed_v: motor.volts_for(asked_rad_s2 * inertia + friction),
            limit_v: motor.limit_v,
            possible_rad_s2: (motor.torque_limit_nm() - held) / inertia,
        }
    }

    /// Acceleration that the weaker motor has for the spot, gravity left out, m/s².
    pub(crate) fn spot_acceleration_m_s2(&self) -> f64 {
        let of_joint =
            |j: Joint| self.acceleration_rad_s2(j, 0.0, self.usable_nm(j) - self.friction[j].coulomb_pos_nm);
        self.pose.distance_m * of_joint(Joint::Pan).min(of_joint(Joint::Tilt)).max(0.0)
    }

    /// Inertia a joint feels, kg m².
    pub(crate) fn own_inertia(&self, joint: Joint, tilt_rad: f64) -> f64 {
        self.lumped.mass(tilt_rad).own_inertia()[joint]
    }

    /// How far each joint may stray for the spot to stay within `tolerance_m`, rad: semi-axes of an ellipse of joint
    /// errors. Where the Jacobian's columns are not at right angles, that ellipse maps to one that is longer by
    /// √(1 + |cos|) at most, so both are made smaller by it. No joint may stray further than the limit.
    pub(crate) fn joint_tolerance(&self, angle_rad: PanTilt<f64>, tolerance_m: f64) -> PanTilt<f32> {
        let right_angles = [Vec2::new(self.pose.distance_m, 0.0), Vec2::new(0.0, self.pose.distance_m)];
        let [a, b] = self.geometry.jacobian(&self.pose, angle_rad).unwrap_or(right_angles);
        let (pan, tilt) = (a.hypot(), b.hypot());
        let safe_m = tolerance_m / (1.0 + (a.dot(b) / (pan * tilt)).abs()).sqrt();
        PanTilt::new(safe_m / pan, safe_m / tilt).map(|stray| stray.min(self.tolerance_limit_rad) as f32)
    }
}
