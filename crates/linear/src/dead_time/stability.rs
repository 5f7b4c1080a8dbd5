//! How many poles of a closed loop with a dead time grow.
//!
//! As the dead time rises from 0, poles cross the imaginary axis only at frequencies at which the open loop's gain is 1: to the right
//! where it falls there, to the left where it rises (Walton & Marshall, *Direct method for TDS stability analysis*, IEE Proc. D 134, 1987).
//! They come from infinitely far left, but for a loop whose gain is 1 or more at infinite frequency.

use std::f64::consts::TAU;

use tracelight_maths::complex;

use super::Delayed;
use crate::{Stability, Time};

/// How many poles grow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GrowingPoles {
    /// So many; the others die out.
    Count(usize),
    /// A pole is on the edge of stability, or nearer to it than rounding lets tell; so many more grow.
    Edge(usize),
    /// Infinitely many: the gain is 1 or more at infinite frequency, and there is a dead time.
    Endless,
    /// The loop answers at once and without bounds: 1 + G is zero at infinite frequency.
    Undefined,
}

impl GrowingPoles {
    /// What becomes of what the loop does by itself.
    pub const fn stability(self) -> Option<Stability> {
        match self {
            Self::Count(0) => Some(Stability::Stable),
            Self::Edge(0) => Some(Stability::Marginal),
            Self::Undefined => None,
            _ => Some(Stability::Growing),
        }
    }
}

impl Delayed {
    /// How many poles of this loop, closed by negative feedback, grow.
    pub fn closed_growing(&self) -> GrowingPoles {
        /// Share of a dead time that is rounding.
        const ROUNDING: f64 = 1e-10;
        let closed = self.rational.closed();
        if self.delay_s == 0.0 {
            return closed.map_or(GrowingPoles::Undefined, |closed| {
                let count = closed.growing_poles();
                let at_edge = closed.stability() == Stability::Marginal;
                if at_edge { GrowingPoles::Edge(count) } else { GrowingPoles::Count(count) }
            });
        }
        if gain_at_infinity(self) >= 1.0 {
            return GrowingPoles::Endless;
        }
        // with a gain below 1 at infinite frequency 1 + G is not zero there
        let Ok(closed) = closed else { return GrowingPoles::Undefined };
        let mut growing = closed.growing_poles() as i64;
        // a pole at 0 stays there
        let mut edge = self.rational.denominator().constant() + self.rational.numerator().constant() == 0.0;
        for w in self.rational.gain_crossings().into_iter().filter(|w| *w > 0.0) {
            let phase = complex::arg(-self.rational.at(Time::Continuous.at_frequency(w)));
            // the dead time that brings a pair of poles to the axis, and again each turn later
            let first = if phase < -1e-9 { phase + TAU } else { phase.max(0.0) } / w;
            let turn = TAU / w;
            let turns = (self.delay_s - first) / turn;
            edge |= (turns - turns.round()).abs() * turn <= ROUNDING * self.delay_s
                && self.delay_s >= first * (1.0 - ROUNDING);
            let times = ((self.delay_s * (1.0 - ROUNDING) - first) / turn).ceil().max(0.0) as i64;
            let falls = self.rational.logarithmic_slope(w).re < 0.0;
            growing += if falls { 2 * times } else { -2 * times };
        }
        let growing = usize::try_from(growing).unwrap_or(0);
        if edge { GrowingPoles::Edge(growing) } else { GrowingPoles::Count(growing) }
    }

    /// How many poles of the open loop grow.
    pub fn growing_poles(&self) -> usize {
        self.rational.growing_poles()
    }
}

/// The open loop's gain at infinite frequency.
pub(super) fn gain_at_infinity(of: &Delayed) -> f64 {
    match of.rational.relative_degree() {
        0 => of.rational.numerator().leading().abs(),
        excess if excess < 0 => f64::INFINITY,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use crate::Complex;
    use crate::TransferFunction;

    fn delayed(text: &str, delay_s: f64) -> Delayed {
        Delayed::new(TransferFunction::parse(text, Time::Continuous).unwrap(), delay_s).unwrap()
    }

    /// How often 1 + L turns about 0 along the imaginary axis, passing poles on it on the right: by a fine grid.
    fn counted(of: &Delayed) -> i64 {
        let value = |s: Complex| 1.0 + of.at(s);
        // a little to the right of the axis, and far up
        let (right, most, count) = (1e-4, 400.0, 400_000);
        let at = |k: i32| value(Complex::new(right, f64::from(k) / f64::from(count) * most));
        let mut turned = 0.0;
        let mut last = at(-count);
        for k in -count + 1..=count {
            let next = at(k);
            turned += complex::arg(next / last);
            last = next;
        }
        let open = of.growing_poles() as i64;
        open - (turned / TAU).round() as i64
    }

    #[test]
    fn an_integrator_bears_a_quarter_of_a_turn() {
        for (delay_s, growing) in
            [(1.0, 0), (FRAC_PI_2 - 1e-6, 0), (FRAC_PI_2 + 1e-6, 2), (8.0, 4), (14.0, 4), (14.2, 6)]
        {
            assert_eq!(delayed("1/s", delay_s).closed_growing(), GrowingPoles::Count(growing), "{delay_s}");
        }
        assert_eq!(delayed("1/s", FRAC_PI_2).closed_growing(), GrowingPoles::Edge(0));
        assert_eq!(delayed("(2s+0.5)/(s+1)", 1e-9).closed_growing(), GrowingPoles::Endless);
        assert_eq!(delayed("-1/(s+1)", 0.3).closed_growing(), GrowingPoles::Edge(0));
        assert_eq!(delayed("1/s^2", 0.1).closed_growing(), GrowingPoles::Count(2));
    }

    /// Against the argument principle.
    #[test]
    fn poles_that_grow_are_counted() {
        for text in [
            "2/(s+1)",
            "5/((s+1)(s+2))",
            "3(s+1)/(s^2+0.2s+4)",
            "4/(s-1)",
            "2.5/(s-2)",
            "8/((s-1)(s+3))",
            "0.8(s+3)/(s+1)",
            "30/(s(s^2+s+25))",
            "-2/(s+1)",
            "10(s^2+1)/((s+1)^4)",
        ] {
            for delay_s in [0.01, 0.07, 0.2, 0.45, 1.1, 2.3, 5.7] {
                let of = delayed(text, delay_s);
                assert_eq!(
                    of.closed_growing(),
                    GrowingPoles::Count(counted(&of) as usize),
                    "{text} {delay_s}"
                );
            }
        }
    }

    /// Larger dead times may calm a loop again.
    #[test]
    fn a_loop_may_be_stable_between_dead_times() {
        let stable =
            |delay_s: f64| delayed("0.5/(s^2+0.1s+1)", delay_s).closed_growing() == GrowingPoles::Count(0);
        let all: Vec<bool> = (1..80).map(|k| stable(0.1 * f64::from(k))).collect();
        let changes = all.windows(2).filter(|pair| pair[0] != pair[1]).count();
        assert!(changes >= 2 && all[0], "{all:?}");
    }
}
