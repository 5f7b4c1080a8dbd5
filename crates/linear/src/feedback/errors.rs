//! What an open loop says of the errors that remain once it is closed.

use tracelight_maths::powi;

use crate::{Complex, Delayed, Polynomial, Time};

/// Error constants of an open loop, for negative feedback of its output. A dead time does not change them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorConstants {
    /// How many integrators it has; less than 0 where it passes nothing that is constant.
    pub system_type: i64,
    /// Kp, the limit of L where nothing changes.
    pub position: f64,
    /// Kv, the limit of s L, of samples (z − 1) L/T, 1/s.
    pub velocity: f64,
    /// Ka, the limit of s² L, of samples (z − 1)² L/T², 1/s².
    pub acceleration: f64,
}

impl ErrorConstants {
    /// What remains of the error in the long run of a stable loop: to a step of 1, a ramp of 1 a second, and a parabola t²/2; infinite
    /// where it grows.
    pub fn remaining(&self) -> [f64; 3] {
        // without the sign that a zero may have
        [1.0 / (1.0 + self.position), 1.0 / self.velocity, 1.0 / self.acceleration].map(|error| error + 0.0)
    }
}

impl Delayed {
    /// Error constants of this open loop; none of one that is 0.
    pub fn error_constants(&self) -> Option<ErrorConstants> {
        let (rational, time) = (self.rational(), self.rational().time());
        let (zeros, above) = lowest(rational.numerator(), time)?;
        let (poles, below) = lowest(rational.denominator(), time)?;
        let system_type = poles - zeros;
        let period_s = match time {
            Time::Continuous => 1.0,
            Time::Sampled(period_s) => period_s,
        };
        // L is so much over s to the power of the type
        let constant = above / below / powi(period_s, i32::try_from(system_type).ok()?);
        let of = |power: i64| match system_type.cmp(&power) {
            std::cmp::Ordering::Less => 0.0,
            std::cmp::Ordering::Equal => constant,
            std::cmp::Ordering::Greater => f64::INFINITY.copysign(constant),
        };
        Some(ErrorConstants { system_type, position: of(0), velocity: of(1), acceleration: of(2) })
    }
}

/// The lowest power of s, of samples of z − 1, that a polynomial has, and its coefficient; none of 0.
fn lowest(polynomial: &Polynomial, time: Time) -> Option<(i64, f64)> {
    if time == Time::Continuous {
        let power = (0..=polynomial.degree()).find(|&power| polynomial.coefficient(power) != 0.0)?;
        return Some((power as i64, polynomial.coefficient(power)));
    }
    let mut derived = polynomial.clone();
    for power in 0..=polynomial.degree() {
        if derived.is_zero() {
            return None;
        }
        if !derived.may_vanish_at(Complex::ONE) {
            return Some((power as i64, derived.value(1.0)));
        }
        derived = derived.derivative().scaled(1.0 / (power + 1) as f64);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Discretization, TransferFunction};

    fn constants(open: &TransferFunction) -> ErrorConstants {
        Delayed::from(open.clone()).error_constants().unwrap()
    }

    /// Limits by hand, as Franklin, Powell & Emami-Naeini, *Feedback Control of Dynamic Systems*, table 4.1, has them.
    #[test]
    fn constants_are_those_of_the_textbook() {
        let infinite = f64::INFINITY;
        for (text, expected, remaining) in [
            ("6/((s+1)(s+2))", (0, 3.0, 0.0, 0.0), [0.25, infinite, infinite]),
            ("6 (s+5)/(s (s+2)(s+3))", (1, infinite, 5.0, 0.0), [0.0, 0.2, infinite]),
            ("8 (s+1)/(s^2 (s+4))", (2, infinite, infinite, 2.0), [0.0, 0.0, 0.5]),
            ("8 (s+1)^2/(s^3 (s+4))", (3, infinite, infinite, infinite), [0.0, 0.0, 0.0]),
            ("3 s/(s+1)", (-1, 0.0, 0.0, 0.0), [1.0, infinite, infinite]),
            // a zero takes an integrator back
            ("3 s/(s (s+1))", (0, 3.0, 0.0, 0.0), [0.25, infinite, infinite]),
        ] {
            let found = constants(&TransferFunction::parse(text, Time::Continuous).unwrap());
            let (system_type, position, velocity, acceleration) = expected;
            assert_eq!(found, ErrorConstants { system_type, position, velocity, acceleration }, "{text}");
            assert_eq!(found.remaining(), remaining, "{text}");
        }
        let nothing = TransferFunction::gain(0.0, Time::Continuous);
        assert_eq!(Delayed::from(nothing).error_constants(), None);
    }

    /// A hold leaves them as they are.
    #[test]
    fn samples_have_the_constants_of_what_is_sampled() {
        for text in ["6/((s+1)(s+2))", "6 (s+5)/(s (s+2)(s+3))", "8 (s+1)/(s^2 (s+4))"] {
            let open = TransferFunction::parse(text, Time::Continuous).unwrap();
            let (here, there) =
                (constants(&open), constants(&open.sampled(0.01, Discretization::ZeroOrderHold).unwrap()));
            assert_eq!(here.system_type, there.system_type, "{text}");
            for (a, b) in here.remaining().into_iter().zip(there.remaining()) {
                assert!(a == b || (a / b - 1.0).abs() < 1e-6, "{text}: {a} {b}");
            }
        }
    }
}
