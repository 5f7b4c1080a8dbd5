//! Observers: position, velocity and acceleration of a joint from an incremental encoder.
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

pub(crate) mod config;
mod covariance;
mod differences;
mod edge_table;
mod edge_times;
mod kalman;
mod past;
mod recount;
mod tracking_loop;
pub(crate) mod tuning;

use tracelight_rig::Measurement;

use crate::axis::AxisConfig;
use crate::estimate::{Effort, Estimate};
use config::ObserverConfig;
use differences::Differences;
use edge_times::EdgeTimes;
use recount::Recount;
use tracking_loop::TrackingLoop;

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

    /// Returns the current estimate.
    pub fn estimate(&self, axis: &AxisConfig) -> Estimate {
        match &self.0 {
            Kind::Differences(observer) => observer.estimate(axis.count_rad),
            Kind::EdgeTimes(observer) => observer.estimate(axis.count_rad),
            Kind::TrackingLoop(observer) => observer.estimate(axis.count_rad),
            Kind::Kalman(observer) => observer.estimate(axis),
        }
    }
}
