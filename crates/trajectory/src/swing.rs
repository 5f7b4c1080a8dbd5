use tracelight_rig::{Joint, PanTilt, TICK_F64_S};

use crate::machine::Machine;
use crate::mark::BORROW;
use crate::motion::JointMotion;
use crate::move_point::MovePoint;
use crate::steer::bounds::Bounds;
use crate::steer::{Steered, steer, steer_no_faster};
use crate::travel::{ROUNDS, kept_share, least_shrink};

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
    /// One that takes longer is none.
    longest_s: f64,
}

/// The fastest move of both joints from rest to rest within the machine's limits, tick by tick, the start left out, the
/// end included; acceleration builds up over `rise_s`. `None` where motors are too weak for it, or a joint would leave
/// its range.
pub fn rest_to_rest(
    machine: &Machine,
    from_rad: PanTilt<f64>,
    to_rad: PanTilt<f64>,
    rise_s: f64,
) -> Option<Vec<PanTilt<JointMotion>>> {
    let (from, to) = (from_rad.map(JointMotion::at_rest), to_rad.map(JointMotion::at_rest));
    Swing::new(machine, from, to, rise_s).ticks(machine)
}

/// Duration that every swing may take, s.
const LONGEST_S: f64 = 5.0;

/// Longest swing relative to its duration without gravity and coupling.
const SLOWER: f64 = 6.0;

/// Longest swing in any case, s.
const LONGEST_OF_ALL_S: f64 = 60.0;

/// Of a motor that can hardly move its joint, rad/s².
pub(crate) const LEAST_RAD_S2: f64 = 1e-3;

impl Swing {
    /// With what the motors have where it starts; acceleration builds up over `rise_s`.
    pub(crate) fn new(
        machine: &Machine,
        from: PanTilt<JointMotion>,
        to: PanTilt<JointMotion>,
        rise_s: f64,
    ) -> Self {
        let bounds = PanTilt::from_fn(|j| first_bounds(machine, j, &from, &to, rise_s));
        Self { from, to, bounds, longest_s: LONGEST_OF_ALL_S }
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
        self.steered().map(|way| way.duration_s()).filter(|&time| time < LONGEST_OF_ALL_S)
    }

    /// Both joints at every tick, the start left out, the end included. `None` where motors are too weak for it, or a
    /// joint would leave its range.
    pub(crate) fn ticks(mut self, machine: &Machine) -> Option<Vec<PanTilt<JointMotion>>> {
        self.longest_s = (SLOWER * self.steered()?.duration_s()).clamp(LONGEST_S, self.longest_s);
        for round in 0..ROUNDS {
            let motion = self.sampled()?;
            if !in_range(machine, &motion) {
                return None;
            }
            if !self.shrink(machine, &motion, least_shrink(round))? {
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
        let mut ticks = self.whole_ticks(way.duration_s())?;
        // one that has to take longer than the next tick may not fit the one after either
        for _ in 0..8 {
            way = steer_no_faster(&from, &to, &bounds, ticks as f64 * TICK_F64_S).ok()?;
            let needed = self.whole_ticks(way.duration_s())?;
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

    fn whole_ticks(&self, time_s: f64) -> Option<usize> {
        let ticks = (time_s / TICK_F64_S - 1e-6).ceil().max(1.0);
        (ticks * TICK_F64_S <= self.longest_s + TICK_F64_S).then_some(ticks as usize)
    }

    /// Lowers the bounds that ask too much of a motor; false if there are none, `None` if that cannot help.
    fn shrink(&mut self, machine: &Machine, motion: &[PanTilt<JointMotion>], least: f64) -> Option<bool> {
        // largest share of each motor's torque while its joint speeds up backwards and forwards
        let mut worst = PanTilt::new([0.0f64; 2], [0.0f64; 2]);
        for joints in motion {
            let fraction = asked(machine, joints);
            for joint in Joint::BOTH {
                let way = usize::from(joints[joint].acceleration_rad_s2 > 0.0);
                worst[joint][way] = worst[joint][way].max(fraction[joint]);
            }
        }
        let ends = [&self.from, &self.to];
        let given = ends.map(|end| asked(machine, end));
        let mut lowered = false;
        for joint in Joint::BOTH {
            // near an end that takes all there is, the move may borrow what a leg may
            let most = given[0][joint].max(given[1][joint]);
            let allowed =
                machine.torque_share.max((most + BORROW).min(machine.torque_share + BORROW)).max(most);
            for way in [0, 1].into_iter().filter(|&way| worst[joint][way] > allowed) {
                let sign = if way == 0 { -1.0 } else { 1.0 };
                let needed =
                    ends.iter().fold(0.0, |a: f64, end| a.max(sign * end[joint].acceleration_rad_s2));
                let bounds = &mut self.bounds[joint];
                let now = sign * bounds.acceleration[way];
                if now <= needed {
                    return None;
                }
                let excess_nm = (worst[joint][way] - allowed) * machine.motors[joint].torque_limit_nm();
                let excess = excess_nm / machine.own_inertia(joint, self.from.tilt.position_rad);
                let share = kept_share(now, excess, least);
                bounds.acceleration[way] = sign * (share * now).max(needed).max(LEAST_RAD_S2);
                bounds.jerk *= share.sqrt();
                lowered = true;
            }
        }
        Some(lowered)
    }
}

/// Shares of the motors' torque a motion asks for; a number that is none is too much.
fn asked(machine: &Machine, joints: &PanTilt<JointMotion>) -> PanTilt<f64> {
    machine.fraction_of(joints).map(|share| if share.is_nan() { f64::INFINITY } else { share.abs() })
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
    let friction = &machine.friction[joint];
    // gravity pulls one way: where it pulls least
    let torque = machine.usable_nm(joint);
    let gravity = [from, to].map(|end| machine.lumped.gravity(end.tilt.position_rad)[joint]);
    let (least_nm, most_nm) = (gravity[0].min(gravity[1]), gravity[0].max(gravity[1]));
    let forwards = to[joint].position_rad >= from[joint].position_rad;
    let coulomb = if forwards { friction.coulomb_pos_nm } else { friction.coulomb_neg_nm };
    let most = |torque_nm: f64| {
        machine.acceleration_rad_s2(joint, from.tilt.position_rad, torque_nm).max(LEAST_RAD_S2)
    };
    let (up, down) = (most(torque - coulomb - least_nm), most(torque + coulomb + most_nm));
    let ends = [from[joint], to[joint]].map(|end| end.acceleration_rad_s2);
    let acceleration =
        [ends.iter().fold(-down, |a, &end| a.min(end)), ends.iter().fold(up, |a, &end| a.max(end))];
    let speed = machine.speed_limit_rad_s[joint];
    let jerk = (up.min(down) / rise_s.max(TICK_F64_S)).min(machine.jerk_limit_rad_s3[joint]);
    Bounds { velocity: [-speed, speed], acceleration, jerk }
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
