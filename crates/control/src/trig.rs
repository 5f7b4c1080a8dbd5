//! Sine, cosine and hypotenuse in `f32` alone: what the C library has of them computes in `f64`, which the board has no instructions for.

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

/// √(a² + b²): within one and a half units in its last place where neither square leaves what `f32` holds to all its bits, that is of 10⁻¹⁸ to 10¹⁸. Smaller ones
/// vanish, and of larger ones it is infinite.
pub(crate) fn hypotenuse(a: f32, b: f32) -> f32 {
    libm::sqrtf(a * a + b * b)
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
    fn a_hypotenuse_is_right_to_its_last_place() {
        // Marsaglia's xorshift
        let mut seed = 88_172_645_463_325_252_u64;
        let mut number = || {
            seed ^= seed << 13;
            seed ^= seed >> 7;
            seed ^= seed << 17;
            let (least, most) = (1e-18_f32.to_bits(), 1e18_f32.to_bits());
            f32::from_bits(least + (seed >> 32) as u32 % (most - least))
        };
        for _ in 0..300_000 {
            let (a, b) = (number(), number());
            let truly = libm::hypot(f64::from(a), f64::from(b));
            assert!(off_ulp(hypotenuse(a, -b), truly) <= 1.5, "{a} {b}");
        }
        assert!(hypotenuse(1e30, 0.0).is_infinite() && hypotenuse(f32::NAN, 1.0).is_nan());
    }
}
