use tracelight_rig::{Measurement, TICK_S};

use crate::estimate::Estimate;

/// A double integrator that is held to the count's middle by both its poles at −ω: the tracking loop of resolver
/// converters, and what open motor controllers use. In ticks both poles are at r = exp(−ωT), which gives the gains
/// 1 − r² and (1 − r)² of the fading-memory filter (Zarchan & Musoff, *Fundamentals of Kalman Filtering*, §8).
#[derive(Clone, Copy, Debug)]
pub(super) struct TrackingLoop {
    count: i32,
    /// Estimate − middle of the count, counts: small numbers keep their digits.
    offset: f32,
    /// Counts a tick.
    rate: f32,
    /// Counts a tick².
    acceleration: f32,
    /// r.
    pole: f32,
}

impl TrackingLoop {
    pub(super) fn at_rest(count: i32, bandwidth_rad_s: f32) -> Self {
        Self { count, offset: 0.0, rate: 0.0, acceleration: 0.0, pole: libm::expf(-bandwidth_rad_s * TICK_S) }
    }

    pub(super) fn tick(&mut self, measured: &Measurement) {
        let moved = measured.count.wrapping_sub(self.count);
        self.count = measured.count;
        let error = moved as f32 - (self.offset + self.rate);
        let fading = 1.0 - self.pole;
        let change = fading * fading * error;
        self.offset = -self.pole * self.pole * error;
        self.rate += change;
        // as smooth as the loop itself
        self.acceleration += fading * (change - self.acceleration);
    }

    pub(super) fn estimate(&self, count_rad: f32) -> Estimate {
        Estimate {
            position_rad: (self.count as f32 + self.offset) * count_rad,
            velocity_rad_s: self.rate * count_rad / TICK_S,
            acceleration_rad_s2: self.acceleration * count_rad / (TICK_S * TICK_S),
            ..Estimate::default()
        }
    }
}
