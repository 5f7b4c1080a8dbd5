//! Each function against the truth, where it is special, and that its bits are those of every other machine.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking, in its helpers too")]

use kurbo::Point;
use num_complex::Complex;
use tracelight_maths::{
    acos, asin, atan, atan2, cbrt, complex, cos, erfc, exp, exp_m1, exp2, hypot, ln, ln_1p, log2, log10,
    planar, powf, powi, sin, sin_cos, single, tan,
};

/// A function of one number, by name.
fn one(name: &str) -> Option<fn(f64) -> f64> {
    Some(match name {
        "sin" => sin,
        "cos" => cos,
        "tan" => tan,
        "asin" => asin,
        "acos" => acos,
        "atan" => atan,
        "exp" => exp,
        "exp2" => exp2,
        "exp_m1" => exp_m1,
        "ln" => ln,
        "ln_1p" => ln_1p,
        "log10" => log10,
        "log2" => log2,
        "cbrt" => cbrt,
        "erfc" => erfc,
        _ => return None,
    })
}

fn two(name: &str) -> fn(f64, f64) -> f64 {
    match name {
        "atan2" => atan2,
        "powf" => powf,
        "hypot" => hypot,
        _ => panic!("no function {name}"),
    }
}

/// A row of `known.csv`: the function, what it gives here, and the truth.
fn rows() -> Vec<(String, f64, f64)> {
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |k: usize| cells[k].parse::<f64>().unwrap();
        let here = one(cells[0]).map_or_else(|| two(cells[0])(number(1), number(2)), |f| f(number(1)));
        (line.to_owned(), here, number(3))
    };
    include_str!("oracle/known.csv").lines().skip(1).map(row).collect()
}

/// How many numbers lie between two, counting the second.
fn places_apart(a: f64, b: f64) -> u64 {
    let on_line =
        |x: f64| if x.is_sign_negative() { -((x.to_bits() << 1 >> 1) as i64) } else { x.to_bits() as i64 };
    on_line(a).abs_diff(on_line(b))
}

#[test]
fn every_function_is_within_a_unit_in_the_last_place() {
    let rows = rows();
    assert_eq!(rows.len(), 60 * 19, "rows of known.csv");
    for (row, here, truth) in rows {
        assert!(places_apart(here, truth) <= 1, "{row}: {here} here");
    }
}

#[test]
fn places_are_counted_across_zero_and_powers_of_two() {
    assert_eq!(places_apart(1.0, 1.0), 0);
    assert_eq!(places_apart(1.0, 1.0 + f64::EPSILON), 1);
    assert_eq!(places_apart(1.0, 1.0 - f64::EPSILON / 2.0), 1);
    assert_eq!(places_apart(-f64::from_bits(1), f64::from_bits(2)), 3);
    assert_eq!(places_apart(-0.0, 0.0), 0);
}

#[test]
fn special_arguments_have_the_values_of_the_standard() {
    let (inf, nan) = (f64::INFINITY, f64::NAN);
    let same = |a: f64, b: f64| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
    let check = |what: &str, is: f64, wanted: f64| assert!(same(is, wanted), "{what}: {is}, not {wanted}");
    for f in [sin, tan, asin, atan, cbrt, exp_m1, ln_1p] {
        check("an odd function of -0", f(-0.0), -0.0);
        check("a function of no number", f(nan), nan);
    }
    for f in [sin, cos, tan, asin, acos] {
        check("without a value at infinity", f(inf), nan);
    }
    check("asin(1.1)", asin(1.1), nan);
    check("acos(1)", acos(1.0), 0.0);
    check("atan2(0, -1)", atan2(0.0, -1.0), std::f64::consts::PI);
    check("atan2(-0, -1)", atan2(-0.0, -1.0), -std::f64::consts::PI);
    check("atan2(0, 0)", atan2(0.0, 0.0), 0.0);
    check("exp(0)", exp(0.0), 1.0);
    check("exp(710)", exp(710.0), inf);
    check("exp(-inf)", exp(-inf), 0.0);
    check("exp2(-3)", exp2(-3.0), 0.125);
    check("ln(0)", ln(0.0), -inf);
    check("ln(-1)", ln(-1.0), nan);
    check("log10(1000)", log10(1000.0), 3.0);
    check("log2(1/8)", log2(0.125), -3.0);
    check("powf(-8, 1/3)", powf(-8.0, 1.0 / 3.0), nan);
    check("powf(no number, 0)", powf(nan, 0.0), 1.0);
    check("hypot(inf, no number)", hypot(-inf, nan), inf);
    check("hypot(3, 4)", hypot(3.0, -4.0), 5.0);
    let far = exp2(600.0);
    check("hypot where squares are infinite", hypot(3.0 * far, 4.0 * far), 5.0 * far);
    check("cbrt(-27)", cbrt(-27.0), -3.0);
}

#[test]
fn whole_powers_are_products_in_the_order_that_is_promised() {
    let x = 1.1_f64;
    let (x2, x4) = (x * x, (x * x) * (x * x));
    for (n, wanted) in [(0, 1.0), (1, x), (2, x2), (3, x * x2), (5, x * x4), (6, x2 * x4), (7, x * x2 * x4)] {
        assert_eq!(powi(x, n).to_bits(), wanted.to_bits(), "n = {n}");
        assert_eq!(powi(x, -n).to_bits(), (1.0 / wanted).to_bits(), "n = -{n}");
    }
    assert_eq!((powi(2.0, 1023), powi(2.0, -1022)), (f64::MAX / (2.0 - f64::EPSILON), f64::MIN_POSITIVE));
    assert_eq!((powi(-1.0, i32::MAX), powi(-1.0, i32::MIN)), (-1.0, 1.0));
    assert_eq!((powi(0.0, -1), powi(f64::NAN, 0)), (f64::INFINITY, 1.0));
    let off = |n: i32| {
        (powi(x, n) / powf(x, f64::from(n)) - 1.0).abs() / f64::from(n.abs()) * 9_007_199_254_740_992.0
    };
    assert!(
        (2..200).all(|n| off(n) < 2.0 && off(-n) < 2.0),
        "more than its rounding, and that of the other way"
    );
}

#[test]
fn both_of_sine_and_cosine_are_each_of_them() {
    for k in -2000..2000 {
        let x = f64::from(k) * 0.37;
        let (s, c) = sin_cos(x);
        assert_eq!((s.to_bits(), c.to_bits()), (sin(x).to_bits(), cos(x).to_bits()), "at {x}");
    }
}

#[test]
fn single_precision_is_within_a_unit_of_the_double_one() {
    let near = |is: f32, truth: f64| (f64::from(is) - truth).abs() <= truth.abs() * f64::from(f32::EPSILON);
    for k in 0..2000_i16 {
        let x = 0.001 + f32::from(k) * 0.005;
        let wide = f64::from(x);
        assert!(near(single::exp(-x), exp(-wide)), "exp(-{x})");
        assert!(near(single::powf(x, 2.4), powf(wide, f64::from(2.4_f32))), "{x} to the power of 2.4");
        assert_eq!(single::powi(x, 3).to_bits(), (x * (x * x)).to_bits(), "{x} to the power of 3");
    }
    assert_eq!(single::powi(2.0, -3), 0.125);
}

#[test]
fn complex_numbers_go_to_their_polar_form_and_back() {
    for k in 0..500 {
        let angle = -3.1 + f64::from(k) * 0.0124;
        let z = complex::from_polar(2.5, angle);
        assert!((complex::norm(z) - 2.5).abs() < 1e-15 && (complex::arg(z) - angle).abs() < 2e-15, "{z}");
        let back = complex::exp(complex::ln(z)) - z;
        assert!(complex::norm(back) < 3e-15, "{z} comes back off by {back}");
    }
    assert_eq!(complex::exp(Complex::new(1.0, -0.0)).im.to_bits(), (-0.0_f64).to_bits());
    assert_eq!(complex::exp(Complex::new(f64::INFINITY, 0.0)), Complex::new(f64::INFINITY, 0.0));
}

#[test]
fn directions_turns_and_headings_of_the_plane_agree() {
    for k in -300..300 {
        let angle = f64::from(k) * 0.01;
        let way = planar::direction(angle);
        assert!((planar::heading(way) - angle).abs() < 1e-15, "{angle}");
        let turned = planar::rotation(angle) * Point::new(2.0, 0.0);
        assert_eq!(turned, (2.0 * way).to_point(), "{angle}");
        let back = planar::rotation(-angle) * turned;
        assert!((back - Point::new(2.0, 0.0)).hypot() < 1e-15, "{angle}");
    }
}

/// FNV-1a over the bits of every function's values at 2000 places each.
fn hash() -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut add = |bits: u64| {
        for byte in bits.to_le_bytes() {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    };
    let mut state = 2006_u64;
    let mut draw = || {
        // Knuth's constants
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for _ in 0..2000 {
        let (x, y) = (draw(), 20.0 * draw() - 10.0);
        let of_one = [sin(y), cos(y), tan(y), asin(x), acos(x), atan(y), exp(y), exp2(y), exp_m1(y), erfc(y)];
        let more =
            [ln(x), ln_1p(x), log10(x), log2(x), cbrt(y), atan2(x, y), powf(x, y), hypot(x, y), powi(x, 7)];
        of_one.into_iter().chain(more).for_each(|value| add(value.to_bits()));
        let narrow = [single::exp(y as f32), single::powf(x as f32, y as f32), single::powi(x as f32, 5)];
        narrow.into_iter().for_each(|value| add(u64::from(value.to_bits())));
    }
    hash
}

/// Whoever sees this fail on another machine has found one whose bits differ; after a new version of `libm` the results of
/// the whole program move, which the changelog tells.
#[test]
fn the_bits_are_those_of_every_other_machine() {
    assert_eq!(format!("{:016x}", hash()), "6870002955030345");
}
