//! A joint sent from rest to rest: no overshoot, no error that stays, on heads that are not what is believed of them.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on may panic, and shows figures"
)]

use tracelight_lab::StepFigures;
use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_sim::{BenchTick, LawName, RigConfig, step_response};

/// On a target 3 ft away.
const MM_PER_RAD: f64 = 914.4;

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

fn figures(response: &[BenchTick], joint: Joint, to_rad: f64) -> StepFigures {
    let angles: Vec<f64> = response.iter().map(|tick| tick.angle_rad[joint]).collect();
    StepFigures::of(&angles, to_rad, TICK_F64_S)
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
                    let to_rad = degrees.to_radians();
                    let response =
                        step_response(rig, joint, to_rad, rig.control.law.reference(), seed).unwrap();
                    let step = figures(&response.nonlinear, joint, to_rad);
                    over = over.max(step.overshoot_percent);
                    settle = settle.max(step.settle_s.unwrap());
                    last = last.max(MM_PER_RAD * step.final_error);
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
        let to_rad = 15_f64.to_radians();
        let response = step_response(&rig, joint, to_rad, rig.control.law.reference(), 0).unwrap();
        let over = figures(&response.nonlinear, joint, to_rad).overshoot_percent;
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
            let response = step_response(&rig, joint, to, rig.control.law.reference(), 0).unwrap();
            let over = figures(&response.linear, joint, to).overshoot_percent;
            println!("{} {joint}: {over:.2} %, {expected} % in continuous time", law.name());
            assert!((expected..expected + 3.0).contains(&over), "{} {joint}: {over} %", law.name());
        }
    }
}
