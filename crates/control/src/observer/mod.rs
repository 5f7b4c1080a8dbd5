//! Position, velocity and acceleration of a joint from what an incremental encoder says.
//!
//! Plain differences of counts say little: one count of 4096 a turn in one tick of a millisecond is 1.5 rad/s. Five
//! ways out, from the oldest to the best, behind one interface:
//!
//! | observer | idea | knows of the head |
//! |---|---|---|
//! | [`Differences`](ObserverConfig::Differences) | counts gained over a fixed interval | nothing |
//! | [`Washout`](ObserverConfig::Washout) | the position through s·ω/(s + ω) | nothing |
//! | [`EdgeTimes`](ObserverConfig::EdgeTimes) | edges gained over the time between the first and the last (M/T) | nothing |
//! | [`TrackingLoop`](ObserverConfig::TrackingLoop) | a double integrator held to the counts (PLL) | nothing |
//! | [`Kalman`](ObserverConfig::Kalman) | the equations of motion with sticking friction, corrected by edges and counts | its model |

mod covariance;
mod differences;
mod edge_table;
mod edge_times;
mod kalman;
mod past;
mod recount;
mod tracking_loop;

use tracelight_rig::Measurement;

use crate::AxisConfig;
pub(crate) use kalman::MOST_INERTIA;
pub use kalman::{KalmanTuning, Learned, Unknown};

use differences::Differences;
use edge_times::EdgeTimes;
use recount::Recount;
use tracking_loop::TrackingLoop;

/// Longest interval of [`ObserverConfig::Differences`] and [`ObserverConfig::EdgeTimes`], ticks.
pub const LONGEST_INTERVAL_TICKS: usize = 64;

/// How position and velocity are told from counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ObserverConfig {
    /// Counts gained over this many ticks, at most [`LONGEST_INTERVAL_TICKS`].
    Differences(usize),
    /// The washout filter with its corner, rad/s: differences of one tick, smoothed.
    Washout(f32),
    /// Time between the edges of this many ticks, at most [`LONGEST_INTERVAL_TICKS`]; more when none came.
    EdgeTimes(usize),
    /// Tracking loop of that bandwidth, rad/s.
    TrackingLoop(f32),
    /// Kalman filter with sticking friction.
    Kalman(KalmanTuning),
}

/// What is believed of one joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// Angle, rad.
    pub position_rad: f32,
    /// Angular velocity, rad/s.
    pub velocity_rad_s: f32,
    /// Angular acceleration, rad/s².
    pub acceleration_rad_s2: f32,
    /// What the model does not know of this head; nothing for observers that have no model.
    pub learned: Learned,
    /// Counts that are to be added to what its encoder reads, because it lost some or made some up, as far as that was noticed.
    pub lost_counts: i32,
    /// Counts were put back a moment ago, and the next edges have to tell whether rightly.
    pub is_doubtful: bool,
    /// How far off what is taken for load and friction together may be: a standard deviation, N m.
    pub torque_deviation_nm: f32,
}

impl Estimate {
    /// The count a joint is on whose encoder reads that.
    pub(crate) const fn count(&self, measured: &Measurement) -> i32 {
        measured.count.wrapping_add(self.lost_counts)
    }

    /// Whether every number of it is one.
    pub(crate) fn is_finite(&self) -> bool {
        let Learned { load_nm, friction_nm, break_away_nm, inertia_share } = self.learned;
        let motion = self.position_rad + self.velocity_rad_s + self.acceleration_rad_s2;
        let learned = load_nm + friction_nm + break_away_nm + inertia_share;
        (motion + learned + self.torque_deviation_nm).is_finite()
    }
}

/// What acted on a joint during the last tick, as far as is known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Effort {
    /// Torque of the motor, N m.
    pub torque_nm: f32,
    /// Torque that gravity, Coriolis, the other joint's acceleration and cables ask for, N m.
    pub bias_nm: f32,
    /// Inertia the joint feels, kg m².
    pub inertia_kg_m2: f32,
}

/// State of one joint's observer.
#[derive(Clone, Copy, Debug)]
pub struct Observer(Kind);

#[derive(Clone, Copy, Debug)]
#[expect(clippy::large_enum_variant, reason = "there is one a joint, and no heap to put the large ones on")]
enum Kind {
    Differences(Differences),
    EdgeTimes(EdgeTimes),
    TrackingLoop(TrackingLoop),
    Kalman(Recount),
}

impl Observer {
    /// Of a joint on this count that is about at rest: its speed has that standard deviation, rad/s.
    pub fn begin(axis: &AxisConfig, measured: &Measurement, speed_rad_s: f32) -> Self {
        let count = measured.count;
        Self(match axis.observer {
            ObserverConfig::Differences(ticks) => {
                Kind::Differences(Differences::at_rest(count, ticks, f32::INFINITY))
            }
            ObserverConfig::Washout(corner) => Kind::Differences(Differences::at_rest(count, 1, corner)),
            ObserverConfig::EdgeTimes(ticks) => Kind::EdgeTimes(EdgeTimes::at_rest(count, ticks)),
            ObserverConfig::TrackingLoop(bandwidth) => {
                Kind::TrackingLoop(TrackingLoop::at_rest(count, bandwidth))
            }
            ObserverConfig::Kalman(tuning) => Kind::Kalman(Recount::begin(axis, count, speed_rad_s, tuning)),
        })
    }

    /// Of a joint nobody knows how fast it turns, whose encoder is known to be off by so many counts.
    pub(crate) fn anew(
        axis: &AxisConfig,
        measured: &Measurement,
        lost_counts: i32,
        speed_rad_s: f32,
    ) -> Self {
        match Self::begin(axis, measured, speed_rad_s).0 {
            Kind::Kalman(observer) => Self(Kind::Kalman(observer.with_lost(lost_counts))),
            other => Self(other),
        }
    }

    /// One tick: what acted on the joint, and what its encoder reads at the tick's end.
    pub fn tick(&mut self, axis: &AxisConfig, effort: &Effort, measured: &Measurement) {
        match &mut self.0 {
            Kind::Differences(observer) => observer.tick(measured),
            Kind::EdgeTimes(observer) => observer.tick(measured),
            Kind::TrackingLoop(observer) => observer.tick(measured),
            Kind::Kalman(observer) => observer.tick(axis, effort, measured),
        }
    }

    /// What is believed now.
    pub fn estimate(&self, axis: &AxisConfig) -> Estimate {
        match &self.0 {
            Kind::Differences(observer) => observer.estimate(axis.count_rad),
            Kind::EdgeTimes(observer) => observer.estimate(axis.count_rad),
            Kind::TrackingLoop(observer) => observer.estimate(axis.count_rad),
            Kind::Kalman(observer) => observer.estimate(axis),
        }
    }
}
