//! Jerk-limited timing of a path: against the closed form on a line, within all limits on bends.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on may panic, and shows figures"
)]

use std::f64::consts::{PI, TAU};

use oorandom::Rand64;
use tracelight_aim::JointPath;
use tracelight_rig::{Joint, PanTilt};
use tracelight_trajectory::{JointLimits, PathSample, SmoothError, retime_smooth};

const SEED: JointLimits = JointLimits { speed_rad_s: 24.0, acceleration_rad_s2: 100.0, jerk_rad_s3: 2000.0 };

/// From 0 to `way` by pan alone, in steps that grow and shrink.
fn line(cells: usize, way: f64) -> Vec<PathSample> {
    (0..=cells)
        .map(|i| {
            let u = i as f64 / cells as f64;
            let s = way * (u + 0.1 * (2.0 * PI * u).sin() / (2.0 * PI));
            let along = |value| PanTilt::new(value, 0.0);
            let joints = JointPath { angle_rad: along(s), first: along(1.0), second: along(0.0) };
            PathSample { s, joints, cap: f64::INFINITY }
        })
        .collect()
}

#[test]
fn a_line_takes_what_its_formula_says_on_any_grid() {
    const HALF_A_TURN_S: f64 = 0.407_999_589_585_786_7;
    for cells in [100, 250, 500, 1000, 2000, 4000] {
        let motion = retime_smooth(&line(cells, PI), &PanTilt::new(SEED, SEED)).unwrap();
        let off = motion.duration_s() / HALF_A_TURN_S - 1.0;
        println!("{cells} cells: {:+.4} %", 100.0 * off);
        assert!((-1e-7..1e-4).contains(&off), "{cells} cells: {off:e}");
    }
}

/// A sum of waves in both joints, and its first two derivatives by u.
struct Waves(PanTilt<[[f64; 2]; 3]>);

impl Waves {
    fn random(dice: &mut Rand64) -> Self {
        let size = 0.02 + 0.4 * dice.rand_float();
        Self(PanTilt::from_fn(|_| {
            core::array::from_fn(|i| {
                let wave = i as f64 + 1.0;
                [size * (2.0 * dice.rand_float() - 1.0) / wave, TAU * dice.rand_float()]
            })
        }))
    }

    fn at(&self, u: f64) -> JointPath {
        let sum = |of: fn(f64, f64) -> f64| {
            PanTilt::from_fn(|j: Joint| {
                let waves = self.0[j].iter().zip(1..);
                waves.map(|(&[size, phase], n)| size * of(f64::from(n), f64::from(n) * u + phase)).sum()
            })
        };
        JointPath {
            angle_rad: sum(|_, at| at.sin()),
            first: sum(|n, at| n * at.cos()),
            second: sum(|n, at| -n * n * at.sin()),
        }
    }

    fn samples(&self, cells: usize, cap: f64) -> Vec<PathSample> {
        let all = (0..=cells).map(|i| TAU * i as f64 / cells as f64);
        all.map(|s| PathSample { s, joints: self.at(s), cap }).collect()
    }
}

#[test]
fn bends_are_passed_within_all_limits_and_no_slower_than_they_ask() {
    let mut dice = Rand64::new(12);
    let mut worst = [0.0f64; 4];
    for round in 0..40 {
        let waves = Waves::random(&mut dice);
        let limits = PanTilt::from_fn(|_| JointLimits {
            speed_rad_s: 1.0 + 20.0 * dice.rand_float(),
            acceleration_rad_s2: 5.0 + 100.0 * dice.rand_float(),
            jerk_rad_s3: 100.0 + 4000.0 * dice.rand_float(),
        });
        let cap = if round % 3 == 0 { 2.0 } else { f64::INFINITY };
        let motion = retime_smooth(&waves.samples(400, cap), &limits).unwrap();
        let (ticks, duration) = (4000, motion.duration_s());
        let dt = duration / f64::from(ticks);
        let (mut most, mut last) = ([0.0f64; 4], None);
        for i in 0..=ticks {
            let at = motion.at(dt * f64::from(i));
            let path = waves.at(at.position);
            most[3] = most[3].max(at.velocity / cap);
            let accelerations = PanTilt::from_fn(|j: Joint| {
                path.second[j] * at.velocity * at.velocity + path.first[j] * at.acceleration
            });
            for j in Joint::BOTH {
                most[0] = most[0].max((path.first[j] * at.velocity).abs() / limits[j].speed_rad_s);
                most[1] = most[1].max(accelerations[j].abs() / limits[j].acceleration_rad_s2);
                if let Some(before) = last {
                    let before: PanTilt<f64> = before;
                    let jerk = (accelerations[j] - before[j]) / dt;
                    most[2] = most[2].max(jerk.abs() / limits[j].jerk_rad_s3);
                }
            }
            last = Some(accelerations);
        }
        worst = core::array::from_fn(|n| worst[n].max(most[n]));
        assert!(most.iter().any(|share| *share > 0.9), "round {round}: {most:?}");
        let ends = [motion.at(0.0), motion.at(duration)];
        assert!(ends.iter().all(|end| end.velocity == 0.0) && ends[1].position == TAU);
    }
    println!("speed, acceleration, jerk and cap, share of the limit at most: {worst:?}");
    // the path itself is interpolated between its samples
    let [speed, acceleration, jerk, cap] = worst;
    assert!(speed < 1.0001 && acceleration < 1.0001 && cap < 1.0001 && jerk < 1.01, "{worst:?}");
}

#[test]
fn what_is_no_path_is_refused() {
    let limits = PanTilt::new(SEED, SEED);
    let two = &line(1, PI)[..];
    assert!(matches!(retime_smooth(two, &limits), Err(SmoothError::Order { sample: 2, .. })));
    let mut back = line(10, PI);
    back[4].s = back[3].s;
    assert!(matches!(retime_smooth(&back, &limits), Err(SmoothError::Order { sample: 4, .. })));
    let no_jerk = PanTilt::new(SEED, JointLimits { jerk_rad_s3: 0.0, ..SEED });
    let error = retime_smooth(&line(10, PI), &no_jerk).err().unwrap().to_string();
    assert_eq!(error, "the highest jerk is 0; it must be above zero and finite");
    // a path on which nothing moves takes no time worth naming, but ends
    let mut still = line(10, PI);
    still.iter_mut().for_each(|sample| sample.joints.first = PanTilt::default());
    assert!(retime_smooth(&still, &limits).unwrap().duration_s().is_finite());
}
