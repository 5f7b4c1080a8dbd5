//! Figures of responses against closed forms, and endings that are none.

use std::f64::consts::{E, PI};

use tracelight_linear::{Ending, Input, Polynomial, StepInfo, Time, TransferFunction};

fn parse(text: &str) -> TransferFunction {
    TransferFunction::parse(text, Time::Continuous).unwrap()
}

fn info(text: &str) -> StepInfo {
    parse(text).step_info(0.02).unwrap()
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-9 * expected.abs().max(1e-3), "{found:e}, not {expected:e}");
}

#[test]
fn a_first_order_rises_and_settles_as_its_logarithms_say() {
    for rate in [1e-6_f64, 1.0, 3e5] {
        let first = info(&format!("{rate}/(s+{rate})"));
        near(first.rise_s.unwrap(), 9_f64.ln() / rate);
        near(first.settle_s.unwrap(), 50_f64.ln() / rate);
        assert_eq!(first.ending, Ending::Converges(1.0));
        // it is approached from below, and nowhere reached
        assert_eq!((first.overshoot_percent, first.peak.unwrap().time_s), (Some(0.0), None));
    }
}

#[test]
fn a_fast_ring_beside_a_slow_tail_is_seen_whole() {
    // 3000 rad/s beside 1 s: partial fractions in fifty digits
    let both = info("0.9*9000000/(s^2+600s+9000000)+0.1/(s+1)");
    near(both.peak.unwrap().value, 1.556_428_045_651_933_2);
    // six decades apart; the ring's own overshoot is exp(−π ζ/√(1 − ζ²)) of its share
    let zeta = 0.1_f64;
    let apart = info("0.5*1000000/(s^2+200s+1000000)+0.5*0.001/(s+0.001)");
    let ring = (-PI * zeta / (1.0 - zeta * zeta).sqrt()).exp();
    assert!((apart.peak.unwrap().value - 1.0).abs() < 1e-9 && apart.overshoot_percent.unwrap() < 1e-6);
    near(apart.settle_s.unwrap(), 1000.0 * 25_f64.ln());
    assert!(0.5 * (1.0 + ring) > 0.8, "the ring's peak is below the final value");
}

#[test]
fn many_poles_at_one_place_are_as_good_as_one() {
    // 1/(s + 1)ⁿ: 1 − e⁻ᵗ Σ tᵏ/k!
    for order in [2, 5, 8, 12] {
        let several = info(&format!("1/(s+1)^{order}"));
        let left = |t: f64| {
            let mut term = (-t).exp();
            let mut sum = 0.0;
            for k in 0..order {
                sum += term;
                term *= t / f64::from(k + 1);
            }
            sum
        };
        let when = |share: f64| {
            let (mut low, mut high) = (0.0, 100.0);
            for _ in 0..200 {
                let middle = 0.5 * (low + high);
                if left(middle) > share { low = middle } else { high = middle }
            }
            low
        };
        near(several.rise_s.unwrap(), when(0.1) - when(0.9));
        near(several.settle_s.unwrap(), when(0.02));
        assert_eq!(several.overshoot_percent, Some(0.0));
    }
}

#[test]
fn a_lightly_damped_pair_settles_after_a_hundred_thousand_swings() {
    let zeta = 1e-5_f64;
    let light = info("1/(s^2+2e-5s+1)");
    near(light.overshoot_percent.unwrap(), 100.0 * (-PI * zeta / (1.0 - zeta * zeta).sqrt()).exp());
    // the last swing beyond 2 % is within half a period of where the envelope is
    assert!((light.settle_s.unwrap() - 50_f64.ln() / zeta).abs() < PI);
}

#[test]
fn what_has_no_final_value_has_no_figures() {
    let none = |ending| StepInfo {
        ending,
        rise_s: None,
        rise_from_s: None,
        settle_s: None,
        overshoot_percent: None,
        undershoot_percent: None,
        peak: None,
    };
    for text in ["1/(s-1)", "5/(s^2-s+4)", "1/s", "1/(s^2+1)^2", "3/(s^2(s+1))"] {
        assert_eq!(info(text), none(Ending::Diverges), "{text}");
    }
    let Ending::Oscillates { about, by } = info("2/(s^2+4)").ending else { panic!("it oscillates") };
    assert!((about - 0.5).abs() < 1e-15 && (by - 0.5).abs() < 1e-15);
    near(info("1e-18/(s+1e-18)").rise_s.unwrap(), 9_f64.ln() * 1e18);
    let washout = info("s/(s+1)^2");
    assert_eq!((washout.ending, washout.overshoot_percent), (Ending::Converges(0.0), None));
    near(washout.peak.unwrap().value, 1.0 / E);
    near(washout.peak.unwrap().time_s.unwrap(), 1.0);
}

#[test]
fn a_zero_that_takes_a_pole_back_leaves_a_value_and_is_told() {
    let reduced = parse("s(s+2)/(s(s+1)(s+4))").transient(Input::Step).unwrap();
    near(reduced.ending().value().unwrap(), 0.5);
    assert_eq!(reduced.hidden().len(), 1);
    let unstable = parse("(s-1)/((s-1)(s+2))").transient(Input::Step).unwrap();
    near(unstable.ending().value().unwrap(), 0.5);
    near(unstable.hidden()[0].re, 1.0);
    near(unstable.at(1.0), 0.5 * (1.0 - (-2_f64).exp()));
}

#[test]
fn an_impulse_that_goes_straight_through_is_told_apart_from_the_rest() {
    let lead = parse("(s+1)/(s+2)").transient(Input::Impulse).unwrap();
    assert_eq!((lead.impulse(), lead.ending()), (1.0, Ending::Converges(0.0)));
    for t in [0.0, 0.3, 2.0] {
        near(lead.at(t), -(-2.0 * t).exp());
    }
    assert!(parse("s^2/(s+1)").transient(Input::Step).is_err());
    assert!(parse("(s^2+1)/(s+1)").transient(Input::Ramp).is_ok());
    assert_eq!(parse("1/(s+1)").transient(Input::Ramp).unwrap().ending(), Ending::Diverges);
    near(parse("1/(s+1)").transient(Input::Ramp).unwrap().at(2.0), 2.0 - 1.0 + (-2_f64).exp());
}

#[test]
fn a_sampled_step_is_judged_by_its_samples() {
    let sampled =
        |text: &str| TransferFunction::parse(text, Time::Sampled(0.5)).unwrap().step_info(0.02).unwrap();
    let dead_beat = sampled("1/z^3");
    assert_eq!(dead_beat.ending, Ending::Converges(1.0));
    assert_eq!((dead_beat.settle_s, dead_beat.overshoot_percent), (Some(1.5), Some(0.0)));
    assert_eq!(sampled("1/(z-1)").ending, Ending::Diverges);
    assert_eq!(sampled("1/(z-1.1)").peak, None);
    assert!(matches!(sampled("1/(z+1)").ending, Ending::Oscillates { .. }));
    let slow = sampled("0.001/(z-0.999)");
    let settled = (50_f64.ln() / -0.999_f64.ln()).ceil() * 0.5;
    assert_eq!(slow.settle_s, Some(settled));
}

#[test]
fn systems_in_other_units_of_time_have_the_same_figures_in_them() {
    let base = parse("(s^2+5s+5)/(s^4+1.65s^3+5s^2+6.5s+2)");
    let expected = base.step_info(0.02).unwrap();
    // against bisection on partial fractions
    near(expected.settle_s.unwrap(), 27.980_085_541_837_326);
    for exponent in [-40, -7, 3, 60] {
        let unit = 2_f64.powi(exponent);
        let slower = |p: &Polynomial| {
            let each = p.coefficients().iter().rev().zip(0..);
            let mut all: Vec<f64> = each.map(|(c, power)| c * unit.powi(power)).collect();
            all.reverse();
            Polynomial::new(all)
        };
        let system =
            TransferFunction::new(slower(base.numerator()), slower(base.denominator()), Time::Continuous);
        let found = system.unwrap().step_info(0.02).unwrap();
        near(found.rise_s.unwrap(), unit * expected.rise_s.unwrap());
        near(found.settle_s.unwrap(), unit * expected.settle_s.unwrap());
        near(found.overshoot_percent.unwrap(), expected.overshoot_percent.unwrap());
    }
}
