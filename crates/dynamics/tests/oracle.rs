//! The equations of motion against an independent rigid-body library (see `oracle/make_oracle.py`).

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on may panic, and shows figures"
)]

use tracelight_dynamics::HeadBodies;
use tracelight_rig::PanTilt;

/// Largest difference of a mass-matrix entry (kg m²) and of a bias torque (N m).
fn differences(table: &str, bodies: &HeadBodies) -> (f64, f64) {
    let lumped = bodies.lumped();
    let rows = table.lines().filter(|l| !l.starts_with('#')).skip(1);
    let (mut mass_off, mut bias_off, mut count) = (0.0f64, 0.0f64, 0);
    for row in rows {
        let v: Vec<f64> = row.split(',').map(|f| f.parse().unwrap()).collect();
        let (mass, bias) = lumped.mass_and_bias(v[1], PanTilt::new(v[2], v[3]));
        let off = |got: f64, want: f64| (got - want).abs();
        mass_off = mass_off.max(off(mass.m11, v[4])).max(off(mass.m12, v[5])).max(off(mass.m22, v[6]));
        bias_off = bias_off.max(off(bias.pan, v[7])).max(off(bias.tilt, v[8]));
        count += 1;
    }
    assert_eq!(count, 200);
    (mass_off, bias_off)
}

fn check(table: &str, bodies: &HeadBodies) {
    let (mass, bias) = differences(table, bodies);
    assert!(mass <= 1e-9 && bias <= 1e-9, "mass {mass:e}, bias {bias:e}");
}

#[test]
fn set_a_has_the_oracles_mass_matrix_and_bias() {
    check(include_str!("oracle/set_a.csv"), &HeadBodies::set_a());
}

#[test]
fn set_b_has_the_oracles_mass_matrix_and_bias() {
    check(include_str!("oracle/set_b.csv"), &HeadBodies::set_b());
}

#[test]
fn a_wrong_product_of_inertia_is_noticed() {
    let mut bodies = HeadBodies::set_b();
    bodies.tilt_body.inertia.xy = -bodies.tilt_body.inertia.xy;
    assert!(differences(include_str!("oracle/set_b.csv"), &bodies).0 > 1e-5);
}
