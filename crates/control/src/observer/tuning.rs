//! Noise parameters of the Kalman filter.

/// How far the filter trusts model and encoder. Shares are of [`AxisConfig::unknown_nm`](crate::AxisConfig::unknown_nm).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KalmanTuning {
    /// Spectral density of accelerations that nothing explains, (rad/s²)²·s.
    pub acceleration_noise: f32,
    /// Standard deviation of an edge's place, counts.
    pub edge_noise_counts: f32,
    /// How far the model may run past an edge that did not come before the joint is taken to be still there, counts: a
    /// few such measurements are independent of each other, one a tick would not be.
    pub bound_slack_counts: f32,
    /// Standard deviation of such a measurement, counts.
    pub bound_noise_counts: f32,
    /// A torque that acts besides.
    pub load: Unknown,
    /// Coulomb friction.
    pub friction: Unknown,
    /// Random change of friction with the angle, share²/rad.
    pub friction_change: f32,
    /// Excess of friction near standstill.
    pub break_away: Unknown,
    /// Inertia; shares of itself.
    pub inertia: Unknown,
}

/// How little is known of a quantity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Unknown {
    /// Standard deviation before anything was seen, a share.
    pub deviation: f32,
    /// How it drifts, share²/s.
    pub drift: f32,
}

impl Unknown {
    const NONE: Self = Self { deviation: 0.0, drift: 0.0 };
}

impl KalmanTuning {
    /// Learns load, friction and inertia while it observes. Found on simulated heads with friction ±15 %, inertia and
    /// gravity ±5 %, sticking, ripple and 0.1-count edges: a random search over all values together, then each in steps.
    pub const LEARNING: Self = Self {
        acceleration_noise: 7.5e-4,
        edge_noise_counts: 0.04,
        bound_slack_counts: 0.05,
        bound_noise_counts: 0.3,
        load: Unknown { deviation: 0.15, drift: 5e-4 },
        friction: Unknown { deviation: 0.3, drift: 3.5e-5 },
        friction_change: 0.16,
        break_away: Unknown { deviation: 0.3, drift: 0.0 },
        inertia: Unknown { deviation: 0.13, drift: 1.5e-8 },
    };

    /// Believes the model, and calls whatever differs a load; where the edges lie it learns, too.
    pub const BELIEVING: Self = Self {
        acceleration_noise: 1e-3,
        edge_noise_counts: 0.08,
        bound_slack_counts: 0.0,
        bound_noise_counts: 0.13,
        load: Unknown { deviation: 0.3, drift: 0.03 },
        friction: Unknown::NONE,
        friction_change: 0.0,
        break_away: Unknown::NONE,
        inertia: Unknown::NONE,
    };
}
