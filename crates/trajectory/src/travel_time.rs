use tracelight_rig::{Joint, PanTilt};
use tracelight_stroke::{Point, Travel};

use crate::Machine;
use crate::travel::NOTHING_RAD;

/// How long dark moves take from rest to rest, s, for ordering strokes: what the slower joint needs at full torque
/// with Coulomb friction, up to its speed limit.
///
/// Inertia and friction are those at the ends of the move, coupling, gravity and viscous friction are left out, so the times are near
/// those of the plan and no more. Points out of reach are an hour away from any other.
#[derive(Clone, Copy, Debug)]
pub struct TravelTime<'a> {
    machine: &'a Machine,
    lift_s: f64,
}

/// Where a dark move begins or ends.
#[derive(Clone, Copy, Debug)]
pub struct Aimed {
    angle_rad: PanTilt<f64>,
    /// 1/a + 1/d of the highest acceleration and deceleration, s²/rad.
    pace: PanTilt<f64>,
}

impl<'a> TravelTime<'a> {
    /// With the motors of `machine`, and `lift_s` for going dark and settling wherever one stroke does not begin
    /// where the one before ends.
    pub const fn new(machine: &'a Machine, lift_s: f64) -> Self {
        Self { machine, lift_s }
    }

    fn aimed(&self, angle_rad: PanTilt<f64>) -> Aimed {
        let machine = self.machine;
        let pace = PanTilt::from_fn(|j| {
            let inertia = machine.own_inertia(j, angle_rad.tilt);
            let torque = machine.torque_share * machine.motors[j].torque_limit_nm();
            let friction = &machine.friction[j];
            let coulomb = 0.5 * (friction.coulomb_pos_nm - friction.coulomb_neg_nm);
            let wish = machine.acceleration_limit_rad_s2[j];
            let [speeding_up, braking] =
                [torque - coulomb, torque + coulomb].map(|t| (t / inertia).min(wish).max(LEAST_RAD_S2));
            1.0 / speeding_up + 1.0 / braking
        });
        Aimed { angle_rad, pace }
    }

    fn joint_s(&self, joint: Joint, from: &Aimed, to: &Aimed) -> f64 {
        let span = (to.angle_rad[joint] - from.angle_rad[joint]).abs();
        let pace = 0.5 * (from.pace[joint] + to.pace[joint]);
        let limit = self.machine.speed_limit_rad_s[joint];
        // from rest to rest: span = ½ v² pace, time = v pace, up to the speed limit
        let ramps = 0.5 * limit * limit * pace;
        if span <= ramps { (2.0 * span * pace).sqrt() } else { limit * pace + (span - ramps) / limit }
    }
}

/// Of a motor that can hardly start its joint, rad/s²: slow, but no division by zero.
const LEAST_RAD_S2: f64 = 1e-3;

impl Travel for TravelTime<'_> {
    type Place = Option<Aimed>;

    fn place(&self, at: Point) -> Option<Aimed> {
        self.machine.angles(at).ok().map(|angles| self.aimed(angles))
    }

    fn cost(&self, from: Option<Aimed>, to: Option<Aimed>) -> f64 {
        const NEVER_S: f64 = 3600.0;
        let (Some(from), Some(to)) = (from, to) else { return NEVER_S };
        let span = |j: Joint| (to.angle_rad[j] - from.angle_rad[j]).abs();
        if span(Joint::Pan).max(span(Joint::Tilt)) < NOTHING_RAD {
            return 0.0;
        }
        self.lift_s + self.joint_s(Joint::Pan, &from, &to).max(self.joint_s(Joint::Tilt, &from, &to))
    }
}
