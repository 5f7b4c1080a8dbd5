//! Curves of a system with a dead time: Nyquist's, and what its closed loop makes of sines.

use std::f64::consts::PI;

use tracelight_maths::{complex, powf};

use super::search::{highest, turned};
use super::stability::gain_at_infinity;
use super::{Delayed, GrowingPoles};
use crate::{
    Complex, FrequencyResponse, GainMargin, InfiniteArc, NyquistCurve, NyquistPart, Peak, RealCrossing,
    TransferFunction,
};

/// Where the open loop's gain is below this share of 1, turns are no longer followed.
const SMALL: f64 = 1e-3;
/// Turn from value to value, rad.
const TURN: f64 = 0.05;
/// Values of a curve.
const MOST_VALUES: usize = 40_000;

impl Delayed {
    /// Nyquist's curve, as [`TransferFunction::nyquist_curve`]: that of the rational part, turned by the dead time.
    pub fn nyquist_curve(&self, level: f64, tolerance: f64) -> NyquistCurve {
        let mut curve = self.rational.nyquist_curve(level, tolerance);
        let frequencies = |part: &NyquistPart| match part {
            NyquistPart::Finite { rad_s, .. } => Some((*rad_s.first()?, *rad_s.last()?)),
            NyquistPart::Arc(_) => None,
        };
        let bands: Vec<_> = curve.parts.iter().map(frequencies).collect();
        for (i, part) in curve.parts.iter_mut().enumerate() {
            match part {
                NyquistPart::Finite { rad_s, values } => {
                    *rad_s = self.denser(rad_s);
                    *values = rad_s.iter().map(|w| self.end_value(*w)).collect();
                }
                NyquistPart::Arc(arc) => {
                    let before = i.checked_sub(1).and_then(|i| bands[i]).map_or(0.0, |band| band.1);
                    let after = bands.get(i + 1).copied().flatten().map_or(before, |band| band.0);
                    self.turn(arc, before, after);
                }
            }
        }
        curve
    }

    /// Turns an arc from one frequency to another as the dead time does.
    fn turn(&self, arc: &mut InfiniteArc, from: f64, to: f64) {
        if arc.rad_s == 0.0 {
            // from the mirror of its end
            arc.from_rad += to * self.delay_s;
            arc.by_rad -= 2.0 * to * self.delay_s;
        } else if arc.rad_s.is_finite() {
            arc.from_rad -= from * self.delay_s;
            arc.by_rad -= (to - from) * self.delay_s;
        }
    }

    fn end_value(&self, rad_s: f64) -> Complex {
        match rad_s {
            0.0 => self.rational.dc_gain().into(),
            w if w.is_infinite() => Complex::ZERO,
            w => self.at_frequency(w),
        }
    }

    /// These frequencies, and so many between them that the dead time turns little from one to the next, as long as anything is seen of it.
    fn denser(&self, rad_s: &[f64]) -> Vec<f64> {
        let mut all: Vec<f64> = Vec::with_capacity(rad_s.len());
        for pair in rad_s.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            all.push(from);
            if from == 0.0 || to.is_infinite() {
                continue;
            }
            let gain = complex::norm(self.rational.at(Complex::new(0.0, from)));
            let few = if gain < SMALL { 1.0 } else { ((to - from) * self.delay_s / TURN).ceil().max(1.0) };
            let count = (few as usize).min(MOST_VALUES.saturating_sub(all.len()).max(1));
            let between = (1..count).map(|k| from * powf(to / from, k as f64 / count as f64));
            // evenly in frequency where the turn is what counts
            let even = (1..count).map(|k| from + (to - from) * k as f64 / count as f64);
            if to > 2.0 * from { all.extend(even) } else { all.extend(between) }
        }
        all.extend(rad_s.last().filter(|last| last.is_finite() || gain_at_infinity(self) == 0.0));
        all
    }

    /// Where the value is real and finite, the lowest frequency first; of infinitely many the first ones.
    pub fn real_crossings(&self) -> Vec<RealCrossing> {
        let of = |gain: Vec<GainMargin>, sign: f64| {
            let finite = gain.into_iter().filter(|margin| margin.rad_s.is_finite());
            finite
                .map(|margin| RealCrossing { rad_s: margin.rad_s, value: sign / margin.factor })
                .collect::<Vec<_>>()
        };
        let mut all = of(self.gain_margins(), -1.0);
        all.extend(of(self.scaled(-1.0).gain_margins(), 1.0));
        all.sort_by(|a, b| a.rad_s.total_cmp(&b.rad_s));
        all
    }

    /// The value of the loop closed by negative feedback at a frequency, rad/s.
    pub fn closed_at_frequency(&self, rad_s: f64) -> Complex {
        let open = self.at_frequency(rad_s);
        if open.is_finite() { open / (1.0 + open) } else { Complex::ONE }
    }

    /// What the closed loop makes of sines at each of these frequencies, rad/s, which rise; its phase is followed from the first.
    pub fn closed_frequency_response(&self, rad_s: Vec<f64>) -> FrequencyResponse {
        /// Values between two frequencies that the phase is followed by.
        const MOST_BETWEEN: f64 = 1000.0;
        let values: Vec<Complex> = rad_s.iter().map(|w| self.closed_at_frequency(*w)).collect();
        let mut phases_rad = Vec::with_capacity(values.len());
        for (i, value) in values.iter().enumerate() {
            let phase = match i.checked_sub(1) {
                None => complex::arg(*value),
                Some(before) => {
                    let (from, to) = (rad_s[before], rad_s[i]);
                    let count = ((to - from) * self.delay_s / 0.2).ceil().clamp(8.0, MOST_BETWEEN) as u32;
                    let at = |k: u32| {
                        self.closed_at_frequency(from + (to - from) * f64::from(k) / f64::from(count))
                    };
                    let turned: f64 = (1..=count).map(|k| complex::arg(at(k) / at(k - 1))).sum();
                    phases_rad[before] + turned
                }
            };
            phases_rad.push(phase);
        }
        FrequencyResponse { rad_s, values, phases_rad }
    }

    /// The largest gain of the closed loop, and where; none of a loop that is not stable, or has its largest at rest.
    pub fn closed_resonance(&self) -> Option<Peak> {
        if self.closed_growing() != GrowingPoles::Count(0) {
            return None;
        }
        let band = self.rational.band();
        let gain = |w: f64| complex::norm(self.closed_at_frequency(w));
        let grid = crate::logspace((band.0, band.1.max(20.0 * PI / self.delay_s)), 20_000);
        let gains: Vec<f64> = grid.iter().map(|w| gain(*w)).collect();
        let best = (1..grid.len() - 1).max_by(|&a, &b| gains[a].total_cmp(&gains[b]))?;
        let rad_s = highest(gain, grid[best - 1], grid[best + 1]);
        let at_rest = gain(1e-9 * band.0);
        (gain(rad_s) > (1.0 + 1e-6) * at_rest).then(|| Peak { rad_s, gain: gain(rad_s) })
    }

    /// The first frequency at which the closed loop is 3 dB below what it is at rest, rad/s; none of what is not stable.
    pub fn closed_bandwidth(&self) -> Option<f64> {
        if self.closed_growing() != GrowingPoles::Count(0) {
            return None;
        }
        let band = self.rational.band();
        let at_rest = complex::norm(self.closed_at_frequency(1e-9 * band.0));
        let is_below =
            |w: &f64| complex::norm(self.closed_at_frequency(*w)) < at_rest * std::f64::consts::FRAC_1_SQRT_2;
        let grid = crate::logspace((band.0 * 1e-2, band.1.max(20.0 * PI / self.delay_s)), 20_000);
        let after = grid.iter().position(&is_below).filter(|i| *i > 0)?;
        Some(turned(|w| is_below(&w), grid[after - 1], grid[after]))
    }

    /// The system with a dead time that is a whole number of samples, by a hold or another rule.
    ///
    /// # Errors
    /// As [`TransferFunction::sampled`]; [`LinearError::Wish`](crate::LinearError::Wish) where the dead time is no whole number of samples.
    pub fn sampled(
        &self,
        period_s: f64,
        method: crate::Discretization,
    ) -> Result<TransferFunction, crate::LinearError> {
        let samples = self.delay_s / period_s;
        let whole = samples.round();
        if (samples - whole).abs() > 1e-9 * samples.max(1.0) || whole > 1000.0 {
            return Err(crate::LinearError::Wish(format!(
                "a dead time of {} s is {samples} samples; choose a --sample of which it is a whole number, at most 1000",
                self.delay_s
            )));
        }
        let now = self.rational.sampled(period_s, method)?;
        let late = crate::Polynomial::one().shifted(whole as usize);
        now.series(&TransferFunction::new(crate::Polynomial::one(), late, now.time())?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Discretization, Time};

    fn delayed(text: &str, delay_s: f64) -> Delayed {
        Delayed::new(TransferFunction::parse(text, Time::Continuous).unwrap(), delay_s).unwrap()
    }

    /// Nyquist's theorem.
    #[test]
    fn the_curve_turns_as_often_as_poles_grow() {
        for text in [
            "2/(s+1)",
            "1/s",
            "5/((s+1)(s+2))",
            "1/(s(s+1))",
            "4/(s-1)",
            "30/(s(s^2+s+25))",
            "1/s^2",
            "0.5/(s(s^2+1))",
        ] {
            for delay_s in [0.05, 0.3, 1.3, 2.9] {
                let of = delayed(text, delay_s);
                let GrowingPoles::Count(closed) = of.closed_growing() else { panic!("{text} {delay_s}") };
                let level = 1.3 * of.rational().largest_finite_gain().max(1.15);
                let found = of.nyquist_curve(level, 1e-3).turns_round(Complex::new(-1.0, 0.0));
                assert_eq!(found, of.growing_poles() as i64 - closed as i64, "{text} {delay_s}");
            }
        }
    }

    #[test]
    fn real_crossings_are_real() {
        let of = delayed("2/(s+1)", 0.7);
        let all = of.real_crossings();
        assert!(all.iter().any(|c| c.value > 0.0) && all.iter().any(|c| c.value < 0.0));
        for crossing in all {
            let value = of.end_value(crossing.rad_s);
            assert!(complex::norm(value - crossing.value) < 1e-9, "{crossing:?} {value}");
        }
    }

    #[test]
    fn a_closed_loop_has_its_peak_and_bandwidth() {
        let of = delayed("1/s", 0.9);
        let peak = of.closed_resonance().unwrap();
        let bandwidth = of.closed_bandwidth().unwrap();
        assert!((complex::norm(of.closed_at_frequency(bandwidth)).powi(2) - 0.5).abs() < 1e-9);
        for k in 1..2000 {
            assert!(complex::norm(of.closed_at_frequency(0.01 * f64::from(k))) <= peak.gain + 1e-12);
        }
        let response = of.closed_frequency_response(crate::logspace((0.01, 100.0), 50));
        assert!(response.phases_rad.last().unwrap() < &(-40.0), "{:?}", response.phases_rad.last());
        assert!(delayed("1/s", 2.0).closed_resonance().is_none());
    }

    #[test]
    fn whole_samples_are_powers() {
        let sampled = delayed("1/(s+1)", 0.3).sampled(0.1, Discretization::ZeroOrderHold).unwrap();
        assert_eq!((sampled.denominator().degree(), sampled.numerator().degree()), (4, 0));
        let refused = delayed("1/(s+1)", 0.25).sampled(0.1, Discretization::ZeroOrderHold).unwrap_err();
        assert!(refused.to_string().contains("2.5 samples"), "{refused}");
    }
}
