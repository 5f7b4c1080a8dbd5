//! The report's friction experiment on the report's rig: what its protocol returns, and what the whole curves tell.

use std::ops::ControlFlow;

use tracelight_dynamics::Friction;
use tracelight_lab::{
    Believed, Curves, FrictionError, Protocol, Shuttle, Travel, Trial, curves, free_trial, steady,
};
use tracelight_rig::{Joint, PanTilt};
use tracelight_sim::{Mounting, RigConfig, head_alone};

fn believed(rig: &RigConfig, joint: Joint, mounting: Mounting) -> Believed {
    let lumped = rig.model.bodies.lumped();
    let falls = joint == Joint::Tilt && mounting == Mounting::Standing;
    Believed {
        torque_nm_per_v: rig.model.motors[joint].torque_nm_per_v,
        dead_band_v: rig.model.motors[joint].dead_band_v,
        count_rad: rig.model.encoder.count_rad(),
        step_rad: rig.model.encoder.count_rad(),
        inertia_kg_m2: rig.model.own_inertia_kg_m2()[joint],
        another: false,
        gravity_nm: falls.then_some([lumped.gravity_c, lumped.gravity_s]),
        cables: mounting == Mounting::Standing,
    }
}

/// The report's: −1…1 V in 0.05 V steps, a pulse of 1 V for 1 s before each.
fn protocol(hold_s: f64) -> Protocol {
    Protocol { volts: (-20..=20).map(|k| 0.05 * f64::from(k)).collect(), hold_s, pulse_v: 1.0, pulse_s: 1.0 }
}

/// As the report ran it: each voltage from rest, nothing in the way.
fn in_a_fixture(rig: &RigConfig, joint: Joint, hold_s: f64) -> Vec<Trial> {
    let protocol = protocol(hold_s);
    let trial = |&volts: &f64| {
        let mut head = head_alone(rig, joint, Mounting::Fixture, 0);
        free_trial(&mut head, joint, &protocol, volts)
    };
    protocol.volts.iter().map(trial).collect()
}

fn check(found: &Curves, friction: &Friction, viscous_share: f64, coulomb_share: f64) {
    let [pos, neg] = [found.pos, found.neg].map(Option::unwrap);
    for (found, true_value, share) in [
        (pos.viscous, friction.viscous_pos, viscous_share),
        (neg.viscous, friction.viscous_neg, viscous_share),
        (pos.coulomb_nm, friction.coulomb_pos_nm, coulomb_share),
        (neg.coulomb_nm, friction.coulomb_neg_nm, coulomb_share),
    ] {
        let off = (found.value / true_value - 1.0).abs();
        assert!(off < share, "{found:?} {true_value}");
    }
}

#[test]
fn thirty_seconds_are_not_steady_and_the_whole_curves_do_not_mind() {
    let rig = RigConfig::report();
    // FACTS: the time constant is 84 s on pan, 39 and 44 on tilt: a line is too steep by 1/(1 − e^(−30/τ))
    for (joint, too_steep) in [(Joint::Pan, [3.2, 3.5]), (Joint::Tilt, [1.85, 2.1])] {
        let trials = in_a_fixture(&rig, joint, 30.0);
        let trials: Vec<&Trial> = trials.iter().collect();
        let believed = believed(&rig, joint, Mounting::Fixture);
        let friction = &rig.truth.model.friction[joint];
        let literal = steady(&trials, |volts| believed.torque_nm(volts), believed.count_rad);
        let [pos, neg] = [literal.pos, literal.neg].map(Option::unwrap);
        for (line, viscous) in [(pos, friction.viscous_pos), (neg, friction.viscous_neg)] {
            let ratio = line.viscous.value / viscous;
            assert!((too_steep[0]..too_steep[1]).contains(&ratio), "{joint}: {ratio}");
            assert!(line.r2 > 0.999, "and it looks like a line: {line:?}");
        }
        let found = curves(joint, &trials, &believed).unwrap();
        check(&found, friction, 0.01, 0.001);
    }
}

#[test]
fn held_for_three_time_constants_the_speeds_are_steady() {
    let rig = RigConfig::report();
    let mut long = protocol(300.0);
    long.volts.retain(|volts| *volts > 0.65);
    let trial = |&volts: &f64| {
        let mut head = head_alone(&rig, Joint::Pan, Mounting::Fixture, 0);
        free_trial(&mut head, Joint::Pan, &long, volts)
    };
    let trials: Vec<Trial> = long.volts.iter().map(trial).collect();
    let trials: Vec<&Trial> = trials.iter().collect();
    let believed = believed(&rig, Joint::Pan, Mounting::Fixture);
    let literal = steady(&trials, |volts| believed.torque_nm(volts), believed.count_rad);
    let viscous = literal.pos.unwrap().viscous.value;
    assert!((viscous / 0.0009 - 1.0).abs() < 0.05, "{viscous}");
}

#[test]
fn a_head_with_stops_tells_the_same_within_its_range() {
    let rig = RigConfig::report();
    for joint in Joint::BOTH {
        let believed = believed(&rig, joint, Mounting::Standing);
        let (lower_rad, upper_rad) = rig.model.geometry.range_rad[joint];
        let protocol = protocol(30.0);
        let travel = Travel { lower_rad, upper_rad };
        let shuttle = Shuttle { protocol: &protocol, travel, believed: &believed, limit_v: 10.0 };
        let mut head = head_alone(&rig, joint, Mounting::Standing, 0);
        let trials = shuttle.trials(&mut head, joint, |_| ControlFlow::Continue(()));
        let counts = trials.iter().flat_map(|t| t.samples.iter().map(|s| s.count));
        let reach = counts.fold(0.0, |most, c| f64::max(most, c.abs())) * believed.count_rad;
        assert!(reach < upper_rad && reach > 0.7 * upper_rad, "{joint}: {reach}");
        let trials: Vec<&Trial> = trials.iter().collect();
        let found = curves(joint, &trials, &believed).unwrap();
        check(&found, &rig.truth.model.friction[joint], 0.05, 0.01);
    }
}

#[test]
fn against_gravity_a_volt_does_not_turn_tilt() {
    let rig = RigConfig::report();
    let protocol = protocol(30.0);
    let mut head = head_alone(&rig, Joint::Tilt, Mounting::Standing, 0);
    let trial = free_trial(&mut head, Joint::Tilt, &protocol, 1.0);
    // it falls, swings and hangs; in the last second nothing moves
    let points = steady(&[&trial], |volts| 0.0774 * volts, rig.model.encoder.count_rad()).points;
    assert!(points.iter().all(|p| p.rate_rad_s.abs() < 1e-3), "{points:?}");
    let believed = believed(&rig, Joint::Tilt, Mounting::Standing);
    let resting = in_a_fixture(&rig, Joint::Tilt, 1.0);
    let weak: Vec<&Trial> = resting.iter().filter(|t| t.samples.last().unwrap().volts.abs() < 0.1).collect();
    assert!(matches!(curves(Joint::Tilt, &weak[..1], &believed), Err(FrictionError::TooFew { .. })));
}

/// Speeds that do not change say nothing of inertia, and all of friction.
#[test]
fn steady_logs_are_enough() {
    let truth =
        Friction { viscous_pos: 0.002, viscous_neg: 0.001, coulomb_pos_nm: 0.05, coulomb_neg_nm: -0.03 };
    let believed = Believed {
        torque_nm_per_v: 0.08,
        dead_band_v: 0.0,
        count_rad: 1.534e-3,
        step_rad: 1.534e-3,
        inertia_kg_m2: 0.076,
        another: false,
        gravity_nm: None,
        cables: false,
    };
    let trial = |rate: f64| {
        let volts = truth.torque(rate) / believed.torque_nm_per_v;
        let samples = (0..500).map(|k| {
            let time_s = 0.02 * f64::from(k);
            tracelight_lab::Sample { time_s, volts, count: (rate * time_s / believed.count_rad).round() }
        });
        Trial { joint: Joint::Pan, samples: samples.collect() }
    };
    let trials: Vec<Trial> = [1.0, 3.0, 8.0, -2.0, -5.0, -9.0].map(trial).into();
    let trials: Vec<&Trial> = trials.iter().collect();
    check(&curves(Joint::Pan, &trials, &believed).unwrap(), &truth, 1e-3, 1e-3);
    let literal = steady(&trials, |volts| believed.torque_nm(volts), believed.count_rad);
    assert!((literal.neg.unwrap().viscous.value / 0.001 - 1.0).abs() < 1e-3);
    let unlike = PanTilt::new(literal.pos, literal.neg);
    assert!(unlike.pan != unlike.tilt);
}

/// What hangs on a worn head is not taken for inertia or friction.
#[test]
fn cables_are_told_from_friction() {
    let mut rig = RigConfig::report();
    rig.truth.wear.cable_nm_per_rad = 0.02;
    for joint in Joint::BOTH {
        let believed = believed(&rig, joint, Mounting::Standing);
        let (lower_rad, upper_rad) = rig.model.geometry.range_rad[joint];
        let protocol = Protocol { volts: (-6..=6).map(|k| 0.25 * f64::from(k)).collect(), ..protocol(30.0) };
        let shuttle = Shuttle {
            protocol: &protocol,
            travel: Travel { lower_rad, upper_rad },
            believed: &believed,
            limit_v: 10.0,
        };
        let mut head = head_alone(&rig, joint, Mounting::Standing, 3);
        let trials = shuttle.trials(&mut head, joint, |_| ControlFlow::Continue(()));
        let found = curves(joint, &trials.iter().collect::<Vec<_>>(), &believed).unwrap();
        assert!((found.spring_nm_per_rad.unwrap().value / 0.02 - 1.0).abs() < 0.02, "{joint}");
        let inertia = rig.model.own_inertia_kg_m2()[joint];
        assert!((found.inertia_kg_m2.unwrap().value / inertia - 1.0).abs() < 0.005, "{joint}");
        // a cable that pulls at zero moves both levels by as much
        let [pos, neg] = [found.pos, found.neg].map(|side| side.unwrap().coulomb_nm.value);
        let friction = &rig.truth.model.friction[joint];
        let width = friction.coulomb_pos_nm - friction.coulomb_neg_nm;
        assert!(((pos - neg) / width - 1.0).abs() < 0.01, "{joint}: {pos} {neg}");
    }
}

/// What is said to hold in 95 of 100 cases does in nine of ten at least, be there many trials or few.
#[test]
fn intervals_have_the_truth_in_them() {
    let rig = RigConfig::report();
    let (mut hits, mut all) = (0, 0);
    for joint in Joint::BOTH {
        let believed = believed(&rig, joint, Mounting::Fixture);
        let friction = &rig.truth.model.friction[joint];
        for (step_v, hold_s) in (0..24).map(|k| (0.02 + 0.005 * f64::from(k % 12), 5.0 + 0.7 * f64::from(k)))
        {
            let volts = (0..=(1.0 / step_v) as i32)
                .flat_map(|k| [1.0, -1.0].map(|way| way * (1.0 - step_v * f64::from(k))));
            // those that turn it, and some that do not
            let volts: Vec<f64> = volts.filter(|v| v.abs() > 0.5).collect();
            let protocol = Protocol { volts, ..protocol(hold_s) };
            let trial = |&volts: &f64| {
                let mut head = head_alone(&rig, joint, Mounting::Fixture, (10.0 * hold_s) as u64);
                free_trial(&mut head, joint, &protocol, volts)
            };
            let trials: Vec<Trial> = protocol.volts.iter().map(trial).collect();
            let found = curves(joint, &trials.iter().collect::<Vec<_>>(), &believed).unwrap();
            let [pos, neg] = [found.pos, found.neg].map(Option::unwrap);
            for (value, truth) in [
                (pos.viscous, friction.viscous_pos),
                (neg.viscous, friction.viscous_neg),
                (pos.coulomb_nm, friction.coulomb_pos_nm),
                (neg.coulomb_nm, friction.coulomb_neg_nm),
                (found.inertia_kg_m2.unwrap(), rig.model.own_inertia_kg_m2()[joint]),
            ] {
                all += 1;
                hits += u32::from((value.value - truth).abs() <= value.within);
            }
        }
    }
    assert!(f64::from(hits) > 0.9 * f64::from(all), "{hits} of {all}");
}

#[test]
fn what_no_joint_can_be_is_refused() {
    let rig = RigConfig::report();
    let mut trials = in_a_fixture(&rig, Joint::Pan, 10.0);
    let believed = believed(&rig, Joint::Pan, Mounting::Fixture);
    for sample in trials.iter_mut().flat_map(|trial| &mut trial.samples) {
        sample.count = -sample.count;
    }
    let turned: Vec<&Trial> = trials.iter().collect();
    assert!(matches!(curves(Joint::Pan, &turned, &believed), Err(FrictionError::Impossible { .. })));
    for sample in trials.iter_mut().flat_map(|trial| &mut trial.samples) {
        sample.volts = 0.0;
    }
    let idle: Vec<&Trial> = trials.iter().collect();
    assert!(matches!(curves(Joint::Pan, &idle, &believed), Err(FrictionError::Alike { .. })));
}

#[test]
fn times_that_hardly_differ_and_holds_of_two_samples_are_borne() {
    let sample = |time_s: f64, count: f64| tracelight_lab::Sample { time_s, volts: 1.0, count };
    let odd = [
        Trial { joint: Joint::Pan, samples: vec![sample(0.0, 0.0), sample(1e-300, 5.0)] },
        Trial { joint: Joint::Pan, samples: vec![sample(0.0, 0.0), sample(1.0, 700.0)] },
    ];
    let odd: Vec<&Trial> = odd.iter().collect();
    assert_eq!(odd[0].speeds(1.5e-3, 0.1).len(), 2);
    let found = steady(&odd, |volts| 0.08 * volts, 1.5e-3);
    assert!((found.points.last().unwrap().rate_rad_s - 1.05).abs() < 1e-9, "{found:?}");
    let believed = believed(&RigConfig::report(), Joint::Pan, Mounting::Fixture);
    assert!(curves(Joint::Pan, &odd, &believed).is_err());
}
