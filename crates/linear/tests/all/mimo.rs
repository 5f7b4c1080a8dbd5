//! Ninety random systems of several channels against python-control, slycot and scipy (`bench/peers/lab/mimo_goldens.py`).

use serde::Deserialize;
use tracelight_linear::{Complex, Discretization, Matrix, StateSpace, Time};
use tracelight_maths::complex;

type Rows = Vec<Vec<f64>>;

#[derive(Deserialize)]
struct Golden {
    a: Rows,
    b: Rows,
    c: Rows,
    d: Rows,
    dt: f64,
    rad_s: Vec<f64>,
    singular: Rows,
    h_infinity: f64,
    h2: Option<f64>,
    zeros: Vec<[f64; 2]>,
    foh: Option<[Rows; 4]>,
    impulse: Option<[Rows; 4]>,
    disk: Option<f64>,
}

fn matrix(rows: &Rows) -> Matrix {
    Matrix::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j])
}

fn goldens() -> Vec<(usize, Golden, StateSpace)> {
    let text = include_str!("../goldens/mimo.jsonl");
    let all = text.lines().zip(1..).map(|(line, number)| {
        let golden: Golden = serde_json::from_str(line).unwrap();
        let time = if golden.dt > 0.0 { Time::Sampled(golden.dt) } else { Time::Continuous };
        let [a, b, c, d] = [&golden.a, &golden.b, &golden.c, &golden.d].map(matrix);
        let system = StateSpace::new(a, b, c, d, time).unwrap();
        (number, golden, system)
    });
    let all: Vec<_> = all.collect();
    assert_eq!(all.len(), 90);
    all
}

fn close(ours: f64, truth: f64, share: f64, what: &str) {
    assert!((ours - truth).abs() <= share * truth.abs(), "{what}: {ours} is not {truth}");
}

#[test]
fn singular_values_over_frequency_are_true() {
    for (number, golden, system) in goldens() {
        let ours = system.singular_values(&golden.rad_s).unwrap();
        for (ours, truth) in ours.iter().zip(&golden.singular) {
            assert_eq!(ours.len(), truth.len());
            for (a, b) in ours.iter().zip(truth) {
                assert!((a - b).abs() <= 1e-10 * truth[0], "line {number}: {ours:?} is not {truth:?}");
            }
        }
    }
}

#[test]
fn norms_are_true() {
    let mut count = 0;
    for (number, golden, system) in goldens() {
        let peak = system.h_infinity_norm(1e-9).unwrap().unwrap();
        close(peak.gain, golden.h_infinity, 1e-8, &format!("line {number}, H∞"));
        if let Some(truth) = golden.h2 {
            close(system.h2_norm().unwrap().unwrap(), truth, 1e-8, &format!("line {number}, H2"));
            count += 1;
        } else {
            assert_eq!(system.h2_norm(), Ok(None), "line {number}: D is not 0");
        }
    }
    assert!(count > 40, "{count}");
}

#[test]
fn transmission_zeros_are_true() {
    for (number, golden, system) in goldens() {
        let mut left = system.zeros().unwrap();
        assert_eq!(left.len(), golden.zeros.len(), "line {number}: {left:?} is not {:?}", golden.zeros);
        for &[re, im] in &golden.zeros {
            let truth = Complex::new(re, im);
            let apart = |z: &Complex| complex::norm(z - truth);
            let place = (0..left.len()).min_by(|&a, &b| apart(&left[a]).total_cmp(&apart(&left[b]))).unwrap();
            let ours = left.swap_remove(place);
            assert!(
                apart(&ours) <= 1e-6 * (1.0 + complex::norm(truth)),
                "line {number}: {ours} is not {truth}"
            );
        }
    }
}

#[test]
fn first_order_holds_and_sampled_impulses_are_scipys() {
    let mut count = 0;
    for (number, golden, system) in goldens() {
        let holds =
            [(Discretization::FirstOrderHold, &golden.foh), (Discretization::Impulse, &golden.impulse)];
        for (how, truth) in holds {
            let Some(truth) = truth else { continue };
            let ours = system.sampled(0.2, how).unwrap();
            for (ours, truth) in [ours.a(), ours.b(), ours.c(), ours.d()].into_iter().zip(truth) {
                let truth = matrix(truth);
                assert!(
                    (ours - &truth).norm() <= 1e-11 * (1.0 + truth.norm()),
                    "line {number}, {how:?}: {ours} is not {truth}"
                );
            }
            count += 1;
        }
    }
    assert!(count > 60, "{count}");
}

#[test]
fn disk_margins_of_all_channels_are_true() {
    let mut count = 0;
    for (number, golden, system) in goldens() {
        let (Some(truth), [a, b, c, d]) = (golden.disk, [system.a(), system.b(), system.c(), system.d()])
        else {
            continue;
        };
        let open = StateSpace::new(a.clone(), b.clone(), 0.1 * c, 0.1 * d, system.time()).unwrap();
        let margins = open.disk_margins(0.0).unwrap().unwrap();
        close(margins.all.alpha, truth, 1e-8, &format!("line {number}"));
        assert!(
            margins.each.iter().all(|one| one.alpha >= (1.0 - 1e-8) * margins.all.alpha),
            "line {number}: {margins:?}"
        );
        count += 1;
    }
    assert!(count > 10, "{count}");
}

/// Copies of a system beside it are neither seen nor moved more than once: what is minimal has its order.
#[test]
fn what_does_not_show_is_left_out() {
    for (number, _, system) in goldens().into_iter().take(30) {
        let own = system.minimal().unwrap();
        let twice = system.parallel(&system).unwrap().minimal().unwrap();
        assert_eq!(twice.system.order(), own.system.order(), "line {number}");
        assert_eq!(
            twice.uncontrollable.len() + twice.unobservable.len(),
            2 * system.order() - own.system.order()
        );
        let at = Complex::new(0.4, 0.7);
        let (one, both) = (system.at(at).unwrap(), twice.system.at(at).unwrap());
        assert!(
            (&one * Complex::from(2.0) - &both).norm() <= 1e-9 * one.norm(),
            "line {number}: {one} {both}"
        );
    }
}
