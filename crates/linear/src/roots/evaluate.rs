use tracelight_maths::complex;

use super::start::polygon;
use crate::Complex;
use crate::binary::{join, split, times_power};

/// A polynomial that can be looked at on any scale: no value on the way leaves the range of `f64`.
pub(super) struct Scaled {
    degree: usize,
    scales: Vec<Scale>,
}

/// p(2ᵉ y), divided by the largest of its coefficients: what vanishes then does not matter where |y| is about 1.
struct Scale {
    exponent: i32,
    /// Highest power first.
    coefficients: Vec<f64>,
    /// Lowest power first.
    reversed: Vec<f64>,
}

/// A step towards a root.
pub(super) struct Step {
    /// p / p′.
    pub(super) newton: Complex,
    /// Whether the value is no more than what rounding makes of zero.
    pub(super) is_settled: bool,
}

/// What a polynomial is at a place.
struct Value {
    value: Complex,
    derivative: Complex,
    /// Σ |cᵢ| |z|ⁱ: rounding is a share of it.
    size: f64,
}

impl Scale {
    fn new(parts: &[(f64, i32)], exponent: i32) -> Self {
        let degree = parts.len() - 1;
        let power = |i: usize| parts[i].1 + exponent * (degree - i) as i32;
        let most = (0..=degree).filter(|&i| parts[i].0 != 0.0).map(power).max().unwrap_or(0);
        let coefficients: Vec<f64> = (0..=degree).map(|i| join(parts[i].0, power(i) - most)).collect();
        let reversed = coefficients.iter().rev().copied().collect();
        Self { exponent, coefficients, reversed }
    }
}

impl Scaled {
    /// First and last coefficient are not zero.
    pub(super) fn new(coefficients: &[f64]) -> Self {
        /// Scales this close are one, powers of two.
        const CLOSE: i32 = 8;
        let parts: Vec<(f64, i32)> = coefficients.iter().map(|&c| split(c)).collect();
        let mut exponents: Vec<i32> =
            polygon(coefficients).iter().map(|edge| edge.radius_log2.round() as i32).collect();
        exponents.dedup_by(|next, kept| (*next - *kept).abs() <= CLOSE);
        let scales = exponents.iter().map(|&exponent| Scale::new(&parts, exponent)).collect();
        Self { degree: coefficients.len() - 1, scales }
    }

    pub(super) const fn degree(&self) -> usize {
        self.degree
    }

    /// Coefficients on the scale of a place, highest power first, and the place on that scale.
    pub(super) fn near(&self, place: Complex) -> (&[f64], Complex) {
        let (scale, place) = self.scale(place);
        (&scale.coefficients, place)
    }

    fn scale(&self, place: Complex) -> (&Scale, Complex) {
        // there is one at least: a polynomial with roots has a polygon
        let mut scale = &self.scales[0];
        if self.scales.len() > 1 {
            let exponent = split(place.re.abs().max(place.im.abs())).1;
            let nearest = self.scales.iter().min_by_key(|scale| (scale.exponent - exponent).abs());
            scale = nearest.unwrap_or(scale);
        }
        (scale, times_power(place, -scale.exponent))
    }

    /// p / p′, the value, and the sum of the values of its terms. Outside a scale's unit circle it is the reversed polynomial at
    /// 1/y that is looked at, which nothing makes overflow.
    fn newton(&self, place: Complex, value: impl Fn(&[f64], Complex) -> Value) -> (Complex, Complex, f64) {
        let (scale, place) = self.scale(place);
        let (newton, value, size) = if place.norm_sqr() <= 1.0 {
            let Value { value, derivative, size } = value(&scale.coefficients, place);
            (value / derivative, value, size)
        } else {
            let at = place.inv();
            let Value { value, derivative, size } = value(&scale.reversed, at);
            (value / (at * (value * self.degree as f64 - at * derivative)), value, size)
        };
        (times_power(newton, scale.exponent), value, size)
    }

    /// With plain values.
    pub(super) fn step(&self, place: Complex) -> Step {
        let (newton, value, size) = self.newton(place, plain);
        let rounding = 4.0 * self.degree as f64 * f64::EPSILON * size;
        Step { newton, is_settled: complex::norm(value) <= rounding }
    }

    /// With values in twice the digits.
    pub(super) fn accurate_step(&self, place: Complex) -> Step {
        let (newton, value, size) = self.newton(place, compensated);
        Step { newton, is_settled: complex::norm(value) <= self.compensated_rounding(size) }
    }

    /// |p| at a place, or |p / zⁿ| outside the unit circle, with all that rounding may hide.
    pub(super) fn residual(&self, place: Complex) -> f64 {
        let (_, value, size) = self.newton(place, compensated);
        complex::norm(value) * (1.0 + f64::EPSILON) + self.compensated_rounding(size)
    }

    /// Whether the value is no more than rounding of each coefficient could make it.
    pub(super) fn may_vanish_at(&self, place: Complex) -> bool {
        let (_, value, size) = self.newton(place, compensated);
        complex::norm(value) <= 2.0 * (self.degree + 1) as f64 * f64::EPSILON * size
    }

    /// Graillat & Langlois's bound, for complex places.
    fn compensated_rounding(&self, size: f64) -> f64 {
        let unit = 8.0 * self.degree as f64 * f64::EPSILON;
        unit * unit * size
    }
}

/// Value of a polynomial, highest power first, with nearly all its digits: in twice the digits where plain ones lose some.
pub(crate) fn accurate_value(coefficients: &[f64], at: Complex) -> Complex {
    /// Share of a value that rounding may be.
    const ENOUGH: f64 = 1e-14;
    let Value { value, size, .. } = plain(coefficients, at);
    let is_enough = f64::EPSILON * size <= ENOUGH * complex::norm(value);
    if is_enough { value } else { compensated(coefficients, at).value }
}

fn plain(coefficients: &[f64], at: Complex) -> Value {
    let norm = complex::norm(at);
    let start = Value { value: Complex::ZERO, derivative: Complex::ZERO, size: 0.0 };
    coefficients.iter().fold(start, |sum, &c| Value {
        derivative: sum.derivative * at + sum.value,
        value: sum.value * at + c,
        size: sum.size * norm + c.abs(),
    })
}

/// The same in twice the digits; the derivative only where plain digits leave less than three of it.
fn compensated(coefficients: &[f64], at: Complex) -> Value {
    /// Share of a derivative that rounding may be: a Newton step needs no more.
    const ENOUGH: f64 = 1e-3;
    let found = compensated_value(coefficients, at);
    let degree = coefficients.len() as f64;
    let rounding = degree * degree * f64::EPSILON * found.size;
    if rounding <= ENOUGH * complex::norm(found.derivative) * complex::norm(at) {
        return found;
    }
    Value { derivative: compensated_derivative(coefficients, at), ..found }
}

/// Horner's scheme that also sums what each rounding lost (Graillat & Langlois, *Compensated Horner scheme in complex floating
/// point arithmetic*, 2008).
fn compensated_value(coefficients: &[f64], at: Complex) -> Value {
    let Value { mut value, derivative, size } = plain(&[], at);
    let (mut derivative, mut size, mut lost) = (derivative, size, Complex::ZERO);
    let norm = complex::norm(at);
    for &c in coefficients {
        derivative = derivative * at + value;
        size = size * norm + c.abs();
        let (next, rounded) = multiplied_and_added(value, at, c.into());
        value = next;
        lost = lost * at + rounded;
    }
    Value { value: value + lost, derivative, size }
}

/// The derivative by the same scheme: what the value lost is missing in the derivative, too.
fn compensated_derivative(coefficients: &[f64], at: Complex) -> Complex {
    let (mut value, mut lost) = (Complex::ZERO, Complex::ZERO);
    let (mut derivative, mut derivative_lost) = (Complex::ZERO, Complex::ZERO);
    for &c in coefficients {
        let (next, rounded) = multiplied_and_added(derivative, at, value);
        derivative = next;
        derivative_lost = derivative_lost * at + rounded + lost;
        let (next, rounded) = multiplied_and_added(value, at, c.into());
        value = next;
        lost = lost * at + rounded;
    }
    derivative + derivative_lost
}

/// a · b + c and what rounding lost of it.
fn multiplied_and_added(a: Complex, b: Complex, c: Complex) -> (Complex, Complex) {
    let (rr, rr_lost) = product(a.re, b.re);
    let (ii, ii_lost) = product(a.im, b.im);
    let (ri, ri_lost) = product(a.re, b.im);
    let (ir, ir_lost) = product(a.im, b.re);
    let (difference, difference_lost) = sum(rr, -ii);
    let (re, re_lost) = sum(difference, c.re);
    let (cross, cross_lost) = sum(ri, ir);
    let (im, im_lost) = sum(cross, c.im);
    let lost =
        Complex::new(rr_lost - ii_lost + difference_lost + re_lost, ri_lost + ir_lost + cross_lost + im_lost);
    (Complex::new(re, im), lost)
}

/// a + b and what rounding lost of it (Knuth).
fn sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// a · b and what rounding lost of it (Dekker, Veltkamp).
fn product(a: f64, b: f64) -> (f64, f64) {
    let halves = |x: f64| {
        const SPLIT: f64 = 134_217_729.0; // 2²⁷ + 1
        let high = SPLIT * x - (SPLIT * x - x);
        (high, x - high)
    };
    let product = a * b;
    let ((ah, al), (bh, bl)) = (halves(a), halves(b));
    (product, ((ah * bh - product) + ah * bl + al * bh) + al * bl)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_compensated_value_has_all_its_digits() {
        // (z − 1)⁸ a little beside 1: plain values are noise there
        let coefficients = [1.0, -8.0, 28.0, -56.0, 70.0, -56.0, 28.0, -8.0, 1.0];
        let at = Complex::new(1.0 + 1e-3, 0.0);
        let truth = (at.re - 1.0).powi(8);
        let value = compensated(&coefficients, at).value.re;
        assert!((value - truth).abs() < 1e-6 * truth, "{value:e} {truth:e}");
        let derivative = compensated(&coefficients, at).derivative.re;
        assert!((derivative / (8e3 * truth) - 1.0).abs() < 1e-6, "{derivative:e}");
    }
}
