use tracelight_control::{
    AxisConfig, Config, Creep, Drive, Feedback, Feedforward, Foot, FrictionModel, HeadModel, KalmanTuning,
    LawConfig, MotorRating, ObserverConfig, Quirks, StateFeedback,
};
use tracelight_rig::{JointLimits, PanTilt};

/// What the controller of the preset `report` is told, as numbers: a board has no preset. A test holds it to the preset's.
pub fn report() -> Config {
    Config {
        drive: Drive::Volts,
        model: HeadModel {
            m11_fixed: 0.07470929,
            m11_ss: 0.00030430607,
            m11_sc: 0.000140415,
            m11_cc: 0.0014487875,
            m12_s: 0.00023046375,
            m12_c: -2.106611e-5,
            m22: 0.0750286,
            gravity_c: 0.14967933,
            gravity_s: 0.0091803325,
        },
        axes: PanTilt::new(
            axis(0.061910957, 3.1461947, 4.877562, (0.0009, 0.0009, 0.0406, -0.0385)),
            axis(0.0773887, 1.6626648, 6.188736, (0.0019, 0.0017, 0.0584, -0.0569)),
        ),
        hold_limit_ticks: 3000,
        laser_on_ticks: 5,
        laser_off_ticks: 3,
        enable_on_ticks: 0,
        enable_off_ticks: 0,
        host_silence_ticks: 50,
        host_lost_ticks: 1000,
        lead_ticks: 0,
        standing_ticks: 1000,
        standing_radius_rad: 0.0014771085,
        tolerance_limit_rad: 0.1,
        foot: Foot { jolt_rad_s: 0.035, turned_rad: 3e-4, sway: None },
        park_rad: None,
    }
}

/// A joint, by its torque per volt, its range either way, the acceleration of its hops and its friction.
fn axis(
    torque_nm_per_v: f32,
    range_rad: f32,
    acceleration_rad_s2: f32,
    friction: (f32, f32, f32, f32),
) -> AxisConfig {
    let (viscous_pos, viscous_neg, coulomb_pos_nm, coulomb_neg_nm) = friction;
    let state = StateFeedback { bandwidth_rad_s: 120.0, damping: 0.8 };
    AxisConfig {
        torque_nm_per_v,
        limit_v: 10.0,
        back_emf_v_s_per_rad: 0.0,
        dead_band_v: 0.0,
        count_rad: 0.0015339808,
        friction: FrictionModel { viscous_pos, viscous_neg, coulomb_pos_nm, coulomb_neg_nm },
        unknown_nm: coulomb_pos_nm,
        scale_tolerance: 0.35,
        quirks: Quirks::NONE,
        observer: ObserverConfig::Kalman(KalmanTuning::LEARNING),
        law: LawConfig { feedback: Feedback::State(state), feedforward: Feedforward::Learned },
        creep: Some(Creep {
            below_rad_s: 0.01994175,
            turn_s: 0.02,
            hop_rad: 9.203885e-5,
            acceleration_rad_s2,
        }),
        rating: MotorRating { continuous_share: 0.7, heating_s: 60.0 },
        limits: JointLimits {
            lower_rad: -range_rad,
            upper_rad: range_rad,
            speed_rad_s: 26.4,
            acceleration_rad_s2: 400.0,
        },
    }
}
