//! Amplifiers that give a voltage, with a dead band: H-bridges, as makers' heads have them.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test that shows figures")]

use std::ops::ControlFlow;

use tracelight_rig::{Fault, Joint, PanTilt};
use tracelight_sim::{RigConfig, SimulatedRig, Spread, run, run_segments, score};
use tracelight_trajectory::Plan;

use crate::shapes::{POSE, SPEED_M_S, circle, house, plan_of, plan_of_all, star};
use crate::troubled::three_plans;

fn bridge() -> RigConfig {
    RigConfig::bridge()
}

/// Of heads that differ from what is believed: median rms, largest error of nineteen in twenty, mm; all of them drew the plan.
fn heads(rig: &RigConfig, plan: &Plan, count: u64) -> (f64, f64) {
    let trial = |seed| {
        let head = Spread::USUAL.draw(rig, seed);
        let mut simulated = SimulatedRig::new(&head, POSE, seed);
        let ran = run(&mut simulated, plan, false, |_, _| ControlFlow::Continue(()));
        assert!(ran.is_done(), "seed {seed}: {:?}", ran.fault());
        let tracking = score(plan, &ran, SPEED_M_S);
        (tracking.rms_mm, tracking.max_mm)
    };
    let (mut rms, mut max): (Vec<f64>, Vec<f64>) = (0..count).map(trial).unzip();
    rms.sort_by(f64::total_cmp);
    max.sort_by(f64::total_cmp);
    (rms[rms.len() / 2], max[max.len() * 19 / 20 - 1])
}

/// As exact as one on amplifiers that give a current: see `tracking.rs`.
#[test]
fn sixty_heads_on_bridges_draw_as_those_on_current_amplifiers_do() {
    let plan = plan_of(&bridge(), circle(0.25));
    let (rms, max) = heads(&bridge(), &plan, 60);
    println!("bridges: median {rms:.3} mm rms, 95 % within {max:.3} mm");
    assert!(rms <= 0.045 && max <= 0.3, "{rms} {max} mm");
}

/// A plan asks no more of a bridge than it has: what its motor's own voltage leaves of the supply.
#[test]
fn no_plan_asks_for_more_volts_than_a_bridge_has() {
    let rig = bridge();
    let machine = rig.machine(POSE);
    for plan in [plan_of(&rig, star(0.3)), plan_of_all(&rig, house())] {
        for joint in Joint::BOTH {
            let motor = &rig.model.motors[joint];
            // by the motor's own equation, not as the planner adds it up
            let volts = |p: &tracelight_trajectory::PlanPoint| {
                let angle = p.joints.map(|joint| joint.position_rad);
                let rate = p.joints.map(|joint| joint.velocity_rad_s);
                let push = p.joints.map(|joint| joint.acceleration_rad_s2);
                let own = rig.model.friction[joint].torque(rate[joint]);
                let torque_nm = rig.model.bodies.lumped().inverse(angle.tilt, rate, push)[joint] + own;
                torque_nm / motor.torque_nm_per_v + motor.back_emf_v_s_per_rad * rate[joint]
            };
            let most_v = plan.points.iter().map(volts).fold(0.0, |most: f64, v| most.max(v.abs()));
            println!("{joint}: {most_v:.2} V of {:.2}", motor.most_v());
            assert!(most_v <= 1.001 * machine.torque_share * motor.most_v(), "{joint}: {most_v}");
            // it has some to go on with at full speed
            let speed = machine.speed_limit_rad_s[joint];
            assert!(motor.back_emf_v_s_per_rad * speed < 0.8 * motor.most_v(), "{joint}: {speed} rad/s");
        }
    }
}

/// Dead bands are told by measuring, and no two are alike.
#[test]
fn a_dead_band_that_is_half_as_much_more_or_less_than_believed_is_drawn_through() {
    for (factor, most_rms, most_max) in
        [(0.5, 0.12, 1.3), (0.75, 0.08, 0.75), (1.25, 0.065, 0.4), (1.5, 0.085, 0.6)]
    {
        let mut rig = bridge();
        for joint in Joint::BOTH {
            rig.truth.model.motors[joint].dead_band_v *= factor;
        }
        let plan = plan_of(&rig, circle(0.25));
        let (rms, max) = heads(&rig, &plan, 20);
        println!(
            "dead band {factor} times what is believed: median {rms:.3} mm rms, 95 % within {max:.3} mm"
        );
        assert!(rms <= most_rms && max <= most_max, "{factor}: {rms} {max} mm");
    }
}

/// Whoever takes a bridge for a current amplifier without a dead band draws worse, and in no case wrong light.
#[test]
fn a_bridge_that_is_taken_for_a_current_amplifier_lets_no_light_fall_beside() {
    let mut rig = bridge();
    for joint in Joint::BOTH {
        let motor = &mut rig.model.motors[joint];
        (motor.back_emf_v_s_per_rad, motor.dead_band_v) = (0.0, 0.0);
    }
    for plan in three_plans(&rig) {
        for seed in 0..5 {
            let mut simulated = SimulatedRig::new(&rig, POSE, seed);
            let ran = run(&mut simulated, &plan, false, |_, _| ControlFlow::Continue(()));
            let off = |t: &tracelight_sim::Tick| Some(1e3 * t.spot?.distance(t.asked?));
            let lit = ran.ticks.iter().filter(|tick| tick.light);
            let furthest = lit.filter_map(off).fold(0.0, f64::max);
            println!("seed {seed}: {:?}, light {furthest:.2} mm off at most", ran.fault());
            assert!(furthest <= 3.0, "seed {seed}: {furthest} mm");
        }
    }
}

/// The heat of a motor is that of its current: at full speed a bridge gives its volts against the motor's own, and hardly any current flows.
#[test]
fn a_motor_that_turns_fast_on_a_bridge_is_not_taken_for_hot() {
    let mut rig = bridge();
    // so that heat tells at once
    (rig.control.motor_heating_s, rig.control.motor_continuous) = (0.3, 0.3);
    let ended = |rig: &RigConfig| {
        let turn = |from: f64, to: f64| {
            let at = |pan| PanTilt::new(pan, 0.0);
            rig.machine(POSE).turn(at(from), at(to), (6.0, 4.0))
        };
        let turns = [turn(0.0, 3.0)];
        let mut simulated = SimulatedRig::new(rig, POSE, 1);
        run_segments(&mut simulated, &turns, true, |_, _| ControlFlow::Continue(())).fault()
    };
    assert_eq!(ended(&rig), None);
    // if no voltage of its own were known of it, its volts would be taken for current
    for joint in Joint::BOTH {
        let felt = rig.model.felt_friction(joint);
        rig.model.motors[joint].back_emf_v_s_per_rad = 0.0;
        rig.model.friction[joint] = felt;
    }
    assert_eq!(ended(&rig), Some(Fault::MotorHot));
}
