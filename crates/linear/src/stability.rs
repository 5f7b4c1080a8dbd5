use tracelight_maths::{complex, ln};

use crate::{Complex, Polynomial, Time, TransferFunction};

/// What becomes of what a system does by itself. Worse is greater.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stability {
    /// It dies out.
    Stable,
    /// It stays, or grows no faster than powers of time: at the edge, or nearer to it than rounding lets tell.
    Marginal,
    /// It grows without end.
    Growing,
}

impl TransferFunction {
    /// What becomes of what it does by itself: of its worst pole.
    pub fn stability(&self) -> Stability {
        let of_each = stabilities(self.denominator(), self.time()).into_iter();
        of_each.map(|(_, stability)| stability).max().unwrap_or(Stability::Stable)
    }

    /// Whether it is stable once it is closed by negative feedback of its output.
    pub fn closes_stable(&self) -> bool {
        self.closed().is_ok_and(|closed| closed.stability() == Stability::Stable)
    }

    /// How many poles grow.
    pub fn growing_poles(&self) -> usize {
        let of_each = stabilities(self.denominator(), self.time()).into_iter();
        of_each.filter(|(_, stability)| *stability == Stability::Growing).count()
    }
}

/// Each root, and what becomes of what belongs to it.
///
/// It is at the edge if it may lie where the edge is nearest to it, the coefficients being off by some roundings. Many roots close
/// together may each be far off and still surely be on their side (the zero exclusion principle: Barmish, *New Tools for Robustness
/// of Linear Systems*, 1994, §4.4).
pub(crate) fn stabilities(polynomial: &Polynomial, time: Time) -> Vec<(Complex, Stability)> {
    let roots = polynomial.root_values();
    let of = |&root: &Complex| {
        let (beyond, edge) = match time {
            Time::Continuous => (root.re, Complex::new(0.0, root.im)),
            Time::Sampled(_) if root == Complex::ZERO => (-1.0, Complex::ONE),
            Time::Sampled(_) => (complex::norm(root) - 1.0, root / complex::norm(root)),
        };
        // the value there, were those that are nearer no nearer than it: another root at the edge does not bring it there
        let away = complex::norm(root - edge);
        let factor = |other: &Complex| ln(complex::norm(other - edge).max(away));
        let value = ln(polynomial.leading().abs()) + roots.iter().map(factor).sum::<f64>();
        let side = if beyond < 0.0 { Stability::Stable } else { Stability::Growing };
        // what is no number compares as neither
        let is_off = value > polynomial.rounding_ln(edge);
        (root, if is_off { side } else { Stability::Marginal })
    };
    roots.iter().map(of).collect()
}

impl Polynomial {
    /// ln of what roundings of all coefficients may make of a value of 0 at a place.
    fn rounding_ln(&self, at: Complex) -> f64 {
        let size = ln(complex::norm(at));
        let term = |(c, power): (&f64, f64)| ln(c.abs()) + if power > 0.0 { power * size } else { 0.0 };
        let most = self.coefficients().iter().rev().zip((0..).map(f64::from)).map(term);
        let count = self.coefficients().len() as f64;
        most.fold(f64::NEG_INFINITY, f64::max) + ln(2.0 * count * f64::EPSILON)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stable_is_what_rounding_cannot_make_grow() {
        for (text, expected) in [
            ("1/(s+1)", Stability::Stable),
            ("1/(s+1)^12", Stability::Stable),
            ("1/(s+1)^40", Stability::Stable),
            ("1/(s-1)^12", Stability::Growing),
            ("1/s", Stability::Marginal),
            ("1/(s^2+2)", Stability::Marginal),
            ("(1/(s^2+2) + 3/(s^2+7)) 2/(s+3)", Stability::Marginal),
            ("1/(s-1e-9)", Stability::Growing),
            ("1/((s+1e-6)(s+1e6))", Stability::Stable),
            ("1/((s+1e-150)(s+1e150))", Stability::Stable),
            ("7", Stability::Stable),
        ] {
            let g = TransferFunction::parse(text, Time::Continuous).unwrap();
            assert_eq!(g.stability(), expected, "{text}");
        }
        for (text, expected) in [
            ("1/z^3", Stability::Stable),
            ("1/(z-1)", Stability::Marginal),
            ("1/(z^2-1.2z+1)", Stability::Marginal),
            ("1/(z+1.0001)", Stability::Growing),
            ("1/(z-0.9)^6", Stability::Stable),
        ] {
            let g = TransferFunction::parse(text, Time::Sampled(0.1)).unwrap();
            assert_eq!(g.stability(), expected, "{text}");
        }
    }

    #[test]
    fn a_pole_at_the_edge_does_not_make_others_marginal() {
        let g =
            TransferFunction::parse("1/(s^2 (s+1)(s+2)(s-3)((s+1)^2+25)(s^2+25))", Time::Continuous).unwrap();
        let count = |what: Stability| {
            stabilities(g.denominator(), g.time()).iter().filter(|(_, stability)| *stability == what).count()
        };
        assert_eq!([Stability::Stable, Stability::Marginal, Stability::Growing].map(count), [4, 4, 1]);
    }

    #[test]
    fn an_integrator_stays_one_when_it_is_sampled() {
        let g = TransferFunction::parse(
            "281 (s+33)(s+98)/((s+250)(s+177)) 13.16/(s(s+0.1316))",
            Time::Continuous,
        );
        let sampled = g.unwrap().sampled(1e-3, crate::Discretization::ZeroOrderHold).unwrap();
        assert_eq!((sampled.stability(), sampled.dc_gain()), (Stability::Marginal, f64::INFINITY));
        assert_eq!(sampled.bandwidth(), None);
        let closed = sampled.closed().unwrap();
        assert_eq!((closed.stability(), closed.growing_poles()), (Stability::Stable, 0));
        assert!((closed.dc_gain() - 1.0).abs() < 1e-6);
    }
}
