//! Sine, cosine and square root in `f32` alone: what libraries have of them computes in `f64`, which the board has no instructions for, or bit by bit.
//!
//! They are sums and products, which are the same bits on every processor.

use core::f32::consts::FRAC_2_PI;

/// A quarter of a turn in four parts. So many bits are in each of the first three that its product with a whole number of ten bits is exact.
const QUARTER: [f32; 4] = [1.570_678_7, 1.175_999_64e-4, 1.589_069_1e-8, 2.563_344e-12];
/// Added to a number and taken off again it leaves the nearest whole one.
const TO_WHOLE: f32 = 12_582_912.0;
/// Of r + r³ (…), minimax for r² to an eighth of a turn, to 4·10⁻⁹.
const SINE: [f32; 3] = [-0.166_666_54, 8.332_083e-3, -1.950_431_8e-4];
/// Of 1 − r²/2 + r⁴ (…), likewise, to 2·10⁻¹⁰.
const COSINE: [f32; 3] = [4.166_664_6e-2, -1.388_724_3e-3, 2.442_388_9e-5];

/// Sine and cosine of an angle, rad: each within 0.8 of a unit in its last place for every angle up to ±1024 rad. Beyond, they lie within ±1 and mean nothing.
/// Of what is not finite they are not numbers.
pub(crate) fn sin_cos(angle_rad: f32) -> (f32, f32) {
    let quarters = (angle_rad * FRAC_2_PI + TO_WHOLE) - TO_WHOLE;
    // both exact, by the bits of their parts
    let near = (angle_rad - quarters * QUARTER[0]) - quarters * QUARTER[1];
    let off = quarters * QUARTER[2];
    let high = near - off;
    let low = ((near - high) - off) - quarters * QUARTER[3];
    // what is left of it in a number and what that rounds off; beyond the range they are anything
    let r = (high + low).clamp(-0.8, 0.8);
    let rest = ((high - r) + low).clamp(-1e-6, 1e-6);
    let square = r * r;
    let half = 0.5 * square;
    let sin = r + (r * square * polynomial(SINE, square) + rest * (1.0 - half));
    let most = 1.0 - half;
    let cos = most + (((1.0 - most) - half) + (square * square * polynomial(COSINE, square) - r * rest));
    match quarters as i32 & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// Square root, within one unit in its last place from 10⁻³⁷ to 10³⁸; 0 of 0. Of what is negative, infinite or no number it is no number.
pub(crate) fn root(square: f32) -> f32 {
    /// A straight line through the logarithms: 1/√x to a thirtieth of it (Lomont, *Fast inverse square root*, 2003).
    const GUESS: u32 = 0x5f37_59df;
    let half = 0.5 * square;
    let mut inverse = f32::from_bits(GUESS.wrapping_sub(square.to_bits() >> 1));
    for _ in 0..3 {
        inverse *= 1.5 - half * inverse * inverse;
    }
    let root = square * inverse;
    let better = root + 0.5 * inverse * (square - root * root);
    if square >= 0.0 { better } else { f32::NAN }
}

fn polynomial([first, second, third]: [f32; 3], x: f32) -> f32 {
    first + x * (second + x * third)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How far a value is from the true one, in units of its last place.
    fn off_ulp(value: f32, truly: f64) -> f64 {
        let nearest = (truly as f32).abs().max(f32::MIN_POSITIVE);
        let ulp = f64::from(f32::from_bits(nearest.to_bits() + 1)) - f64::from(nearest);
        (f64::from(value) - truly).abs() / ulp
    }

    /// The worst of every so many angles up to 1024 rad, beginning with that one.
    fn worst_ulp(first: u32, every: usize) -> f64 {
        let angles = (first..=1024_f32.to_bits()).step_by(every).map(f32::from_bits);
        let off = |angle: f32| {
            let (sin, cos) = sin_cos(angle);
            assert_eq!(sin_cos(-angle), (-sin, cos));
            let (true_sin, true_cos) = libm::sincos(f64::from(angle));
            off_ulp(sin, true_sin).max(off_ulp(cos, true_cos))
        };
        angles.map(off).fold(0.0, f64::max)
    }

    #[test]
    fn sine_and_cosine_are_right_to_a_unit_of_their_last_place() {
        let worst = worst_ulp(0, 997).max(worst_ulp(0x3f00_0000, 31));
        assert!(worst < 0.8, "{worst}");
    }

    #[test]
    #[ignore = "minutes: `bash .ci/run long`; its short twin always runs"]
    fn sine_and_cosine_of_every_angle_are_right_to_a_unit_of_their_last_place() {
        let worst = worst_ulp(0, 1);
        assert!((0.7..0.8).contains(&worst), "{worst}");
    }

    #[test]
    fn beyond_their_range_they_are_bounded_and_of_nothing_they_are_nothing() {
        for bits in (1024_f32.to_bits()..f32::INFINITY.to_bits()).step_by(4999) {
            let (sin, cos) = sin_cos(f32::from_bits(bits));
            assert!(sin.abs() <= 1.0 && cos.abs() <= 1.0, "{bits}: {sin} {cos}");
        }
        for nothing in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let (sin, cos) = sin_cos(nothing);
            assert!(sin.is_nan() && cos.is_nan());
        }
    }

    #[test]
    fn a_root_is_right_to_a_unit_of_its_last_place() {
        let range = 1e-37_f32.to_bits()..1e38_f32.to_bits();
        // of all mantissas in two octaves, and of all octaves
        let two = 1_f32.to_bits()..4_f32.to_bits();
        for square in two.step_by(13).chain(range.step_by(4999)).map(f32::from_bits) {
            let off = off_ulp(root(square), libm::sqrt(f64::from(square)));
            assert!(off <= 1.0, "{square}: {off}");
        }
        assert_eq!(root(0.0), 0.0);
        assert!([-1.0, f32::NAN, f32::INFINITY].into_iter().all(|square| root(square).is_nan()));
    }
}
