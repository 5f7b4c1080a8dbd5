//! The lessons' questions: what the texts' formulas answer is right, what they warn of is not.
use std::f64::consts::{PI, TAU};

use tracelight_lab::{Check, Lesson};
use tracelight_sim::RigConfig;

/// A right answer to each.
fn right() -> [Vec<f64>; 8] {
    let rig = RigConfig::report();
    let inertia = rig.model.own_inertia_kg_m2().pan;
    let friction = rig.model.friction.pan;
    // 1: the period of a spring with that inertia, and where the spring is as weak as friction
    let kp = inertia * (TAU / 0.4) * (TAU / 0.4);
    let spring = vec![kp, 1e3 * friction.coulomb_pos_nm / kp];
    // 2: the damping ratio of 20 % of overshoot
    let log = 0.2_f64.ln();
    let damping = -log / (PI * PI + log * log).sqrt();
    let damper = 1.0 + friction.viscous_pos;
    let overshoot = vec![(0.5 * damper / damping).powi(2) / inertia];
    // 6: friction half as much again at standstill, less what the spring gives, by the integral
    let level = 1.5 * friction.coulomb_pos_nm;
    let waits = (level - 5.0 * 3e-3) / (40.0 * 3e-3);
    [
        spring,
        overshoot,
        vec![40.0, 5.0],
        vec![40.0, 100.0, 5.0, 1.0],
        vec![26.0],
        vec![waits, level],
        vec![0.104, 0.083, 0.021],
        vec![60.0, 300.0, 5.0, 0.3],
    ]
}

/// Answers that each fail somewhere; all together fail everywhere.
fn wrong(number: usize) -> Vec<Vec<f64>> {
    match number {
        1 => vec![vec![10.0, 4.0], vec![60.0, 2.0], vec![0.0, 1.0]],
        2 => vec![vec![8.0], vec![40.0]],
        3 => vec![vec![20.0, 1.0], vec![20.0, 4.0], vec![0.0, 5.0]],
        4 => vec![vec![40.0, 0.0, 5.0, 1.0], vec![40.0, 300.0, 5.0, 0.0]],
        5 => vec![vec![10.0], vec![50.0], vec![1.0]],
        6 => vec![vec![1.0, 0.04], vec![0.1, 0.2]],
        7 => vec![vec![0.076, 0.04, 0.0009], vec![1.0, 0.0, 0.0]],
        _ => vec![vec![90.0, 300.0, 5.0, 1.0], vec![20.0, 60.0, 3.0, 1.0], vec![0.0; 4]],
    }
}

#[test]
fn what_the_texts_formulas_say_is_right() {
    for (lesson, answer) in Lesson::ALL.iter().zip(right()) {
        let graded = lesson.grade(&answer);
        assert!(graded.is_right(), "{}: {:?}", lesson.title, graded.checks);
        assert!(!graded.checks.is_empty() && graded.experiments.iter().all(|e| e.ticks.len() > 500));
    }
}

#[test]
fn each_figure_can_be_missed_and_then_something_helps() {
    for lesson in &Lesson::ALL {
        let graded: Vec<Vec<Check>> =
            wrong(lesson.number).iter().map(|answer| lesson.grade(answer).checks).collect();
        for (number, check) in graded[0].iter().enumerate() {
            let missed: Vec<&Check> =
                graded.iter().map(|checks| &checks[number]).filter(|c| !c.is_met()).collect();
            assert!(!missed.is_empty(), "{}: {} is always met", lesson.title, check.what);
            assert!(missed.iter().all(|check| check.hint().len() > 20), "{missed:?}");
        }
        assert!(graded.iter().all(|checks| checks.iter().any(|check| !check.is_met())), "{}", lesson.title);
    }
}

#[test]
fn examples_show_something_and_do_not_give_the_answer_away() {
    for (number, lesson) in Lesson::ALL.iter().enumerate() {
        assert_eq!(lesson.number, number + 1);
        for (name, values) in lesson.examples {
            assert_eq!(values.len(), lesson.asks.len(), "{name}");
            let graded = lesson.grade(values);
            assert!(!graded.is_right(), "{}: {name}", lesson.title);
            for (experiment, quantity) in lesson.panels {
                let shown = &graded.experiments[*experiment];
                let values: Vec<f64> =
                    shown.ticks.iter().map(|tick| quantity.of(tick, shown.joint)).collect();
                let least = values.iter().copied().fold(f64::INFINITY, f64::min);
                assert!(values.iter().any(|value| *value > least), "{}: {name}", lesson.title);
            }
        }
    }
}

/// What a student computes is right wherever in a count the joint comes to rest, and a spring that is too weak is not, however lucky.
#[test]
fn jumps_are_graded_by_their_worst_not_by_luck() {
    let rig = RigConfig::report();
    let (inertia, friction) = (rig.model.own_inertia_kg_m2().pan, rig.model.friction.pan.coulomb_pos_nm);
    let torque = rig.model.motors.pan.torque_limit_nm();
    let [pd, pid] = [&Lesson::ALL[2], &Lesson::ALL[3]];
    // half of 30 degrees speeding up, half slowing down: the highest speed, and the distance it takes to stop
    let (faster, slower) = ((torque - friction) / inertia, (torque + friction) / inertia);
    let speed = (2.0 * 30.0_f64.to_radians() / (1.0 / faster + 1.0 / slower)).sqrt();
    let creep_s = speed / (2.0 * slower);
    let count_mm = 914.4 * rig.model.encoder.count_rad();
    let least_kp = 914.4 * friction / (2.5 - count_mm);
    for more in [1.0, 1.05, 1.1, 1.2, 1.3] {
        let kp = more * least_kp;
        let graded = pd.grade(&[kp, 1.03 * creep_s * kp]);
        assert!(graded.is_right(), "kp = {kp}: {:?}", graded.checks);
    }
    assert!(pd.grade(&[38.0, 4.6]).is_right());
    for ki in [80.0, 90.0, 100.0] {
        let graded = pid.grade(&[50.0, ki, 6.5, 1.0]);
        assert!(graded.is_right(), "ki = {ki}: {:?}", graded.checks);
    }
    for kp in [15.0, 18.0, 20.0] {
        assert!(!pd.grade(&[kp, creep_s * kp]).is_right(), "kp = {kp}");
    }
    // without an integral no spring is stiff enough that the damper still bears
    for kp in [40.0, 60.0, 80.0, 100.0] {
        assert!(!pid.grade(&[kp, 0.0, 0.15 * kp, 1.0]).is_right(), "kp = {kp}");
    }
}

/// The eighth lesson's point: with one degree of freedom none of these is stiff and gentle at once.
#[test]
fn one_degree_of_freedom_is_not_enough() {
    let lesson = &Lesson::ALL[7];
    let (mut one, mut two) = (0, 0);
    for kp in [40.0, 60.0, 90.0, 120.0] {
        for ki in [150.0, 300.0, 600.0] {
            for kd in [3.0, 5.0, 7.0, 9.0] {
                one += usize::from(lesson.grade(&[kp, ki, kd, 1.0]).is_right());
                two += usize::from(lesson.grade(&[kp, ki, kd, 0.3]).is_right());
            }
        }
    }
    assert!(one == 0 && two >= 3, "{one} with one, {two} with two");
}

/// The same answer, the same figures; an absurd one is graded like any other.
#[test]
fn grading_is_the_same_every_time_and_bears_anything_within_bounds() {
    for lesson in &Lesson::ALL {
        for pick in [|(least, _): (f64, f64)| least, |(_, most): (f64, f64)| most] {
            let values: Vec<f64> = lesson.asks.iter().map(|ask| pick(ask.bounds)).collect();
            let (one, two) = (lesson.grade(&values), lesson.grade(&values));
            assert!(!one.is_right(), "{}", lesson.title);
            let figures = |checks: &[Check]| checks.iter().map(|c| c.value.to_bits()).collect::<Vec<_>>();
            assert_eq!(figures(&one.checks), figures(&two.checks));
        }
    }
}
