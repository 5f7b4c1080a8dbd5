//! A thousand random systems up to order 12 against what is true of them to sixty digits (`bench/peers/lab/goldens.py`).

use serde::Deserialize;
use tracelight_linear::{Complex, Discretization, Matrix, Polynomial, Root, Time, TransferFunction};
use tracelight_maths::complex;

#[derive(Deserialize)]
struct Golden {
    num: Vec<f64>,
    den: Vec<f64>,
    period: f64,
    poles: Vec<[f64; 2]>,
    zeros: Vec<[f64; 2]>,
    tustin: Sampled,
    hold: Sampled,
    matched: Sampled,
    /// Frequency and phase margin, rad.
    phase: Vec<[f64; 2]>,
    /// Frequency and factor.
    gain: Vec<[f64; 2]>,
    modulus: f64,
    step_times: Vec<f64>,
    step: Vec<f64>,
}

#[derive(Deserialize)]
struct Sampled {
    num: Vec<f64>,
    den: Vec<f64>,
}

impl Golden {
    fn system(&self) -> TransferFunction {
        let (above, below) = (Polynomial::new(&self.num[..]), Polynomial::new(&self.den[..]));
        TransferFunction::new(above, below, Time::Continuous).unwrap()
    }
}

fn goldens() -> Vec<(usize, Golden)> {
    let text = include_str!("../goldens/systems.jsonl");
    let all: Vec<Golden> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(all.len(), 1000);
    (1..).zip(all).collect()
}

/// What every figure is held to, relatively, where nothing is said.
const CLOSE: f64 = 1e-8;

fn close(a: f64, b: f64, size: f64) -> bool {
    (a - b).abs() <= CLOSE * size.abs().max(b.abs())
}

#[test]
fn poles_and_zeros_are_true_to_ten_digits_and_within_their_bounds() {
    let check = |line: usize, polynomial: &Polynomial, truth: &[[f64; 2]]| {
        let mut left: Vec<Root> = polynomial.roots();
        assert_eq!(left.len(), truth.len(), "line {line}");
        for &[re, im] in truth {
            let truth = Complex::new(re, im);
            let apart = |root: &Root| complex::norm(root.value - truth);
            let place = (0..left.len()).min_by(|&a, &b| apart(&left[a]).total_cmp(&apart(&left[b]))).unwrap();
            let root = left.swap_remove(place);
            // the goldens have fourteen digits
            let printed = 1e-13 * complex::norm(truth);
            assert!(apart(&root) <= root.radius + printed, "line {line}: {root:?} is not {truth}");
            assert!(apart(&root) <= 1e-10 * complex::norm(truth), "line {line}: {root:?} is not {truth}");
            assert!(root.radius <= CLOSE * complex::norm(truth), "line {line}: {root:?}");
        }
    };
    for (line, golden) in goldens() {
        let system = golden.system();
        check(line, system.denominator(), &golden.poles);
        check(line, system.numerator(), &golden.zeros);
    }
}

#[test]
fn samples_by_tustins_rule_by_a_hold_and_matched_have_true_coefficients() {
    let check = |line: usize, what: &str, ours: &Polynomial, truth: &[f64]| {
        let size = truth.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
        for (power, truth) in truth.iter().rev().enumerate() {
            let ours = ours.coefficient(power);
            assert!(
                close(ours, *truth, size),
                "line {line}: {what}, power {power}: {ours:e} is not {truth:e} of {size:e}"
            );
        }
    };
    for (line, golden) in goldens() {
        let sampled = |how| golden.system().sampled(golden.period, how).unwrap();
        for (how, truth) in [
            (Discretization::Tustin(None), &golden.tustin),
            (Discretization::ZeroOrderHold, &golden.hold),
            (Discretization::Matched, &golden.matched),
        ] {
            let ours = sampled(how);
            check(line, &format!("{how:?}, above"), ours.numerator(), &truth.num);
            check(line, &format!("{how:?}, below"), ours.denominator(), &truth.den);
        }
    }
}

#[test]
fn every_margin_is_found_and_true() {
    for (line, golden) in goldens() {
        let ours = golden.system().margins();
        let phase: Vec<[f64; 2]> = ours.phase.iter().map(|m| [m.rad_s, m.phase_rad]).collect();
        let gain: Vec<[f64; 2]> = ours.gain.iter().map(|m| [m.rad_s, m.factor]).collect();
        for (what, ours, truth) in [("phase", phase, &golden.phase), ("gain", gain, &golden.gain)] {
            assert_eq!(ours.len(), truth.len(), "line {line}: {what} {ours:?} {truth:?}");
            for (ours, truth) in ours.iter().zip(truth) {
                let size = if what == "phase" { 1.0 } else { truth[1] };
                let same = close(ours[0], truth[0], truth[0]) && close(ours[1], truth[1], size);
                assert!(same, "line {line}: {what} {ours:?} is not {truth:?}");
            }
        }
        let modulus = ours.modulus.unwrap().distance;
        assert!(close(modulus, golden.modulus, 1e-2), "line {line}: {modulus} is not {}", golden.modulus);
    }
}

/// Of poles four decades apart, watched until the slow ones are over, an exponential leaves fewer digits of these: one of a thousand.
#[test]
fn steps_are_answered_truly() {
    let mut worse = Vec::new();
    for (line, golden) in goldens() {
        let response = golden.system().step_response(golden.step_times[0], golden.step.len() + 1).unwrap();
        let size = golden.step.iter().fold(0.0_f64, |most, y| most.max(y.abs()));
        let off =
            response.values[1..].iter().zip(&golden.step).map(|(ours, truth)| (ours - truth).abs() / size);
        let off = off.fold(0.0, f64::max);
        assert!(off <= 1e-6, "line {line}: {off:e}");
        if off > CLOSE {
            worse.push((line, off));
        }
    }
    assert!(worse.len() <= 1, "{worse:?}");
}

/// Coefficients of the polynomial with the closed loop's poles, highest power first.
#[derive(Deserialize)]
struct Regulated {
    continuous: Vec<f64>,
    /// Of samples, in z − 1: a thousandth apart they would be one in z.
    sampled: Vec<f64>,
}

/// Regulators whose output costs what their input does, in continuous time and of samples. Truth is a spectral factor
/// (`bench/peers/lab/lqr_goldens.py`): no equation of Riccati is solved for it. Ten of two thousand, of order 7 to 12 with poles decades apart,
/// have fewer digits; LAPACK's solver has as few of those in continuous time.
#[test]
fn regulators_have_true_poles() {
    let text = include_str!("../goldens/lqr.jsonl");
    let all: Vec<Regulated> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(all.len(), 1000);
    let one = Matrix::identity(1, 1);
    let mut worse = Vec::new();
    for ((line, golden), truth) in goldens().into_iter().zip(all) {
        let plant = golden.system().state_space().unwrap();
        let sampled = plant.sampled(golden.period, Discretization::ZeroOrderHold).unwrap();
        for (plant, truth, edge) in [(&plant, &truth.continuous, 0.0), (&sampled, &truth.sampled, 1.0)] {
            let poles = plant.lqr_of_outputs(&one, &one).unwrap().poles;
            let poles: Vec<Complex> = poles.into_iter().map(|pole| pole - edge).collect();
            let ours = Polynomial::from_roots(1.0, &poles);
            // in the unit of the poles' mean size coefficients are alike
            let n = poles.len();
            let mean = truth[n].abs().powf(1.0 / n as f64);
            let unit = |power: usize| mean.powi((n - power) as i32);
            let size = (0..=n).map(|k| truth[n - k].abs() / unit(k)).fold(0.0, f64::max);
            let off =
                (0..=n).map(|k| (ours.coefficient(k) - truth[n - k]).abs() / unit(k)).fold(0.0, f64::max);
            let off = off / size;
            assert!(off <= 1e-5, "line {line}: {off:e}");
            if off > CLOSE {
                worse.push((line, edge, n, off));
            }
        }
    }
    assert!(worse.len() <= 10, "{worse:?}");
}
