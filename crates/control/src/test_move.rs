use tracelight_rig::{Joint, PanTilt, Setpoint, TICK_S};

use crate::axis::AxisConfig;
use crate::config::Config;
use crate::elementary::root;
use crate::servo::Reference;

/// Share of a motor's torque a test move uses.
const TORQUE_SHARE: f32 = 0.45;
/// Least way of it, counts: edges tell by how they lie in time.
const LEAST_COUNTS: f32 = 8.0;
/// Time in which a joint speeds up, at least, s.
const LEAST_S: f32 = 0.06;

/// A little way to and fro of both joints, in the dark, by which encoders show whether they follow their motors: both joints speed up,
/// brake, and come back, towards the middle of their ranges.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TestMove {
    from: PanTilt<f32>,
    acceleration_rad_s2: PanTilt<f32>,
    /// Of each of its four parts.
    part_ticks: u16,
    tick: u16,
}

impl TestMove {
    /// From where both joints are to rest.
    pub(crate) fn from(config: &Config, goal: &PanTilt<Setpoint>) -> Self {
        let most = |j: Joint| config.sped_up_by(j, TORQUE_SHARE);
        let part_s = Joint::BOTH.into_iter().map(|j| part_s(&config.axes[j], most(j))).fold(0.0, f32::max);
        // what no head needs does not run over
        let part_ticks = (libm::ceilf(part_s / TICK_S) as u16).min(u16::MAX / 4);
        let from = goal.map(|setpoint| setpoint.position_rad);
        let acceleration_rad_s2 = PanTilt::from_fn(|j| {
            let limits = &config.axes[j].limits;
            let upwards = from[j] < 0.5 * (limits.lower_rad + limits.upper_rad);
            if upwards { most(j) } else { -most(j) }
        });
        Self { from, acceleration_rad_s2, part_ticks, tick: 0 }
    }

    pub(crate) const fn is_over(&self) -> bool {
        self.tick >= 4 * self.part_ticks
    }

    /// Where both joints are to be now and half a tick later, moved on by a tick.
    pub(crate) fn tick(&mut self) -> Reference {
        let tick = f32::from(self.tick);
        self.tick += 1;
        Reference { now: self.at(tick), ahead: self.at(tick + 0.5) }
    }

    fn at(&self, tick: f32) -> PanTilt<Setpoint> {
        let (way, speed, push) = self.shape(tick);
        PanTilt::from_fn(|j| {
            let acceleration = self.acceleration_rad_s2[j];
            Setpoint {
                position_rad: self.from[j] + acceleration * way,
                velocity_rad_s: acceleration * speed,
                acceleration_rad_s2: acceleration * push,
            }
        })
    }

    /// Way, speed and acceleration for an acceleration of one: speed up, brake and turn round, speed up backwards, brake.
    fn shape(&self, tick: f32) -> (f32, f32, f32) {
        let part = f32::from(self.part_ticks) * TICK_S;
        let time = tick * TICK_S;
        let (there, back) = (part * part, 4.0 * part - time);
        if time < part {
            (0.5 * time * time, time, 1.0)
        } else if time < 3.0 * part {
            let late = time - 2.0 * part;
            (there - 0.5 * late * late, -late, -1.0)
        } else {
            (0.5 * back * back, -back, 1.0)
        }
    }
}

/// How long a joint has to speed up so that its way is long enough, s.
fn part_s(axis: &AxisConfig, most_rad_s2: f32) -> f32 {
    root(LEAST_COUNTS * axis.count_rad / most_rad_s2).max(LEAST_S)
}
