//! Elementary functions whose bits are the same on every processor.
//!
//! `f64::sin` and its like ask the C library, which has one code for processors that multiply and add in one step and
//! another for those that do not, and the compiler may work them out with a third. The last digit then depends on the
//! machine, and what grows out of it, a tick that stuck or slid, a stroke cut or not, does too. The functions here are
//! those of one pinned `libm`, which is Rust alone: what it asks a processor for (square roots, rounding, a product and a
//! sum rounded once) is exact by IEEE 754, so that one processor's instruction and another's long way come to the same.
//! For the same reason `sqrt`, `floor`, `round`, `abs` and `%` stay methods of `f64`.
//!
//! Everything is within a unit in the last place, but [`powi`]. Angles are in radians. What has no value is NaN, too large
//! a value infinite, as everywhere in IEEE 754.

pub mod complex;
pub mod planar;
pub mod single;

/// The sine of `x` radians.
#[inline]
pub fn sin(x: f64) -> f64 {
    libm::sin(x)
}

/// The cosine of `x` radians.
#[inline]
pub fn cos(x: f64) -> f64 {
    libm::cos(x)
}

/// The sine and the cosine of `x` radians: the same bits as [`sin`] and [`cos`], in less time.
#[inline]
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// The tangent of `x` radians.
#[inline]
pub fn tan(x: f64) -> f64 {
    libm::tan(x)
}

/// The angle from −π/2 to π/2 whose sine is `x`; NaN outside of [−1, 1].
#[inline]
pub fn asin(x: f64) -> f64 {
    libm::asin(x)
}

/// The angle from 0 to π whose cosine is `x`; NaN outside of [−1, 1].
#[inline]
pub fn acos(x: f64) -> f64 {
    libm::acos(x)
}

/// The angle from −π/2 to π/2 whose tangent is `x`.
#[inline]
pub fn atan(x: f64) -> f64 {
    libm::atan(x)
}

/// The angle from −π to π of the point (`x`, `y`), `y` first; 0 or ±π at the origin, by the zeros' signs.
#[inline]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// e to the power of `x`.
#[inline]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// 2 to the power of `x`; exact where `x` is whole.
#[inline]
pub fn exp2(x: f64) -> f64 {
    libm::exp2(x)
}

/// e to the power of `x`, less 1; as good near zero, where the difference would lose its digits.
#[inline]
pub fn exp_m1(x: f64) -> f64 {
    libm::expm1(x)
}

/// The natural logarithm of `x`; −∞ at zero, NaN below.
#[inline]
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// The natural logarithm of 1 + `x`; as good near zero, where the sum would lose its digits.
#[inline]
pub fn ln_1p(x: f64) -> f64 {
    libm::log1p(x)
}

/// The logarithm of `x` to base 10; −∞ at zero, NaN below.
#[inline]
pub fn log10(x: f64) -> f64 {
    libm::log10(x)
}

/// The logarithm of `x` to base 2; −∞ at zero, NaN below.
#[inline]
pub fn log2(x: f64) -> f64 {
    libm::log2(x)
}

/// `x` to the power of `y`; NaN where `x` is negative and `y` not whole.
///
/// It takes some forty products' time: write a product or a root where that says the same.
#[inline]
pub fn powf(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}

/// `x` to the power of `n`, by squaring: `n`'s bits are read from the lowest; for each that is set the product, 1 at
/// first, is multiplied by `x` squared as often as bits lie below it. A negative power is 1 over the positive one.
///
/// `f64::powi` leaves the order open. Every product rounds: the result is off by |n| · 2⁻⁵³ of itself at most.
#[inline]
pub fn powi(x: f64, n: i32) -> f64 {
    let (mut square, mut bits, mut product) = (x, n.unsigned_abs(), 1.0);
    while bits > 0 {
        if bits & 1 == 1 {
            product *= square;
        }
        square *= square;
        bits >>= 1;
    }
    if n < 0 { 1.0 / product } else { product }
}

/// The length of the vector (`x`, `y`), without overflow on the way; infinite where either is, whatever the other.
#[inline]
pub fn hypot(x: f64, y: f64) -> f64 {
    libm::hypot(x, y)
}

/// The cube root of `x`, with its sign.
#[inline]
pub fn cbrt(x: f64) -> f64 {
    libm::cbrt(x)
}

/// What the error function leaves of 1: the integral of 2/√π · exp(−t²) from `x` to infinity.
#[inline]
pub fn erfc(x: f64) -> f64 {
    libm::erfc(x)
}

/// The examples of `README.md`, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
