use std::f64::consts::PI;

use tracelight_maths::{complex, exp, powi};

use crate::{Complex, Polynomial, Time, TransferFunction};

/// Factors on an open loop that leave its closed poles so damped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DampedGains {
    /// None above 0.
    None,
    /// This is the largest.
    UpTo(f64),
    /// All above this, without end.
    Beyond(f64),
}

impl TransferFunction {
    /// The largest factor, above 0, with which every pole of the closed loop has at least that damping, 0 to 1.
    ///
    /// A pole passes the limit where D + k N is zero on it for a real k: in continuous time the limit is a ray, and those places
    /// are roots of a polynomial, none missed; of samples it is a spiral, walked along in some thousand steps. Between two of these
    /// factors it is the same for all, and one is looked at.
    pub fn damped_gains(&self, damping: f64) -> DampedGains {
        let mut passing = match self.time() {
            Time::Continuous => self.along_ray(damping),
            Time::Sampled(_) => self.along_spiral(damping),
        };
        // where nothing changes, at infinity, and where real poles meet and part
        let at_rest = self.time().at_rest();
        passing.push(-1.0 / self.at(at_rest).re);
        if self.relative_degree() == 0 {
            passing.push(-1.0 / self.numerator().leading());
        }
        passing.extend(self.breakaways().iter().map(|breakaway| breakaway.gain));
        passing.retain(|gain| *gain > 0.0 && gain.is_finite());
        passing.sort_by(f64::total_cmp);
        let Some(&last) = passing.last() else {
            return if self.is_damped(1.0, damping) { DampedGains::Beyond(0.0) } else { DampedGains::None };
        };
        if self.is_damped(2.0 * last, damping) {
            let from = self.damped_below(&passing, damping, false);
            return DampedGains::Beyond(from.unwrap_or(0.0));
        }
        self.damped_below(&passing, damping, true).map_or(DampedGains::None, DampedGains::UpTo)
    }

    /// Of the factors at which something may change, the largest below which it is so, or is not so.
    fn damped_below(&self, passing: &[f64], damping: f64, wanted: bool) -> Option<f64> {
        let below = |i: usize| i.checked_sub(1).map_or(0.0, |i| passing[i]);
        let middle = |i: usize| 0.5 * (below(i) + passing[i]);
        // factors that are one but for rounding have nothing between them
        let is_gap = |i: usize| passing[i] - below(i) > 1e-12 * passing[i];
        let last = (0..passing.len()).rev();
        last.into_iter()
            .find(|&i| is_gap(i) && self.is_damped(middle(i), damping) == wanted)
            .map(|i| passing[i])
    }

    fn is_damped(&self, gain: f64, damping: f64) -> bool {
        let calm = |pole: Complex| {
            let s = self.time().continuous(pole);
            // a pole at z = 0 is over at once
            s.re == f64::NEG_INFINITY || (s.re < 0.0 && -s.re >= (damping - 1e-9) * complex::norm(s))
        };
        let closed = self.closed_at(gain);
        closed.degree() >= self.denominator().degree() && closed.root_values().into_iter().all(calm)
    }

    /// Factors that put a pole on the ray of that damping.
    fn along_ray(&self, damping: f64) -> Vec<f64> {
        let turn = Complex::new(-damping, (1.0 - damping * damping).sqrt());
        // N and D there, as polynomials of the distance
        let parts = |p: &Polynomial| {
            let mut power = Complex::ONE;
            let mut low_first: Vec<Complex> = Vec::new();
            for &c in p.coefficients().iter().rev() {
                low_first.push(c * power);
                power *= turn;
            }
            let part =
                |of: fn(&Complex) -> f64| Polynomial::new(low_first.iter().rev().map(of).collect::<Vec<_>>());
            (part(|z| z.re), part(|z| z.im))
        };
        let ((nr, ni), (dr, di)) = (parts(self.numerator()), parts(self.denominator()));
        let imaginary = &(&di * &nr) - &(&dr * &ni);
        let along = imaginary.roots().into_iter().map(|root| root.value);
        let along = along.filter(|r| r.re > 0.0 && r.im.abs() <= 1e-6 * r.re);
        along.map(|r| (-self.at(r.re * turn).inv()).re).collect()
    }

    /// Factors that put a pole on the spiral of that damping, from 0 to half the sampling frequency.
    fn along_spiral(&self, damping: f64) -> Vec<f64> {
        const STEPS: u32 = 4096;
        let root = (1.0 - damping * damping).sqrt();
        if root < 1e-9 {
            // real poles alone: what changes are breakaways, and what passes z = 0
            return vec![-1.0 / self.at(Complex::ZERO).re];
        }
        let place = |angle: f64| complex::from_polar(exp(-damping / root * angle), angle);
        let off = |angle: f64| self.at(place(angle)).inv().im;
        let mut found = Vec::new();
        let mut before = (0.0, 0.0);
        for k in 1..=STEPS {
            // closer where slow poles are
            let angle = PI * powi(f64::from(k) / f64::from(STEPS), 2);
            let here = (angle, off(angle));
            if before.1 * here.1 < 0.0 {
                let (mut low, mut high) = (before.0, here.0);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if off(middle) * before.1 > 0.0 { low = middle } else { high = middle }
                }
                found.push(-self.at(place(0.5 * (low + high))).inv().re);
            }
            before = here;
        }
        // its end lies on the negative real axis
        found.push(-self.at(place(PI)).inv().re);
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Discretization;

    fn parse(text: &str) -> TransferFunction {
        TransferFunction::parse(text, Time::Continuous).unwrap()
    }

    fn up_to(text: &str, damping: f64) -> f64 {
        match parse(text).damped_gains(damping) {
            DampedGains::UpTo(gain) => gain,
            other => panic!("{text}: {other:?}"),
        }
    }

    #[test]
    fn a_gain_is_chosen_by_the_damping_it_leaves() {
        // s² + 2 s + k: damping 1/√k
        for damping in [0.2, 0.5, 0.7, 0.99, 1.0] {
            let gain = up_to("1/(s(s+2))", damping);
            assert!((gain * damping * damping - 1.0).abs() < 1e-9, "{damping}: {gain}");
        }
        assert!((up_to("1/(s(s+1000))", 0.7) - 250_000.0 / 0.49).abs() < 1e-3);
        assert!((up_to("1/(s(s+1)(s+2))", 0.0) - 6.0).abs() < 1e-9);
        // damped more once its poles have come back to the axis
        assert_eq!(
            parse("(s+1)/(s(s-1))").damped_gains(1.0),
            DampedGains::Beyond(3.0 + 2.0 * 2.0_f64.sqrt())
        );
        assert_eq!(parse("1/(s+1)").damped_gains(1.0), DampedGains::Beyond(0.0));
        assert_eq!(parse("1/(s^2+1)").damped_gains(0.1), DampedGains::None);
        assert_eq!(parse("1/(s-1)^2").damped_gains(0.0), DampedGains::None);
        // of a pole that leaves to the right, and one that goes through infinity
        assert!((up_to("-1/(s+1)", 0.5) - 1.0).abs() < 1e-12);
        assert_eq!(parse("-(s+1)/(s+2)").damped_gains(0.5), DampedGains::Beyond(2.0));
    }

    /// Poles just below that gain are damped enough, just above it not.
    #[test]
    fn no_larger_gain_leaves_the_damping() {
        let open = parse("281 (s+32.9)(s+97.8)/((s+250)(s+177)) 13.16/(s(s+0.1316))");
        let sampled = open.sampled(2e-3, Discretization::ZeroOrderHold).unwrap();
        for system in [open, sampled, parse("(s^2+2s+30)/(s(s+1)(s+2)(s+50))")] {
            for damping in [0.05, 0.3, 0.6] {
                let DampedGains::UpTo(gain) = system.damped_gains(damping) else {
                    panic!("{system} {damping}: {:?}", system.damped_gains(damping))
                };
                assert!(system.is_damped(gain * (1.0 - 1e-6), damping), "{system} {damping} {gain}");
                for k in 0..200 {
                    let more = gain * (1.0 + 1e-5) * 1.05_f64.powi(k);
                    assert!(!system.is_damped(more, damping), "{system} {damping} {gain} {more}");
                }
            }
        }
    }
}
