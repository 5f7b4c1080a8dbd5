//! The same for complex numbers: what `num-complex` would ask the C library for.
//!
//! It is built without `std`, so that `z.norm()` and its like do not exist. Sums, products, quotients and whole powers
//! are its own.

use num_complex::Complex;

/// The absolute value of `z`.
#[inline]
pub fn norm(z: Complex<f64>) -> f64 {
    crate::hypot(z.re, z.im)
}

/// The angle of `z`, from −π to π.
#[inline]
pub fn arg(z: Complex<f64>) -> f64 {
    crate::atan2(z.im, z.re)
}

/// The number of this absolute value and this angle in radians.
#[inline]
pub fn from_polar(norm: f64, angle_rad: f64) -> Complex<f64> {
    let (sin, cos) = crate::sin_cos(angle_rad);
    Complex::new(norm * cos, norm * sin)
}

/// e to the power of `z`: [`from_polar`] of `exp(z.re)` and `z.im`; real where `z` is.
#[inline]
pub fn exp(z: Complex<f64>) -> Complex<f64> {
    let norm = crate::exp(z.re);
    if z.im == 0.0 { Complex::new(norm, z.im) } else { from_polar(norm, z.im) }
}

/// The natural logarithm of `z` whose imaginary part is from −π to π.
#[inline]
pub fn ln(z: Complex<f64>) -> Complex<f64> {
    Complex::new(crate::ln(norm(z)), arg(z))
}
