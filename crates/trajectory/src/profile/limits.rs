//! Limits of a move, and its peak values.

/// What a move may do, in whatever unit its distance has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoveLimits {
    /// Highest speed, unit/s.
    pub speed: f64,
    /// Highest acceleration, unit/s².
    pub acceleration: f64,
    /// Highest deceleration, unit/s²; shapes that are symmetric keep to the smaller of the two.
    pub deceleration: f64,
}

/// The most of a move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peaks {
    /// Highest speed, unit/s.
    pub speed: f64,
    /// Highest acceleration, unit/s²; what a jump of the speed would be is left out.
    pub acceleration: f64,
    /// Highest deceleration, unit/s².
    pub deceleration: f64,
    /// Highest jerk, unit/s³; none where the acceleration jumps.
    pub jerk: Option<f64>,
    /// By how much the speed jumps at both ends, unit/s.
    pub speed_jump: f64,
}
