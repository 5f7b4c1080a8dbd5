//! Numbers as mantissas and powers of two, for what may leave the range of `f64` on the way.

use tracelight_maths::powi;

use crate::Complex;

/// A complex number times a power of two.
pub(crate) fn times_power(value: Complex, exponent: i32) -> Complex {
    if exponent.abs() < 1000 {
        return value * f64::from_bits(((1023 + exponent) as u64) << 52);
    }
    let by = |part: f64| {
        let (mantissa, own) = split(part);
        join(mantissa, own + exponent)
    };
    Complex::new(by(value.re), by(value.im))
}

/// Mantissa in ±[½, 1) and power of two; zero is 0 · 2⁰.
pub(crate) fn split(value: f64) -> (f64, i32) {
    /// Two to the power of 64 makes a normal number of any other.
    const NORMAL: f64 = 18_446_744_073_709_551_616.0;
    if value == 0.0 || !value.is_finite() {
        return (value, 0);
    }
    let (normal, less) = if value.abs() < f64::MIN_POSITIVE { (value * NORMAL, 64) } else { (value, 0) };
    let bits = normal.to_bits();
    let exponent = ((bits >> 52) & 0x7ff) as i32 - 1022;
    (f64::from_bits((bits & !(0x7ff << 52)) | (1022 << 52)), exponent - less)
}

/// mantissa · 2^exponent, rounded once; beyond the range zero or infinity.
pub(crate) fn join(mantissa: f64, exponent: i32) -> f64 {
    let half = exponent.clamp(-2200, 2200) / 2;
    let power = |e: i32| powi(2.0, e);
    let quarter = |e: i32| power(e / 2) * power(e - e / 2);
    mantissa * quarter(half) * quarter(exponent.clamp(-2200, 2200) - half)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_split_and_joined_exactly() {
        for value in [1.0, -3.7e300, 5e-324, 1e-310, -f64::MIN_POSITIVE, f64::MAX, 0.0] {
            let (mantissa, exponent) = split(value);
            assert!(value == 0.0 || (0.5..1.0).contains(&mantissa.abs()), "{value}");
            assert_eq!(join(mantissa, exponent), value);
        }
        assert_eq!(join(0.5, 5000), f64::INFINITY);
        assert_eq!(join(0.5, -5000), 0.0);
    }
}
