/// Where one joint should be at one instant.
///
/// Produced by [`Segment::sample`]; consumed by the law once per tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Setpoint {
    /// Angle, rad; zero is the calibrated straight-ahead pose.
    pub position_rad: f32,
    /// Angular velocity, rad/s.
    pub velocity_rad_s: f32,
    /// Angular acceleration, rad/s².
    pub acceleration_rad_s2: f32,
}

impl Setpoint {
    /// Of a joint that rests at an angle, rad.
    #[must_use]
    pub const fn at_rest(position_rad: f32) -> Self {
        Self { position_rad, velocity_rad_s: 0.0, acceleration_rad_s2: 0.0 }
    }
}
