use core::ops::{Add, Div, Mul, Neg, Sub};

use tracelight_maths as maths;

/// What forward kinematics is written in: plain numbers, or numbers with derivatives.
pub(crate) trait Scalar:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    fn constant(value: f64) -> Self;
    fn sin_cos(self) -> (Self, Self);
}

impl Scalar for f64 {
    fn constant(value: f64) -> Self {
        value
    }

    fn sin_cos(self) -> (Self, Self) {
        maths::sin_cos(self)
    }
}

/// A number with its first and second derivative along one parameter: forward-mode differentiation (Griewank &
/// Walther, *Evaluating Derivatives*, ch. 13, Taylor arithmetic of degree 2).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Jet {
    pub(crate) value: f64,
    pub(crate) first: f64,
    pub(crate) second: f64,
}

impl Jet {
    pub(crate) const fn new(value: f64, first: f64, second: f64) -> Self {
        Self { value, first, second }
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self::new(self.value + o.value, self.first + o.first, self.second + o.second)
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.value, -self.first, -self.second)
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self::new(
            self.value * o.value,
            self.first * o.value + self.value * o.first,
            self.second * o.value + 2.0 * self.first * o.first + self.value * o.second,
        )
    }
}

impl Div for Jet {
    type Output = Self;
    /// From q·o = self, differentiated twice.
    fn div(self, o: Self) -> Self {
        let value = self.value / o.value;
        let first = (self.first - value * o.first) / o.value;
        let second = (self.second - 2.0 * first * o.first - value * o.second) / o.value;
        Self::new(value, first, second)
    }
}

impl Scalar for Jet {
    fn constant(value: f64) -> Self {
        Self::new(value, 0.0, 0.0)
    }

    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = maths::sin_cos(self.value);
        let (d, dd) = (self.first, self.second);
        (Self::new(s, c * d, c * dd - s * d * d), Self::new(c, -s * d, -s * dd - c * d * d))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jet_carries_the_derivatives_of_a_quotient() {
        // f(t) = sin(t)/(1 + t²) at t = 0.3, against central differences
        let f = |t: f64| t.sin() / (1.0 + t * t);
        let t = Jet::new(0.3, 1.0, 0.0);
        let j = t.sin_cos().0 / (Jet::constant(1.0) + t * t);
        let h = 1e-4;
        let (m, z, p) = (f(0.3 - h), f(0.3), f(0.3 + h));
        assert!((j.value - z).abs() < 1e-15);
        assert!((j.first - (p - m) / (2.0 * h)).abs() < 1e-8);
        assert!((j.second - (p - 2.0 * z + m) / (h * h)).abs() < 1e-6);
    }
}
