//! A joint sent from rest to rest: no overshoot, no error that stays, on heads that are not what is believed of them.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on may panic, and shows figures"
)]

use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_sim::{LawName, RigConfig, step_response};

/// The rig whose truth has so much more inertia, gravity and Coulomb friction.
fn rig(inertia: f64, gravity: f64, coulomb: f64) -> RigConfig {
    let mut rig = RigConfig::report();
    let truth = &mut rig.truth.model;
    truth.bodies.rotor_kg_m2 = truth.bodies.rotor_kg_m2.map(|rotor| rotor * inertia);
    truth.bodies.gravity_m_s2 *= gravity;
    for joint in Joint::BOTH {
        truth.friction[joint].coulomb_pos_nm *= coulomb;
        truth.friction[joint].coulomb_neg_nm *= coulomb;
    }
    rig
}

fn corners() -> Vec<(String, RigConfig)> {
    let mut all = vec![("as believed".to_owned(), RigConfig::report())];
    for inertia in [0.95, 1.05] {
        for gravity in [0.95, 1.05] {
            for coulomb in [0.85, 1.15] {
                all.push((format!("J {inertia} g {gravity} Fc {coulomb}"), rig(inertia, gravity, coulomb)));
            }
        }
    }
    all
}

/// Overshoot, %; last moment outside ±2 %, s; mean error of the last 0.2 s, mm at 3 ft.
fn figures(rig: &RigConfig, joint: Joint, to_rad: f64, seed: u64) -> (f64, f64, f64) {
    let response = step_response(rig, joint, to_rad, seed).unwrap();
    let at: Vec<f64> = response.nonlinear.iter().map(|t| t.angle_rad[joint] / to_rad - 1.0).collect();
    let over = at.iter().copied().fold(0.0, f64::max);
    let settled = at.iter().rposition(|e| e.abs() > 0.02).unwrap() + 1;
    let rest = &at[at.len() - 200..];
    let last = rest.iter().map(|e| e.abs()).sum::<f64>() / rest.len() as f64;
    (100.0 * over, settled as f64 * TICK_F64_S, 914.4 * last * to_rad.abs())
}

/// The fastest a joint can be from rest to rest by 30°: all the torque there is, less friction and the least gravity, one way
/// and then the other, s. Friction helps to brake.
fn bang_bang_s(rig: &RigConfig, joint: Joint) -> f64 {
    let truth = &rig.truth.model;
    let lumped = truth.bodies.lumped();
    let inertia = if joint == Joint::Pan { lumped.mass(0.0).m11 } else { lumped.m22 };
    let (torque, coulomb) = (truth.motors[joint].torque_limit_nm(), truth.friction[joint].coulomb_pos_nm);
    // gravity turns tilt down, on average by what it does halfway
    let weight = -lumped.gravity(15_f64.to_radians())[joint];
    let (speeds, brakes) = ((torque - coulomb + weight) / inertia, (torque + coulomb - weight) / inertia);
    (2.0 * 30_f64.to_radians() * (1.0 / speeds + 1.0 / brakes)).sqrt()
}

#[test]
fn steps_do_not_overshoot_and_leave_no_error_on_any_head() {
    let corners = corners();
    for joint in Joint::BOTH {
        for degrees in [1.0, 5.0, 15.0, 30.0, -1.0, -5.0, -15.0, -30.0f64] {
            let (mut over, mut settle, mut last) = (0.0f64, 0.0f64, 0.0f64);
            for (_, rig) in &corners {
                for seed in 0..5 {
                    let (o, s, e) = figures(rig, joint, degrees.to_radians(), seed);
                    (over, settle, last) = (over.max(o), settle.max(s), last.max(e));
                }
            }
            println!("{joint} {degrees}°: overshoot {over:.3} %, settled {settle:.3} s, left {last:.3} mm");
            let most = if degrees.abs() < 2.0 { 1.0 } else { 0.1 };
            assert!(over <= most && last <= 0.16, "{joint} {degrees}°: {over} %, {last} mm");
            let fastest = bang_bang_s(&corners[0].1, joint);
            if degrees == 30.0 {
                println!("  at full torque, and with an encoder that knows all: {fastest:.3} s");
                assert!(settle <= 1.05 * fastest, "{joint}: {settle} s");
            }
        }
    }
}

/// The other laws are there to be compared with, so they must be as bad as they are.
#[test]
fn the_reports_laws_overshoot_as_they_did() {
    for (law, joint, least, most) in [
        (LawName::ReportZpk, Joint::Pan, 45.0, 60.0),
        (LawName::ReportZpk, Joint::Tilt, 50.0, 65.0),
        (LawName::ReportTimeConstants, Joint::Pan, 40.0, 60.0),
        (LawName::ReportTimeConstants, Joint::Tilt, 40.0, 60.0),
    ] {
        let mut rig = RigConfig::report();
        rig.control.law = law;
        let over = figures(&rig, joint, 15_f64.to_radians(), 0).0;
        assert!((least..=most).contains(&over), "{} {joint}: {over} %", law.name());
    }
}

/// K11 and K22 close their linear loops as other tools say: 49.4 and 49.0 % as poles and zeros in continuous time, 12.6 and
/// 10.2 % as time constants; a thousand samples a second add a little.
#[test]
fn the_linear_loops_are_those_of_other_tools() {
    for (law, pan, tilt) in [(LawName::ReportZpk, 49.4, 49.0), (LawName::ReportTimeConstants, 12.6, 10.2)] {
        for (joint, expected) in [(Joint::Pan, pan), (Joint::Tilt, tilt)] {
            let mut rig = RigConfig::report();
            rig.control.law = law;
            let to = 26.565_f64.to_radians();
            let response = step_response(&rig, joint, to, 0).unwrap();
            let peak = response.linear.iter().map(|t| t.angle_rad[joint]).fold(0.0, f64::max);
            let over = 100.0 * (peak / to - 1.0);
            println!("{} {joint}: {over:.2} %, {expected} % in continuous time", law.name());
            assert!((expected..expected + 3.0).contains(&over), "{} {joint}: {over} %", law.name());
        }
    }
}
