use tracelight_rig::{Joint, PanTilt, Setpoint, TICK_S};

use crate::config::{Config, Drive};
use crate::elementary::root;
use crate::estimate::Estimate;
use crate::limit::within;

/// Share of a motor's torque the way back may use; the rest holds against gravity, friction and whoever pushes.
const TORQUE_SHARE: f32 = 0.4;
/// Near the goal the speed falls in proportion to the distance, with this time constant, s.
const APPROACH_S: f32 = 0.04;
/// Distance from the way back at which it is begun anew from where the head is, counts.
const LOST_COUNTS: f32 = 3.0;

/// A gentle way back to where a stroke was left.
///
/// A step of tens of counts would drive the loop from one stop of the amplifier to the other; instead the reference
/// starts where the head is, with its speed, and goes to the goal under a bound on acceleration: v = √(2 a d), linear
/// near the goal, and no faster than the joint may be (proximate time-optimal servomechanism; Workman 1987, cited in Franklin, Powell & Workman, *Digital
/// Control of Dynamic Systems*, §13).
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReturnPath {
    reference: PanTilt<Setpoint>,
}

impl ReturnPath {
    /// From where the head is.
    pub(crate) fn from(estimates: &PanTilt<Estimate>) -> Self {
        let start = |estimate: Estimate| Setpoint {
            position_rad: estimate.position_rad,
            velocity_rad_s: estimate.velocity_rad_s,
            acceleration_rad_s2: 0.0,
        };
        Self { reference: estimates.map(start) }
    }

    /// Whether the head is too far from this way to follow it; one that is believed to be where it was told to be is on it.
    pub(crate) fn is_lost(&self, config: &Config, position_rad: PanTilt<f32>) -> bool {
        config.drive == Drive::Volts
            && Joint::BOTH.iter().any(|&j| {
                (self.reference[j].position_rad - position_rad[j]).abs()
                    > LOST_COUNTS * config.axes[j].count_rad
            })
    }

    /// The reference now, moved on by a tick towards `goal`.
    pub(crate) fn tick(&mut self, config: &Config, goal: &PanTilt<Setpoint>) -> PanTilt<Setpoint> {
        let now = self.reference;
        self.reference = PanTilt::from_fn(|j| {
            let most = match &config.drive {
                Drive::Volts => Most {
                    rate_rad_s: config.axes[j].limits.speed_rad_s,
                    acceleration_rad_s2: config.sped_up_by(j, TORQUE_SHARE),
                },
                Drive::Pulses(gentle) => Most {
                    rate_rad_s: gentle.rate_rad_s[j],
                    acceleration_rad_s2: config
                        .sped_up_by(j, gentle.torque_share[j])
                        .min(gentle.acceleration_rad_s2[j]),
                },
            };
            step(&now[j], goal[j].position_rad, &most)
        });
        if !config.drive.is_open_loop() {
            return now;
        }
        // pulses go out for the tick that begins
        PanTilt::from_fn(|j| Setpoint {
            acceleration_rad_s2: self.reference[j].acceleration_rad_s2,
            ..now[j]
        })
    }
}

/// What a joint may do on its way.
struct Most {
    rate_rad_s: f32,
    acceleration_rad_s2: f32,
}

fn step(from: &Setpoint, goal_rad: f32, most: &Most) -> Setpoint {
    let left = goal_rad - from.position_rad;
    let braking = root(2.0 * most.acceleration_rad_s2 * left.abs());
    let wanted = braking.min(left.abs() / APPROACH_S).min(most.rate_rad_s);
    let wanted = if left < 0.0 { -wanted } else { wanted };
    let acceleration = within((wanted - from.velocity_rad_s) / TICK_S, most.acceleration_rad_s2);
    let velocity = from.velocity_rad_s + acceleration * TICK_S;
    Setpoint {
        position_rad: from.position_rad + 0.5 * TICK_S * (from.velocity_rad_s + velocity),
        velocity_rad_s: velocity,
        acceleration_rad_s2: acceleration,
    }
}
