//! Places of a frequency response that stand out besides its margins, and of a root locus: none is read from a grid.

use tracelight_maths::complex;

use crate::margins::{Along, square};
use crate::{Complex, Peak, Time, TransferFunction};

/// Where the value is real.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RealCrossing {
    /// Frequency, rad/s.
    pub rad_s: f64,
    /// The value there.
    pub value: f64,
}

/// Where a branch of a root locus passes the edge of stability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocusCrossing {
    /// Factor on the open loop.
    pub gain: f64,
    /// Frequency, rad/s, with which the closed loop then oscillates.
    pub rad_s: f64,
    /// The pole, in the upper half plane: j times the frequency, of samples on the unit circle.
    pub pole: Complex,
    /// Whether it becomes unstable there as the factor rises; otherwise stable.
    pub leaves: bool,
}

impl TransferFunction {
    /// Where the value is real and finite, both ends included where they are, the lowest frequency first; at the ends alone of what is
    /// real everywhere.
    pub fn real_crossings(&self) -> Vec<RealCrossing> {
        let crossing = |rad_s: f64| {
            let value = self.value(rad_s);
            (value.is_finite() && value.im.abs() <= 1e-6 * complex::norm(value))
                .then_some(RealCrossing { rad_s, value: value.re })
        };
        self.real_frequencies().into_iter().filter_map(crossing).collect()
    }

    /// Frequencies above 0 at which the absolute value is that, rad/s, rising.
    pub fn frequencies_of_gain(&self, gain: f64) -> Vec<f64> {
        let scaled = self.scaled(1.0 / gain);
        scaled.gain_crossings().into_iter().filter(|w| *w > 0.0).collect()
    }

    /// Frequencies above 0 at which the absolute value is largest or smallest of those about it, rad/s, rising.
    pub fn gain_extremes(&self) -> Vec<f64> {
        let along = Along::of(self);
        let (above, below) = (square(&along.above), square(&along.below));
        along.frequencies(&(&(&above.derivative() * &below) - &(&above * &below.derivative())))
    }

    /// The resonance: the largest absolute value, where it is larger than both at rest and at infinite frequency, and finite; none of
    /// what is not stable, or has no such peak.
    pub fn resonance(&self) -> Option<Peak> {
        let peak = self.peak()?;
        let end = self.time().nyquist_rad_s();
        let stands_out = peak.gain > (1.0 + 1e-9) * self.dc_gain().abs();
        (peak.rad_s > 0.0 && peak.rad_s < end && stands_out).then_some(peak)
    }

    /// Where branches of the root locus pass the edge of stability as the factor rises from 0, the smallest factor first.
    pub fn locus_crossings(&self) -> Vec<LocusCrossing> {
        let crossing = |(gain, rad_s): (f64, f64)| {
            let pole = match rad_s {
                0.0 => self.time().at_rest(),
                w => self.time().at_frequency(w),
            };
            LocusCrossing { gain, rad_s, pole, leaves: self.leaves(gain, pole) }
        };
        let mut all: Vec<_> = self.oscillating_gains().into_iter().map(crossing).collect();
        all.sort_by(|a, b| a.gain.total_cmp(&b.gain));
        all
    }

    /// Gains that show every branch, as [`locus_gains`](Self::locus_gains) gives them, and those about every place where branches meet or
    /// pass the edge of stability, however small they are. `count` at least.
    pub fn telling_gains(&self, count: usize) -> Vec<f64> {
        /// From so much below the smallest of them.
        const BELOW: f64 = 1e-4;
        let mut gains = self.locus_gains(count);
        let meeting = self.breakaways();
        let passing = self.locus_crossings().into_iter().map(|crossing| crossing.gain);
        let told: Vec<f64> =
            meeting.iter().map(|b| b.gain).chain(passing).filter(|gain| *gain > 0.0).collect();
        let least = BELOW * told.iter().copied().fold(f64::INFINITY, f64::min);
        let first = gains.iter().copied().find(|gain| *gain > 0.0).unwrap_or(0.0);
        if least > 0.0 && least < BELOW * first {
            gains.extend(crate::logspace((least, first), count.max(2)));
        }
        // branches leave a double pole as roots do: by the square root of the gain
        let closer = |n: i32| 1.0 + f64::from(n.signum()) * tracelight_maths::powi(4.0, n.abs() - 13);
        gains.extend(told.iter().flat_map(|gain| (-12..=12).map(move |n| gain * closer(n))));
        gains.sort_by(f64::total_cmp);
        gains.dedup();
        gains
    }

    /// Whether a pole of the closed loop, at the edge of stability, goes to the unstable side as the factor rises.
    fn leaves(&self, gain: f64, pole: Complex) -> bool {
        let slope = self.denominator().derivative().at(pole) + gain * self.numerator().derivative().at(pole);
        let moves = -self.numerator().at(pole) / slope;
        match self.time() {
            Time::Continuous => moves.re > 0.0,
            Time::Sampled(_) => (moves * pole.conj()).re > 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> TransferFunction {
        TransferFunction::parse(text, Time::Continuous).unwrap()
    }

    #[test]
    fn the_real_axis_is_crossed_where_the_textbook_says() {
        // Åström & Murray, Feedback Systems, figure 10.10
        let open = parse("3(s+6)^2/(s(s+1)^2)");
        for crossing in open.real_crossings() {
            let value = open.at(Complex::new(0.0, crossing.rad_s));
            assert!(value.im.abs() < 1e-9 && (value.re - crossing.value).abs() < 1e-9, "{crossing:?}");
        }
        assert!(
            open.real_crossings().iter().any(|c| (c.value + 4.5).abs() < 1e-9),
            "{:?}",
            open.real_crossings()
        );
        // from 1 at rest through −1/8 at √3 rad/s
        let thrice = parse("1/(s+1)^3").real_crossings();
        assert_eq!(thrice[0], RealCrossing { rad_s: 0.0, value: 1.0 });
        assert!((thrice[1].value + 0.125).abs() < 1e-12 && (thrice[1].rad_s - 3.0_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn a_resonance_is_a_peak_between_the_ends() {
        let resonance = parse("400/(s^2+4s+400)").resonance().unwrap();
        assert!((resonance.gain - 0.5 / (0.1 * 0.99_f64.sqrt())).abs() < 1e-12);
        for text in ["1/(s+1)", "400/(s^2+40s+400)", "1/s", "1/(s-1)", "3", "5s/(s+1)", "1/(s^2+1)"] {
            assert_eq!(parse(text).resonance(), None, "{text}");
        }
    }

    #[test]
    fn a_gain_is_passed_where_it_is() {
        let open = parse("1/(s^2+0.1s+1)");
        let both = open.frequencies_of_gain(5.0);
        assert_eq!(both.len(), 2);
        for w in both {
            assert!((complex::norm(open.at(Complex::new(0.0, w))) - 5.0).abs() < 1e-9);
        }
        let top = open.gain_extremes();
        assert!(top.len() == 1 && (top[0] - (1.0_f64 - 0.005).sqrt()).abs() < 1e-9, "{top:?}");
    }

    #[test]
    fn gains_are_close_where_something_happens_however_small_they_are() {
        let open = parse("1/(s(s+1)(s+2)(s+10000))");
        let gains = open.telling_gains(200);
        for told in
            open.breakaways().iter().map(|b| b.gain).chain(open.locus_crossings().iter().map(|c| c.gain))
        {
            let near = gains.iter().filter(|gain| (**gain / told - 1.0).abs() < 0.3).count();
            assert!(near >= 5, "{told}: {near}");
        }
        assert!(gains.is_sorted() && gains[0] == 0.0);
    }

    #[test]
    fn a_branch_leaves_where_the_gain_is_too_large_and_comes_back_where_it_was_too_small() {
        let [only] = parse("1/(s(s+1)(s+2))").locus_crossings()[..] else { panic!("one crossing") };
        assert!((only.gain - 6.0).abs() < 1e-9 && (only.rad_s - 2.0_f64.sqrt()).abs() < 1e-9 && only.leaves);
        // conditionally stable: back, out
        let both = parse("(s+1)^2/s^3").locus_crossings();
        assert!(both.len() == 1 && !both[0].leaves && (both[0].gain - 0.5).abs() < 1e-9, "{both:?}");
        // a pole at 1.5 comes in at z = 1, goes out at −1
        let sampled = TransferFunction::parse("1/(z-1.5)", Time::Sampled(0.1)).unwrap().locus_crossings();
        let ways: Vec<(f64, bool)> = sampled.iter().map(|c| (c.pole.re, c.leaves)).collect();
        assert_eq!(ways, [(1.0, false), (-1.0, true)]);
    }
}
