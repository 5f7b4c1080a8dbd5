use core::ops::{Add, Div, Mul, Neg, Sub};

use tracelight_maths as maths;

use crate::jet::Scalar;

/// A number with its first derivatives by N parameters: forward-mode differentiation (Griewank & Walther, *Evaluating Derivatives*, §3.1).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dual<const N: usize> {
    pub(crate) value: f64,
    pub(crate) by: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// Parameter number `k`.
    pub(crate) fn parameter(value: f64, k: usize) -> Self {
        let mut by = [0.0; N];
        by[k] = 1.0;
        Self { value, by }
    }

    /// Derivatives as these of two numbers, mixed.
    fn mixed(value: f64, a: (&Self, f64), b: (&Self, f64)) -> Self {
        Self { value, by: std::array::from_fn(|k| a.0.by[k] * a.1 + b.0.by[k] * b.1) }
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self::mixed(self.value + o.value, (&self, 1.0), (&o, 1.0))
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self::mixed(self.value - o.value, (&self, 1.0), (&o, -1.0))
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, by: self.by.map(|d| -d) }
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self::mixed(self.value * o.value, (&self, o.value), (&o, self.value))
    }
}

impl<const N: usize> Div for Dual<N> {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let value = self.value / o.value;
        Self::mixed(value, (&self, 1.0 / o.value), (&o, -value / o.value))
    }
}

impl<const N: usize> Scalar for Dual<N> {
    fn constant(value: f64) -> Self {
        Self { value, by: [0.0; N] }
    }

    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = maths::sin_cos(self.value);
        (Self { value: s, by: self.by.map(|d| c * d) }, Self { value: c, by: self.by.map(|d| -s * d) })
    }
}
