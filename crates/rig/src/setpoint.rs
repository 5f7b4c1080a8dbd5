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
