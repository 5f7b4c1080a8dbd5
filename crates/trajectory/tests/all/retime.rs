//! The speed along a path: as fast as the motors allow, never faster, whatever the grid.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on may panic, and shows figures"
)]

use std::f64::consts::PI;

use tracelight_trajectory::retime;

use crate::support::{self, Curve, bare_rig, worst_excess};

const LISSAJOUS: Curve =
    Curve { point: |u| (0.30 * (3.0 * u + 0.3).sin(), 0.20 * (2.0 * u).sin()), turns: 1.0 };
const ROSE: Curve = Curve {
    point: |u| {
        let r = 0.2 * (1.0 + 0.35 * (5.0 * u).cos());
        (r * u.cos(), r * u.sin())
    },
    turns: 1.0,
};
const CIRCLE: Curve = Curve { point: |u| (0.05 * u.cos(), 0.05 * u.sin()), turns: 1.0 };
const LOOPS: Curve = Curve { point: |u| (-0.25 + 0.004 * u + 0.006 * u.cos(), 0.01 * u.sin()), turns: 20.0 };

#[test]
fn a_straight_joint_move_takes_what_the_closed_form_says() {
    // 0 → π of tilt alone at full torque against Coulomb friction: bang, then bang
    let (machine, torque) = (bare_rig(0.05, 0.0), 0.0774 * 10.0);
    let (up, down) = ((torque - 0.05) / 0.075, (torque + 0.05) / 0.075);
    let exact = (2.0 * PI * (1.0 / up + 1.0 / down)).sqrt();
    for count in [100, 333, 1000] {
        let took = retime(&machine, &support::tilt_line(count, PI)).unwrap().duration_s();
        println!("{count}: {took} of {exact}");
        assert!((took / exact - 1.0).abs() < 1e-4, "{count}: {took} of {exact}");
    }
}

#[test]
fn a_thousand_places_are_as_good_as_a_hundred_thousand() {
    for (name, curve) in [("lissajous", LISSAJOUS), ("rose", ROSE), ("circle", CIRCLE), ("loops", LOOPS)] {
        for (coulomb, viscous) in [(0.05, 0.0), (0.05, 0.0015), (0.05, 0.03)] {
            let machine = bare_rig(coulomb, viscous);
            let took = |count| retime(&machine, &curve.samples(count, f64::INFINITY)).unwrap().duration_s();
            let (coarse, fine) = (took(1000), took(100_000));
            println!(
                "{name} {coulomb} {viscous}: {coarse:.5} of {fine:.5} s, {:+.4} %",
                100.0 * (coarse / fine - 1.0)
            );
            assert!((coarse / fine - 1.0).abs() < 5e-4, "{name}: {coarse} of {fine}");
        }
    }
}

#[test]
fn limits_hold_between_the_places_too_but_for_turning_joints() {
    // where a joint turns round, what it allows changes without bound from place to place; a planner that samples
    // the motion sees these few percent and slows down there. Of 1000 places the rose turns round at one exactly: the last
    // digit says which way
    for (name, curve, bounds) in [
        ("lissajous", LISSAJOUS, [0.02, 0.02]),
        ("rose", ROSE, [0.07, 0.02]),
        ("circle", CIRCLE, [0.01, 0.01]),
        ("loops", LOOPS, [0.06, 0.06]),
    ] {
        for (places, bound) in [1000, 1001].into_iter().zip(bounds) {
            for cap in [f64::INFINITY, 2.0] {
                let machine = bare_rig(0.05, 0.0015);
                let motion = retime(&machine, &curve.samples(places, cap)).unwrap();
                let excess = worst_excess(&machine, &motion, &curve, 20);
                println!("{name} {places} {cap}: {excess:+.5} of the torque");
                assert!(excess < bound, "{name} {places}: {excess}");
            }
        }
    }
}

#[test]
fn somewhere_a_limit_is_always_reached() {
    // the fastest motion is bang-bang: at every moment one motor gives all it has
    let machine = bare_rig(0.05, 0.0015);
    let motion = retime(&machine, &ROSE.samples(1000, f64::INFINITY)).unwrap();
    let idle =
        motion.samples().iter().zip(motion.speeds()).zip(motion.accelerations()).filter(|((at, v), u)| {
            let use_of = |u: f64| support::torque_share(&machine, &at.joints, **v, u);
            use_of(u[0]).pan.max(use_of(u[0]).tilt) < 0.97
        });
    let idle = idle.count();
    assert!(idle < 20, "{idle} places of 1000 where no motor gives all it has");
}

#[test]
fn the_set_speed_is_kept_where_the_motors_allow_it() {
    let machine = bare_rig(0.05, 0.0015);
    let motion = retime(&machine, &LISSAJOUS.samples(2000, 0.4)).unwrap();
    let speeds = motion.speeds();
    assert!(speeds.iter().all(|&v| v <= 0.4 * (1.0 + 1e-12)));
    let at_speed = speeds.iter().filter(|&&v| v > 0.4 * (1.0 - 1e-9)).count();
    assert!(at_speed > speeds.len() * 9 / 10, "{at_speed} of {}", speeds.len());
    let changes = motion.accelerations().windows(2).filter(|w| w[0][1] * w[1][0] < -1e-6).count();
    assert!(changes < 20, "the acceleration flickers {changes} times");
}
