//! Options of a fit.

/// How [`fit`](crate::fit) treats its points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitOptions {
    /// Furthest the path may be from the points, in their unit; it should be some four times their noise.
    pub tolerance: f64,
    /// Change of direction from which on a break is a corner, rad.
    pub corner_rad: f64,
    /// Half the width of what drew the line: points nearer than this to a corner (more, to an acute one) show the
    /// pen's shape and are not used.
    pub reach: f64,
}

impl FitOptions {
    /// Corners from 25° on, hidden by no more than four tolerances either side.
    pub fn new(tolerance: f64) -> Self {
        Self { tolerance, corner_rad: 25f64.to_radians(), reach: 4.0 * tolerance }
    }

    /// Distance of the samples that are looked at: no finer than the points' noise nor than the pen can turn.
    pub(super) fn step(&self) -> f64 {
        (2.0 * self.tolerance).max(self.reach / 3.0)
    }
}
