//! The same for `f32`, in which pixels' light is reckoned. (`control` asks `libm` itself.)

/// e to the power of `x`.
#[inline]
pub fn exp(x: f32) -> f32 {
    libm::expf(x)
}

/// `x` to the power of `y`; NaN where `x` is negative and `y` not whole.
#[inline]
pub fn powf(x: f32, y: f32) -> f32 {
    libm::powf(x, y)
}

/// `x` to the power of `n`, in the order of [`crate::powi`].
#[inline]
pub fn powi(x: f32, n: i32) -> f32 {
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
