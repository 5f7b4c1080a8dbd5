use tracelight_rig::{Joint, PanTilt, TICK_F64_S};

use crate::plan::JointMotion;
use crate::{Bounds, Machine, MovePoint, Steered, steer, steer_no_faster};

/// A dark move between joints that are under way, or from or to rest: the fastest there is within each joint's own
/// limits of acceleration and jerk.
///
/// Those limits are what the motors have left after friction, gravity and coupling anywhere on the move, found by
/// shrinking them until a check of the torque of every tick passes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Swing {
    from: PanTilt<JointMotion>,
    to: PanTilt<JointMotion>,
    bounds: PanTilt<Bounds>,
}

/// Each round takes at least 3 % off a bound that is too high.
const ROUNDS: usize = 150;

/// A swing that takes longer is none, s.
const LONGEST_S: f64 = 5.0;

impl Swing {
    /// With what the motors have where it starts; acceleration builds up over `rise_s`.
    pub(crate) fn new(
        machine: &Machine,
        from: PanTilt<JointMotion>,
        to: PanTilt<JointMotion>,
        rise_s: f64,
    ) -> Self {
        let bounds = PanTilt::from_fn(|j| first_bounds(machine, j, &from, &to, rise_s));
        Self { from, to, bounds }
    }

    fn steered(&self) -> Option<Steered<2>> {
        let [from, to] = self.ends();
        steer(&from, &to, &[self.bounds.pan, self.bounds.tilt]).ok()
    }

    fn ends(&self) -> [[MovePoint; 2]; 2] {
        [self.from, self.to].map(|end| [end.pan, end.tilt].map(MovePoint::from))
    }

    /// About how long it takes, s; what gravity and coupling cost is left out. `None` if there is none.
    pub(crate) fn estimate_s(&self) -> Option<f64> {
        self.steered().map(|way| way.duration_s()).filter(|&time| time < LONGEST_S)
    }

    /// Both joints at every tick, the start left out, the end included. `None` where motors are too weak for it, or a
    /// joint would leave its range.
    pub(crate) fn ticks(mut self, machine: &Machine) -> Option<Vec<PanTilt<JointMotion>>> {
        for _ in 0..ROUNDS {
            let motion = self.sampled()?;
            if !in_range(machine, &motion) {
                return None;
            }
            if !self.shrink(machine, &motion) {
                return Some(motion);
            }
        }
        None
    }

    /// The move in whole ticks.
    fn sampled(&self) -> Option<Vec<PanTilt<JointMotion>>> {
        let [from, to] = self.ends();
        let bounds = [self.bounds.pan, self.bounds.tilt];
        let mut way = self.steered()?;
        let mut ticks = whole_ticks(way.duration_s())?;
        // one that has to take longer than the next tick may not fit the one after either
        for _ in 0..8 {
            way = steer_no_faster(&from, &to, &bounds, ticks as f64 * TICK_F64_S).ok()?;
            let needed = whole_ticks(way.duration_s())?;
            if needed == ticks {
                break;
            }
            ticks = needed;
        }
        let at = |tick: usize| {
            let [pan, tilt] = if tick == ticks { to } else { way.at(tick as f64 * TICK_F64_S) };
            PanTilt::new(JointMotion::from(pan), JointMotion::from(tilt))
        };
        Some((1..=ticks).map(at).collect())
    }

    /// Lowers the bounds that ask too much of a motor; false if there are none.
    fn shrink(&mut self, machine: &Machine, motion: &[PanTilt<JointMotion>]) -> bool {
        // largest share of each motor's torque while its joint speeds up backwards and forwards
        let mut worst = PanTilt::new([0.0f64; 2], [0.0f64; 2]);
        for joints in motion {
            let torque = machine.torque(
                joints.map(|j| j.position_rad),
                joints.map(|j| j.velocity_rad_s),
                joints.map(|j| j.acceleration_rad_s2),
            );
            let fraction = machine.fraction(torque).map(f64::abs);
            for joint in Joint::BOTH {
                let way = usize::from(joints[joint].acceleration_rad_s2 > 0.0);
                // a number that is none is too much
                let asked = if fraction[joint].is_nan() { f64::INFINITY } else { fraction[joint] };
                worst[joint][way] = worst[joint][way].max(asked);
            }
        }
        let allowed = machine.torque_share;
        let mut lowered = false;
        for joint in Joint::BOTH {
            for way in 0..2 {
                if worst[joint][way] > allowed {
                    let share = (allowed / worst[joint][way]).clamp(0.5, 0.97);
                    self.bounds[joint].acceleration[way] *= share;
                    self.bounds[joint].jerk *= share.sqrt();
                    lowered = true;
                }
            }
        }
        lowered
    }
}

fn whole_ticks(time_s: f64) -> Option<usize> {
    let ticks = (time_s / TICK_F64_S - 1e-6).ceil().max(1.0);
    (ticks * TICK_F64_S < LONGEST_S).then_some(ticks as usize)
}

fn in_range(machine: &Machine, motion: &[PanTilt<JointMotion>]) -> bool {
    let range = &machine.geometry.range_rad;
    motion.iter().all(|joints| {
        Joint::BOTH.iter().all(|&j| {
            let (least, most) = range[j];
            (least..=most).contains(&joints[j].position_rad)
        })
    })
}

/// Friction helps to brake: it is taken for the way the joint goes on the whole.
fn first_bounds(
    machine: &Machine,
    joint: Joint,
    from: &PanTilt<JointMotion>,
    to: &PanTilt<JointMotion>,
    rise_s: f64,
) -> Bounds {
    let inertia = machine.own_inertia(joint, from.tilt.position_rad);
    let friction = &machine.friction[joint];
    let helped = machine.lumped.gravity(from.tilt.position_rad)[joint].abs();
    let torque = machine.torque_share * machine.motors[joint].torque_limit_nm() + helped;
    let forwards = to[joint].position_rad >= from[joint].position_rad;
    let coulomb = if forwards { friction.coulomb_pos_nm } else { friction.coulomb_neg_nm };
    let wish = machine.acceleration_limit_rad_s2[joint];
    let least = 1e-3;
    let up = ((torque - coulomb) / inertia).min(wish).max(least);
    let down = ((torque + coulomb) / inertia).min(wish).max(least);
    let ends = [from[joint], to[joint]].map(|end| end.acceleration_rad_s2);
    let acceleration =
        [ends.iter().fold(-down, |a, &end| a.min(end)), ends.iter().fold(up, |a, &end| a.max(end))];
    let speed = machine.speed_limit_rad_s[joint];
    Bounds { velocity: [-speed, speed], acceleration, jerk: up.min(down) / rise_s.max(TICK_F64_S) }
}

impl From<JointMotion> for MovePoint {
    fn from(motion: JointMotion) -> Self {
        let JointMotion { position_rad, velocity_rad_s, acceleration_rad_s2 } = motion;
        Self { position: position_rad, velocity: velocity_rad_s, acceleration: acceleration_rad_s2 }
    }
}

impl From<MovePoint> for JointMotion {
    fn from(point: MovePoint) -> Self {
        let MovePoint { position, velocity, acceleration } = point;
        Self { position_rad: position, velocity_rad_s: velocity, acceleration_rad_s2: acceleration }
    }
}
