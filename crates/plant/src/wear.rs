//! Deviations of a real head from its equations.

/// Deviations of a real head from its equations. [`Wear::NONE`] is a head as good as new.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wear {
    /// Break-away over Coulomb friction, ≥ 1.
    pub stribeck_ratio: f64,
    /// Speed at which that excess has fallen to 1/e, rad/s.
    pub stribeck_speed_rad_s: f64,
    /// Friction's ripple over a turn, as a share of it; its phase is drawn from the seed.
    pub friction_ripple: f64,
    /// Largest misplacement of an encoder edge, counts; the four-phase table is drawn from the seed.
    pub edge_error_counts: f64,
    /// Play between encoder and beam, rad: the beam lags by half of it either way.
    pub backlash_rad: f64,
    /// Largest relative error of an amplifier's gain; drawn from the seed.
    pub gain_spread: f64,
    /// With how many Hz what a joint carries swings on its belt; zero for belts that do not give.
    pub belt_resonance_hz: f64,
    /// Backlash between encoder and beam, rad: the beam lags by half of it either way.
    pub belt_damping: f64,
    /// Whether encoders sit on the motors' side of the belts and read the rotors; else they read the joints.
    pub encoders_at_motors: bool,
    /// Amplitude of the reading error of an off-centre encoder disc, with one period a turn, counts. The seed determines the phase.
    pub eccentricity_counts: f64,
    /// Time constant with which an amplifier's current follows its command, s.
    pub current_lag_s: f64,
    /// How much less torque a motor has for each rad/s at its joint, because its own voltage works against the amplifier, N m s/rad.
    pub back_emf_nm_s_per_rad: f64,
    /// Share by which the supply ripples, with twice the mains frequency, and every volt's torque with it.
    pub supply_ripple: f64,
    /// Spring of the cables that hang on each joint, N m/rad; drawn from the seed is where they do not pull.
    pub cable_nm_per_rad: f64,
    /// How far a control tick may come early or late, s.
    pub jitter_s: f64,
    /// Share of edges the counter misses.
    pub lost_counts: f64,
}

impl Wear {
    /// No wear.
    pub const NONE: Self = Self {
        stribeck_ratio: 1.0,
        stribeck_speed_rad_s: 0.02,
        friction_ripple: 0.0,
        edge_error_counts: 0.0,
        backlash_rad: 0.0,
        gain_spread: 0.0,
        belt_resonance_hz: 0.0,
        belt_damping: 0.03,
        encoders_at_motors: true,
        eccentricity_counts: 0.0,
        current_lag_s: 0.0,
        back_emf_nm_s_per_rad: 0.0,
        supply_ripple: 0.0,
        cable_nm_per_rad: 0.0,
        jitter_s: 0.0,
        lost_counts: 0.0,
    };
}
