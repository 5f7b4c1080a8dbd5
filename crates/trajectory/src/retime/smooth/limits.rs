//! Limits of each joint along a smooth path.

/// Limits of a joint's motion, the same both ways.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointLimits {
    /// Highest speed, rad/s.
    pub speed_rad_s: f64,
    /// Highest acceleration, rad/s².
    pub acceleration_rad_s2: f64,
    /// Highest jerk, rad/s³.
    pub jerk_rad_s3: f64,
}
