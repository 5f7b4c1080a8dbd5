use tracelight_rig::{Measurement, TICK_S};

use super::config::LONGEST_INTERVAL_TICKS;
use super::past::Past;
use crate::estimate::Estimate;

/// Counts gained over a fixed interval, smoothed by a low-pass of first order: with an interval of one tick the
/// washout filter s·ω/(s + ω), with an infinite corner plain differences.
///
/// These are the 2006 report's two: what its FPGA did, and what it meant to try next. The position is the count's
/// middle. The step of the velocity is a count over the interval, its delay half the interval and 1/ω.
#[derive(Clone, Copy, Debug)]
pub(super) struct Differences {
    counts: Past<i32>,
    /// Smoothed, counts a tick.
    rates: Past<f32>,
    acceleration: f32,
    interval: usize,
    /// Share of a new difference that is taken over in a tick: backward Euler of the low-pass.
    share: f32,
}

impl Differences {
    pub(super) fn at_rest(count: i32, interval_ticks: usize, corner_rad_s: f32) -> Self {
        let interval = interval_ticks.clamp(1, LONGEST_INTERVAL_TICKS);
        let turn = corner_rad_s * TICK_S;
        let share = if turn.is_finite() { turn / (1.0 + turn) } else { 1.0 };
        Self { counts: Past::constant(count), rates: Past::constant(0.0), acceleration: 0.0, interval, share }
    }

    pub(super) fn tick(&mut self, measured: &Measurement) {
        self.counts.push(measured.count);
        let gained = measured.count.wrapping_sub(self.counts.ago(self.interval));
        let raw = gained as f32 / self.interval as f32;
        let before = self.rates.ago(0);
        self.rates.push(before + self.share * (raw - before));
        let change = (self.rates.ago(0) - self.rates.ago(self.interval)) / self.interval as f32;
        self.acceleration += self.share * (change - self.acceleration);
    }

    pub(super) fn estimate(&self, count_rad: f32) -> Estimate {
        Estimate {
            position_rad: self.counts.ago(0) as f32 * count_rad,
            velocity_rad_s: self.rates.ago(0) * count_rad / TICK_S,
            acceleration_rad_s2: self.acceleration * count_rad / (TICK_S * TICK_S),
            ..Estimate::default()
        }
    }
}
