//! Gains set by hand are those of the laws, and a push is answered.
use tracelight_rig::{Joint, PanTilt};
use tracelight_sim::{
    Feedforward, HandTuned, LawName, Push, RigConfig, StepReference, StepResponse, push_response,
    step_response,
};

fn driven(by: HandTuned) -> RigConfig {
    let mut rig = RigConfig::report();
    rig.control.law = LawName::HandTuned;
    rig.control.hand_tuned = PanTilt::new(by, by);
    rig
}

fn angles(response: &StepResponse) -> Vec<u64> {
    response.nonlinear.iter().map(|tick| tick.angle_rad.tilt.to_bits()).collect()
}

#[test]
fn gains_by_hand_do_what_the_law_with_these_gains_does() {
    let mut pid = RigConfig::report();
    pid.control.law = LawName::Pid;
    // a sixth of 120 rad/s, three poles there
    let own = |joint: Joint| {
        let (w, j) = (20.0_f32, pid.model.own_inertia_kg_m2()[joint] as f32);
        HandTuned {
            kp: f64::from(3.0 * w * w * j),
            ki: f64::from(w * w * w * j),
            kd: f64::from(3.0 * w * j),
            ..HandTuned::FIRST
        }
    };
    let mut by_hand = driven(HandTuned::FIRST);
    by_hand.control.hand_tuned = PanTilt::from_fn(own);
    let run = |rig| step_response(rig, Joint::Tilt, 0.2, StepReference::Jump, 3).unwrap();
    assert_eq!(angles(&run(&pid)), angles(&run(&by_hand)));
    let wound = HandTuned { anti_windup: false, ..own(Joint::Tilt) };
    let beyond = |rig| run(rig).nonlinear.iter().map(|tick| tick.angle_rad.tilt).fold(0.0, f64::max);
    assert!(beyond(&driven(wound)) > beyond(&by_hand) + 0.05, "an integral that does not wait winds up");
}

#[test]
fn a_move_is_followed_where_a_jump_is_chased() {
    let rig = driven(HandTuned { feedforward: Feedforward::Model, ..HandTuned::FIRST });
    let worst = |reference| {
        let response = step_response(&rig, Joint::Pan, 0.3, reference, 0).unwrap();
        let off = |tick: &tracelight_sim::BenchTick| {
            (f64::from(tick.setpoint.pan.position_rad) - tick.angle_rad.pan).abs()
        };
        response.nonlinear.iter().map(off).fold(0.0, f64::max)
    };
    assert!(worst(StepReference::Jump) > 0.29 && worst(StepReference::Move) < 0.02);
}

#[test]
fn a_push_moves_a_spring_by_what_it_is_stiff() {
    let (kp, torque_nm) = (40.0, 0.3);
    let rig = driven(HandTuned { kp, kd: 4.0, ..HandTuned::FIRST });
    let push = Push { torque_nm, from_s: 0.5, until_s: 2.0 };
    let ticks = push_response(&rig, Joint::Pan, &push, 0);
    let at = |tick: usize| ticks[tick].angle_rad.pan;
    let friction_nm = rig.truth.model.friction.pan.coulomb_pos_nm;
    let gave_way = at(1990) - at(490);
    // friction holds on both sides, and a count hides three quarters of a mrad
    let off = gave_way - torque_nm / kp;
    assert!(off.abs() < friction_nm / kp + 1.6e-3, "{gave_way}");
    assert!((at(2990) - at(490)).abs() < 2.0 * (friction_nm / kp + 8e-4), "it comes back");
    assert_eq!(at(0).to_bits(), at(490).to_bits(), "and nothing moves before");
}
