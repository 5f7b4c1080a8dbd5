use crate::{PanTilt, Setpoint};

/// Slowest and fastest rate that a host may ask of the plan's clock ([`Command::Speed`](crate::Command::Speed)): multiples of the plan's own speed.
pub const SPEED_RANGE: (f32, f32) = (0.1, 2.0);

/// Least time in which the rate of the plan's clock changes by 1, s.
const EASE_S: f32 = 0.15;

/// Acceleration of a joint by a change of that rate, at most, rad/s²: a quarter of what the weaker motor of the report's rig can do. At 1 ft/s on
/// a target 3 ft away both bounds are alike.
const EASE_RAD_S2: f32 = 2.2;

/// How fast the rate of the plan's clock may change where the faster joint is planned to turn that fast, 1/s.
///
/// A clock of rate ρ turns a planned speed q′ into q′ρ, and a planned acceleration q″ into q″ρ² + q′ρ̇. The last term is bounded here.
pub fn ease_per_s(planned_rad_s: f32) -> f32 {
    1.0 / EASE_S.max(planned_rad_s / EASE_RAD_S2)
}

/// How fast the rate of the plan's clock may rise (or fall) where the plan has this motion, 1/s. At a rate up to 1 a change that adds to what the motors do anyway
/// has to leave them within what the plan asks of them; above 1, [`RateLimit`] leaves room for it.
pub fn ease_within(planned: &PanTilt<Setpoint>, rate: f32, rises: bool) -> f32 {
    let most = |s: &Setpoint| {
        let bound = ease_per_s(s.velocity_rad_s.abs());
        let (speed, acceleration) = (s.velocity_rad_s, s.acceleration_rad_s2 * rate * rate);
        let adds = (speed * acceleration > 0.0) == rises && acceleration != 0.0;
        if rate > 1.0 || !adds {
            return bound;
        }
        let left = (EASE_RAD_S2 - acceleration.abs()).max(0.0);
        bound.min(left / speed.abs().max(f32::MIN_POSITIVE))
    };
    most(&planned.pan).min(most(&planned.tilt))
}

/// Fastest that the plan's clock may run along a segment, as multiples of the plan's own speed, so that motors, joint speeds and accelerations
/// stay within the plan's limits. Between its ends, the square of the rate is linear in plan time: a clock that slows down evenly.
///
/// Each is from 1 to the upper end of [`SPEED_RANGE`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateLimit {
    /// At the segment's start.
    pub start: f32,
    /// At its end.
    pub end: f32,
}

impl RateLimit {
    /// No faster than planned.
    pub const PLANNED: Self = Self { start: 1.0, end: 1.0 };

    /// Whether both are within their bounds; what is not a number is not.
    pub fn is_valid(&self) -> bool {
        let bounds = 1.0..=SPEED_RANGE.1;
        bounds.contains(&self.start) && bounds.contains(&self.end)
    }

    /// The larger of both.
    pub const fn most(&self) -> f32 {
        self.start.max(self.end)
    }
}

impl Default for RateLimit {
    fn default() -> Self {
        Self::PLANNED
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_between_the_plan_and_twice_as_fast() {
        assert!(RateLimit::PLANNED.is_valid() && RateLimit { start: 2.0, end: 1.5 }.is_valid());
        for wrong in [0.0, 0.99, 2.01, -1.0, f32::NAN, f32::INFINITY] {
            assert!(!RateLimit { start: wrong, end: 1.0 }.is_valid(), "{wrong}");
            assert!(!RateLimit { start: 1.0, end: wrong }.is_valid(), "{wrong}");
        }
    }

    #[test]
    fn what_adds_to_an_acceleration_waits_until_there_is_room() {
        let moving = |velocity_rad_s, acceleration_rad_s2| {
            PanTilt::new(
                Setpoint { position_rad: 0.0, velocity_rad_s, acceleration_rad_s2 },
                Setpoint::default(),
            )
        };
        // standing, and turning steadily
        assert_eq!(ease_within(&moving(0.0, 0.0), 0.5, true), 1.0 / EASE_S);
        assert_eq!(ease_within(&moving(1.1, 0.0), 0.5, true), 2.0);
        // speeding up by 20 rad/s², at half the rate by 5: no faster now, and slower at once
        assert_eq!(ease_within(&moving(1.1, 20.0), 0.5, true), 0.0);
        assert_eq!(ease_within(&moving(1.1, 20.0), 0.5, false), 2.0);
        assert_eq!(ease_within(&moving(-1.1, 20.0), 0.5, true), 2.0);
        // at a tenth of it, by 0.2: there is room for 2
        assert!((ease_within(&moving(1.1, 20.0), 0.1, true) - 2.0 / 1.1).abs() < 1e-5);
        assert_eq!(ease_within(&moving(1.1, 20.0), 1.5, true), 2.0);
    }
}
