//! End stops of a joint.

/// Natural frequency of a joint on its end stop, rad/s.
const STOP_RAD_S: f64 = 400.0;
/// Damping of that end stop, as a share of critical damping.
const STOP_DAMPING: f64 = 0.3;

/// Where a joint ends: a stiff spring either way, with a damper that only pushes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stops {
    pub(crate) at_rad: (f64, f64),
    pub(crate) inertia_kg_m2: f64,
}

impl Stops {
    /// On a joint at an angle with a speed, N m.
    pub(crate) fn torque_nm(&self, angle_rad: f64, rate_rad_s: f64) -> f64 {
        let (lower, upper) = self.at_rad;
        let into_rad = angle_rad - angle_rad.clamp(lower, upper);
        if into_rad == 0.0 {
            return 0.0;
        }
        let spring = STOP_RAD_S * STOP_RAD_S * into_rad;
        let back = -self.inertia_kg_m2 * (spring + 2.0 * STOP_DAMPING * STOP_RAD_S * rate_rad_s);
        if into_rad > 0.0 { back.min(0.0) } else { back.max(0.0) }
    }
}
