//! Random paths, motors and speeds: the timing always ends, at rest, within the limits at every place.
//!
//! The long one, a hundred times as many, minutes: `cargo test --release -p tracelight-trajectory --test all any_path --
//! --ignored`.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on may panic, and shows figures"
)]

use std::f64::consts::TAU;

use oorandom::Rand64;
use tracelight_dynamics::{Friction, HeadBodies};
use tracelight_rig::{Joint, PanTilt};
use tracelight_stroke::{Point, Vec2};
use tracelight_trajectory::{Machine, PathSample, Retimed, retime};

use crate::support::{self, bare_rig, joint_motion, torque_share};

/// A sum of waves in x and y.
struct Waves([[f64; 3]; 8]);

impl Waves {
    fn random(dice: &mut Rand64) -> Self {
        let size = 0.25 * dice.rand_float();
        Self(std::array::from_fn(|i| {
            let wave = f64::from(i as u32 / 2 + 1);
            [wave, size * (2.0 * dice.rand_float() - 1.0) / wave, TAU * dice.rand_float()]
        }))
    }

    /// Place and its first two derivatives.
    fn at(&self, u: f64) -> [Vec2; 3] {
        let mut sum = [Vec2::ZERO; 3];
        for (i, &[wave, size, phase]) in self.0.iter().enumerate() {
            let (s, c) = (wave * u + phase).sin_cos();
            for (to, value) in sum.iter_mut().zip([s, wave * c, -wave * wave * s]) {
                if i % 2 == 0 { to.x += size * value } else { to.y += size * value }
            }
        }
        sum
    }
}

fn machine(dice: &mut Rand64) -> Machine {
    let mut draw = |low: f64, high: f64| low + (high - low) * dice.rand_float();
    let mut machine = bare_rig(0.0, 0.0);
    if draw(0.0, 1.0) < 0.7 {
        machine.lumped = HeadBodies::set_a().lumped();
    }
    machine.friction = PanTilt::from_fn(|_| Friction {
        viscous_pos: draw(0.0, 0.02),
        viscous_neg: draw(0.0, 0.02),
        coulomb_pos_nm: draw(0.0, 0.08),
        coulomb_neg_nm: draw(-0.08, 0.0),
    });
    machine.torque_share = draw(0.6, 1.0);
    let speed = draw(0.2, 20.0);
    machine.speed_limit_rad_s = PanTilt::new(speed, 1.5 * speed);
    if draw(0.0, 1.0) < 0.3 {
        let wish = draw(1.0, 20.0);
        machine.acceleration_limit_rad_s2 = PanTilt::new(wish, 0.8 * wish);
    }
    machine
}

/// The largest share by which a limit is exceeded at a place, from either side.
fn excess(machine: &Machine, motion: &Retimed) -> f64 {
    let mut worst = f64::NEG_INFINITY;
    let places = motion.samples().iter().zip(motion.speeds());
    for (i, u) in motion.accelerations().iter().enumerate() {
        for ((at, &v), u) in places.clone().skip(i).take(2).zip(u) {
            // friction is there in the moment of coming to rest too
            let share = torque_share(machine, &at.joints, v.max(1e-12), *u);
            let (rate, acceleration) = joint_motion(&at.joints, v, *u);
            for j in Joint::BOTH {
                // where a joint turns round its friction is anything between both ways'
                let is_turning = at.joints.first[j].abs() < 1e-6;
                let torque = if is_turning { 0.0 } else { share[j] / machine.torque_share - 1.0 };
                worst = worst
                    .max(torque)
                    .max(rate[j].abs() / machine.speed_limit_rad_s[j] - 1.0)
                    .max(acceleration[j].abs() / machine.acceleration_limit_rad_s2[j] - 1.0)
                    .max(v / at.cap - 1.0);
            }
        }
    }
    worst
}

fn check(paths: u64, seed: u128) {
    let mut dice = Rand64::new(seed);
    let (mut worst, mut slower) = (0.0_f64, 0.0_f64);
    for number in 0..paths {
        let (machine, waves) = (machine(&mut dice), Waves::random(&mut dice));
        let cap = if number % 3 == 0 { f64::INFINITY } else { 0.05 + 5.0 * dice.rand_float() };
        let count = 40 + dice.rand_range(0..400) as usize;
        let turns = 0.2 + 0.8 * dice.rand_float();
        let samples = |count: usize| -> Vec<PathSample> {
            let place = |i: usize| {
                let s = TAU * turns * i as f64 / count as f64;
                let [p, first, second] = waves.at(s);
                PathSample { s, joints: support::aim(&machine, Point::ORIGIN + p, first, second), cap }
            };
            (0..=count).map(place).collect()
        };
        let motion = retime(&machine, &samples(count)).unwrap();
        let took = motion.duration_s();
        assert!(took.is_finite() && took > 0.0, "path {number}: {took} s");
        assert_eq!((motion.speeds()[0], *motion.speeds().last().unwrap()), (0.0, 0.0));
        assert!(motion.speeds().iter().all(|v| v.is_finite() && *v >= 0.0), "path {number}");
        let excess = excess(&machine, &motion);
        assert!(excess < 1e-6, "path {number}: {excess} over a limit at a place");
        worst = worst.max(excess);
        let fine = retime(&machine, &samples(8 * count)).unwrap().duration_s();
        slower = slower.max(took / fine - 1.0);
    }
    println!(
        "{paths} paths: {worst:e} over a limit at most, {:.2} % slower than at eight times the places",
        100.0 * slower
    );
}

#[test]
fn a_thousand_paths_keep_to_their_limits() {
    check(1000, 20);
}

#[test]
#[ignore = "minutes; the command is in the first lines"]
fn a_hundred_thousand_paths_keep_to_their_limits() {
    check(100_000, 21);
}
