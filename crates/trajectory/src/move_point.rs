//! State of motion of one coordinate at one time.

/// Place, speed and acceleration at one time of a move.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MovePoint {
    /// From the start, unit.
    pub position: f64,
    /// unit/s.
    pub velocity: f64,
    /// unit/s².
    pub acceleration: f64,
}

impl MovePoint {
    /// Negates position, speed and acceleration.
    pub(crate) fn mirrored(&self) -> Self {
        Self { position: -self.position, velocity: -self.velocity, acceleration: -self.acceleration }
    }
}
