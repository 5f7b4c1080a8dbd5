//! Every observer on counts of a known motion.

#![allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on may panic")]

use tracelight_control::{
    AxisConfig, Effort, Estimate, Feedback, Feedforward, FrictionModel, KalmanTuning, LawConfig, MotorRating,
    Observer, ObserverConfig, Pid, Quirks,
};
use tracelight_rig::{JointLimits, Measurement};

const COUNT_RAD: f64 = std::f64::consts::TAU / 4096.0;
const TICK_S: f64 = 1e-3;
const INERTIA: f64 = 0.075;

fn axis(observer: ObserverConfig) -> AxisConfig {
    AxisConfig {
        torque_nm_per_v: 0.0774,
        limit_v: 10.0,
        back_emf_v_s_per_rad: 0.0,
        dead_band_v: 0.0,
        count_rad: COUNT_RAD as f32,
        friction: FrictionModel::default(),
        unknown_nm: 0.03,
        scale_tolerance: 0.35,
        quirks: Quirks::NONE,
        observer,
        law: LawConfig { feedback: Feedback::Pid(Pid::proportional(1.0)), feedforward: Feedforward::None },
        creep: None,
        rating: MotorRating { continuous_share: 1.0, heating_s: 60.0 },
        limits: JointLimits {
            lower_rad: -3.0,
            upper_rad: 3.0,
            speed_rad_s: 24.0,
            acceleration_rad_s2: 100.0,
        },
    }
}

/// What the encoder reads a tick after `angle`, and when the last edge came.
fn measure(angle: impl Fn(f64) -> f64, t_s: f64, stamps: bool) -> Measurement {
    let count = |t: f64| (angle(t) / COUNT_RAD + 0.5).floor() as i32;
    let (now, before) = (count(t_s), count(t_s - TICK_S));
    let edge = |age: f64| count(t_s - age * TICK_S) != now;
    // the youngest age at which it was elsewhere
    let age = (0..10_000).map(|k| f64::from(k) * 1e-4).find(|&age| edge(age));
    let edge_age_ticks = if stamps && now != before { age.map(|a| a as f32) } else { None };
    Measurement { count: now, edge_age_ticks }
}

/// Estimates at every tick of a motion from rest under known torque, friction left out.
fn observe(
    observer: ObserverConfig,
    (angle, acceleration): (impl Fn(f64) -> f64, impl Fn(f64) -> f64),
    stamps: bool,
    ticks: usize,
) -> Vec<Estimate> {
    let axis = axis(observer);
    let mut state = Observer::begin(&axis, &measure(&angle, 0.0, stamps), 1e-3);
    (1..=ticks)
        .map(|k| {
            let t_s = k as f64 * TICK_S;
            let torque = INERTIA * acceleration(t_s - 0.5 * TICK_S);
            let effort = Effort { torque_nm: torque as f32, bias_nm: 0.0, inertia_kg_m2: INERTIA as f32 };
            state.tick(&axis, &effort, &measure(&angle, t_s, stamps));
            state.estimate(&axis)
        })
        .collect()
}

const ALL: [(&str, ObserverConfig); 6] = [
    ("differences", ObserverConfig::Differences(20)),
    ("washout", ObserverConfig::Washout(50.0)),
    ("edge times", ObserverConfig::EdgeTimes(10)),
    ("tracking loop", ObserverConfig::TrackingLoop(50.0)),
    ("kalman", ObserverConfig::Kalman(KalmanTuning::LEARNING)),
    ("kalman, believing", ObserverConfig::Kalman(KalmanTuning::BELIEVING)),
];

/// Speeds up with 2 rad/s² for 0.3 s, then goes on.
fn start_and_cruise(t: f64) -> f64 {
    if t < 0.3 { t * t } else { 0.09 + 0.6 * (t - 0.3) }
}

fn push(t: f64) -> f64 {
    if t < 0.3 { 2.0 } else { 0.0 }
}

#[test]
fn every_observer_finds_a_steady_speed() {
    for (name, observer) in ALL {
        for stamps in [true, false] {
            let seen = observe(observer, (start_and_cruise, push), stamps, 1200);
            for estimate in &seen[900..] {
                // a count over the interval is the most an observer without stamps is off
                let off = (f64::from(estimate.velocity_rad_s) - 0.6).abs();
                assert!(off < 1.1 * COUNT_RAD / 0.02, "{name}, stamps {stamps}: {off} rad/s");
            }
            let mean = seen[900..].iter().map(|e| f64::from(e.velocity_rad_s)).sum::<f64>() / 300.0;
            assert!((mean - 0.6).abs() < 3e-3, "{name}, stamps {stamps}: {mean} rad/s on average");
        }
    }
}

#[test]
fn with_stamps_edge_times_and_kalman_are_exact() {
    for (name, observer, most) in [("edge times", ALL[2].1, 2e-4), ("kalman", ALL[4].1, 2e-4)] {
        let seen = observe(observer, (start_and_cruise, push), true, 1200);
        let worst = seen[900..].iter().map(|e| (f64::from(e.velocity_rad_s) - 0.6).abs()).fold(0.0, f64::max);
        assert!(worst < most, "{name}: {worst} rad/s");
    }
}

#[test]
fn a_joint_that_stops_is_seen_to_stop() {
    let stop = |t: f64| if t < 0.5 { 0.3 * t } else { 0.15 };
    for (name, observer) in ALL {
        let seen = observe(observer, (stop, |_| 0.0), true, 1500);
        let last = f64::from(seen.last().unwrap().velocity_rad_s);
        assert!(last.abs() < 0.01, "{name}: {last} rad/s a second after it stopped");
        let position = f64::from(seen.last().unwrap().position_rad);
        // edge times take it to have gone on to the next edge, as far as that can be
        assert!((position - 0.15).abs() <= COUNT_RAD, "{name}: {position} rad");
    }
}

#[test]
fn acceleration_is_found_too() {
    // half a turn a second, to and fro
    let w = std::f64::consts::PI;
    let swing = move |t: f64| 0.3 * (1.0 - (w * t).cos());
    let bend = move |t: f64| 0.3 * w * w * (w * t).cos();
    let observer = ObserverConfig::Kalman(KalmanTuning::LEARNING);
    let seen = observe(observer, (swing, bend), true, 4000);
    for (k, estimate) in seen.iter().enumerate().skip(2000) {
        let off = f64::from(estimate.acceleration_rad_s2) - bend((k as f64 + 0.5) * TICK_S);
        assert!(off.abs() < 0.1, "tick {k}: {off} rad/s²");
    }
}

/// A count that the encoder loses or makes up while its joint slides is put back; one that is pushed is believed.
#[test]
fn a_lost_count_is_put_back_and_a_push_is_not() {
    let observer = ObserverConfig::Kalman(KalmanTuning::LEARNING);
    for (wrong, at) in [(1, 700), (-1, 703), (1, 706), (-1, 709)] {
        let axis = axis(observer);
        let mut state = Observer::begin(&axis, &Measurement::default(), 1e-3);
        for k in 0..1200 {
            let t = (f64::from(k) + 1.0) * TICK_S;
            let mut measured = measure(start_and_cruise, t, true);
            measured.count += if k >= at { wrong } else { 0 };
            let effort = Effort {
                torque_nm: (INERTIA * push(t - 0.5 * TICK_S)) as f32,
                inertia_kg_m2: INERTIA as f32,
                ..Effort::default()
            };
            state.tick(&axis, &effort, &measured);
            let estimate = state.estimate(&axis);
            let off_counts = (f64::from(estimate.position_rad) - start_and_cruise(t)) / COUNT_RAD;
            if k > at + 20 {
                assert_eq!(estimate.lost_counts, -wrong, "{wrong} at {at}, tick {k}");
                assert!(off_counts.abs() < 0.1, "{wrong} at {at}, tick {k}: {off_counts} counts");
            }
        }
    }
    let pushed = |t: f64| start_and_cruise(t) + if t < 0.7 { 0.0 } else { 4.0 * (t - 0.7) * (t - 0.7) };
    let seen = observe(observer, (pushed, push), true, 900);
    assert!(seen.iter().all(|estimate| estimate.lost_counts == 0));
}

/// A head with more friction and inertia than is believed: what is learned says how much.
#[test]
fn what_differs_from_the_model_is_learned() {
    let mut axis = axis(ObserverConfig::Kalman(KalmanTuning::LEARNING));
    axis.friction = FrictionModel { coulomb_pos_nm: 0.05, coulomb_neg_nm: -0.05, ..FrictionModel::default() };
    axis.unknown_nm = 0.05;
    let (coulomb, inertia) = (0.056, 1.04 * INERTIA);
    let mut state = Observer::begin(&axis, &Measurement::default(), 1e-3);
    let (mut angle, mut rate) = (0.0f64, 0.0f64);
    for k in 0..6000 {
        let torque = 0.25 * (4.0 * f64::from(k) * TICK_S).sin();
        // friction that sticks, ten substeps a tick
        let mut last_edge = None;
        for step in 0..10 {
            let before = rate;
            let momentum = inertia * rate + 1e-4 * torque;
            rate = if momentum.abs() <= 1e-4 * coulomb {
                0.0
            } else {
                (momentum - 1e-4 * coulomb * momentum.signum()) / inertia
            };
            let was = (angle / COUNT_RAD + 0.5).floor();
            angle += 0.5e-4 * (before + rate);
            if (angle / COUNT_RAD + 0.5).floor() != was {
                last_edge = Some(step);
            }
        }
        let age = last_edge.map(|step| 1.0 - (f64::from(step) + 0.5) / 10.0);
        let measured = Measurement {
            count: (angle / COUNT_RAD + 0.5).floor() as i32,
            edge_age_ticks: age.map(|a| a as f32),
        };
        let effort = Effort { torque_nm: torque as f32, bias_nm: 0.0, inertia_kg_m2: INERTIA as f32 };
        state.tick(&axis, &effort, &measured);
    }
    let learned = state.estimate(&axis).learned;
    assert!((learned.friction_nm - 0.006).abs() < 0.0015, "{learned:?}");
    assert!((learned.inertia_share - 0.04).abs() < 0.01, "{learned:?}");
    assert!(learned.load_nm.abs() < 0.0015, "{learned:?}");
}
