//! Configuration of a joint's observer.

use super::tuning::KalmanTuning;

/// Longest interval of [`ObserverConfig::Differences`] and [`ObserverConfig::EdgeTimes`], ticks.
pub const LONGEST_INTERVAL_TICKS: usize = 64;

/// Method that estimates position and velocity from counts.
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
