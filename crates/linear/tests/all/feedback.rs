//! Loops of plant and controller beside numpy and scipy: peaks by `minimize_scalar` about the highest of 400 001 places from 1e-4 to 1e4 rad/s
//! of the complex formulas; H2 by `solve_continuous_lyapunov`; the answer to a load by Heun's method in steps of 1e-5 s
//! (numpy 2.4, scipy 1.17).

use tracelight_linear::{Delayed, FeedbackLoop, Input, LoopMember, Norm, Time, TransferFunction};

fn delayed(text: &str) -> Delayed {
    Delayed::parse_with(text, Time::Continuous, &|_| None).unwrap()
}

/// Frequency, rad/s, and gain of a peak; no frequency where scipy's peak is at an end of its band.
type Top = (Option<f64>, f64);

/// Plant, controller, and the peaks of S, T, PS and CS.
const PEAKS: [(&str, &str, [Top; 4]); 4] = [
    (
        "1/(s(s+1)(s+2))",
        "6(s+0.5)/(s+5)",
        [
            (Some(1.728_261_604), 1.171_765_458_07),
            (Some(0.0), 1.0),
            (Some(0.0), 5.0 / 3.0),
            (Some(f64::INFINITY), 6.0),
        ],
    ),
    (
        "2exp(-0.3s)/(s+1)",
        "0.8(s+2)/s",
        [
            (Some(2.817_507_682), 2.006_418_479_77),
            (Some(2.086_651_560), 1.581_665_648_95),
            (Some(2.325_445_999), 1.466_271_475_71),
            (Some(2.571_936_057), 1.999_886_476_99),
        ],
    ),
    (
        "exp(-0.5s)/(s+1)^2",
        "1.2(1+1/(1.5s)+0.4s/(0.04s+1))",
        [
            (Some(1.285_153_253), 1.428_660_767_01),
            (Some(0.547_154_595), 1.072_920_573_53),
            (Some(0.799_238_205), 0.736_640_877_557),
            (None, 13.2),
        ],
    ),
    (
        "5exp(-0.2s)/(s^2+0.2s+25)",
        "0.6/(s+1)",
        [
            (Some(4.939_957_065), 1.941_342_619_52),
            (Some(4.954_706_599), 1.032_813_974_4),
            (Some(4.955_355_926), 8.701_340_309_95),
            (Some(0.0), 0.6 / 1.12),
        ],
    ),
];

#[test]
fn peaks_of_the_four_are_scipys() {
    for (plant, controller, peaks) in PEAKS {
        let of = FeedbackLoop::new(delayed(plant), delayed(controller), false).unwrap();
        for (member, (rad_s, gain)) in LoopMember::ALL.into_iter().zip(peaks) {
            let Norm::Finite(peak) = of.function(member).h_infinity() else {
                panic!("{plant} {controller} {member:?} has one");
            };
            let within = if rad_s.is_some() { 1e-10 } else { 1e-4 };
            assert!(
                (peak.gain / gain - 1.0).abs() < within,
                "{plant} {controller} {member:?}: {peak:?} {gain}"
            );
            if let Some(rad_s) = rad_s {
                let same = peak.rad_s == rad_s || (peak.rad_s / rad_s - 1.0).abs() < 1e-5;
                assert!(same, "{plant} {controller} {member:?}: {peak:?} {rad_s}");
            }
        }
    }
}

/// The peak of S is one over the modulus margin, which is found in another way.
#[test]
fn the_peak_of_a_sensitivity_is_one_over_the_modulus_margin() {
    for (text, delay_s) in
        [("1/s", 0.9), ("2/(s+1)", 0.7), ("3(s+1)/(s^2+0.2s+4)", 0.1), ("0.6(s+3)/(s+1)", 0.4)]
    {
        let open = TransferFunction::parse(text, Time::Continuous).unwrap();
        let of = FeedbackLoop::of(Delayed::new(open, delay_s).unwrap(), false).unwrap();
        let Norm::Finite(peak) = of.function(LoopMember::Sensitivity).h_infinity() else {
            panic!("{text} {delay_s} has one");
        };
        let modulus = of.open().margins().modulus.unwrap().distance;
        assert!((peak.gain * modulus - 1.0).abs() < 1e-9, "{text} {delay_s}: {peak:?} {modulus}");
    }
}

#[test]
fn there_is_no_norm_of_what_is_not_stable() {
    for (plant, controller, expected) in [
        ("1/(s-1)", "0.5", Norm::Unstable),
        // the pole that a zero hides still grows
        ("1/(s-1)", "(s-1)/(s+1)", Norm::Unstable),
        ("1/s^2", "1", Norm::Edge),
        ("exp(-2s)/s", "1", Norm::Unstable),
    ] {
        let of = FeedbackLoop::new(delayed(plant), delayed(controller), false).unwrap();
        for member in LoopMember::ALL {
            assert_eq!(of.function(member).h_infinity(), expected, "{plant} {controller} {member:?}");
        }
    }
    // an ideal PD amplifies noise without bounds
    let of = FeedbackLoop::new(delayed("1/(s(s+1))"), delayed("1+s"), false).unwrap();
    assert_eq!(of.function(LoopMember::Control).h_infinity(), Norm::Improper);
    assert!(of.function(LoopMember::Load).h_infinity().peak().is_some());
    // negative feedback of −G is positive feedback of G
    let positive = FeedbackLoop::of(delayed("0.5/(s+1)"), true).unwrap();
    let Norm::Finite(peak) = positive.function(LoopMember::Complementary).h_infinity() else {
        panic!("it has one")
    };
    assert!((peak.gain - 1.0).abs() < 1e-12 && peak.rad_s == 0.0, "{peak:?}");
}

#[test]
fn norms_of_a_system_are_scipys() {
    let system = TransferFunction::parse("(3s+1)/(s^3+2s^2+5s+7)", Time::Continuous).unwrap();
    let peak = system.h_infinity().peak().unwrap();
    assert!(
        (peak.gain - 2.916_994_773_285).abs() < 1e-9 && (peak.rad_s - 2.076_911_9).abs() < 1e-6,
        "{peak:?}"
    );
    assert!((system.h2_norm().unwrap().unwrap() - 1.244_033_378_820_296_6).abs() < 1e-12);
    let of = |text: &str| TransferFunction::parse(text, Time::Continuous).unwrap();
    assert_eq!(of("1/s").h_infinity(), Norm::Edge);
    assert_eq!(of("1/(s-2)").h_infinity(), Norm::Unstable);
    assert_eq!(of("s").h_infinity(), Norm::Improper);
    assert_eq!([of("1/s"), of("1/(s-2)"), of("s/(s+1)"), of("s")].map(|g| g.h2_norm().unwrap()), [None; 4]);
}

#[test]
fn a_load_is_answered_as_heuns_method_says() {
    let of = FeedbackLoop::new(delayed("2exp(-0.2s)/(s+1)"), delayed("0.8(s+2)/s"), false).unwrap();
    let answer = of.function(LoopMember::Load).answer(Input::Step, 12.0).unwrap();
    for (t, value) in [
        (0.19, 0.0),
        (0.5, 0.502_376_371_7),
        (1.0, 0.597_701_028_4),
        (2.0, 0.022_977_360_0),
        (5.0, 0.002_633_278_6),
    ] {
        assert!((answer.at(t) - value).abs() < 1e-7, "{t}: {} {value}", answer.at(t));
    }
    let peak = answer.peak().unwrap().unwrap();
    assert!((peak.value - 0.656_781_930_9).abs() < 1e-7, "{peak:?}");
    assert!((peak.time_s.unwrap() - 0.784_98).abs() < 1e-3, "{peak:?}");
}
