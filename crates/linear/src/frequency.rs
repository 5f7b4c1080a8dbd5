use std::f64::consts::{PI, TAU};

use crate::{Complex, Time, TransferFunction};

/// What a system makes of sines: amplified by the absolute value, shifted by the argument.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrequencyResponse {
    /// Angular frequencies, rad/s, rising.
    pub rad_s: Vec<f64>,
    /// The transfer function there.
    pub values: Vec<Complex>,
    /// Phase, rad, without jumps: it says how often the value has turned round.
    pub phases_rad: Vec<f64>,
}

impl TransferFunction {
    /// At each of these frequencies, rad/s.
    pub fn frequency_response(&self, rad_s: Vec<f64>) -> FrequencyResponse {
        let values: Vec<Complex> = rad_s.iter().map(|&w| self.at(self.time().at_frequency(w))).collect();
        let first = rad_s.first().map_or(0.0, |&w| self.phase(w));
        let mut phases_rad = Vec::with_capacity(values.len());
        let mut last = first;
        for value in &values {
            let turned = value.arg() - last;
            last += turned - TAU * (turned / TAU).round();
            phases_rad.push(last);
        }
        FrequencyResponse { rad_s, values, phases_rad }
    }

    /// Phase at a frequency, rad, as the sum of what each zero and pole turns: a double integrator has −π, not π.
    pub fn phase(&self, rad_s: f64) -> f64 {
        let time = self.time();
        let at = time.at_frequency(rad_s);
        // seen from the place where nothing changes, so that what is stable turns by less than half a turn
        let turned = |root: &Complex| match time {
            Time::Continuous if root.re > 0.0 => (root - at).arg(),
            Time::Sampled(_) if root.norm_sqr() > 1.0 => (root - at).arg(),
            _ => (at - root).arg(),
        };
        let negative = |root: &&Complex| match time {
            Time::Continuous => root.re > 0.0,
            Time::Sampled(_) => root.norm_sqr() > 1.0 && root.re > 0.0,
        };
        let (zeros, poles) = (self.zeros(), self.poles());
        let swaps = zeros.iter().chain(&poles).filter(negative).count();
        let sign = if swaps % 2 == 1 { -self.numerator().leading() } else { self.numerator().leading() };
        let own = if sign < 0.0 { -PI } else { 0.0 };
        own + zeros.iter().map(turned).sum::<f64>() - poles.iter().map(turned).sum::<f64>()
    }

    /// Slope of ln G over the frequency: its real part is that of ln |G|, its imaginary part that of the phase, s.
    pub(crate) fn logarithmic_slope(&self, rad_s: f64) -> Complex {
        let at = self.time().at_frequency(rad_s);
        let share = |p: &crate::Polynomial| p.derivative().at(at) / p.at(at);
        let by_variable = share(self.numerator()) - share(self.denominator());
        by_variable
            * match self.time() {
                Time::Continuous => Complex::I,
                Time::Sampled(period_s) => Complex::I * period_s * at,
            }
    }

    /// From a decade below the slowest to a decade above the fastest that poles and zeros are, rad/s: what a plot has to show.
    pub fn band(&self) -> (f64, f64) {
        let sizes = || {
            let roots = self.zeros().into_iter().chain(self.poles());
            roots
                .map(|root| self.time().continuous(root).norm())
                .filter(|size| *size > 1e-9 && size.is_finite())
        };
        let (low, high) = (sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max));
        let (low, high) = if low.is_finite() { (low / 10.0, high * 10.0) } else { (0.1, 10.0) };
        let most = self.time().nyquist_rad_s();
        (low.min(most / 100.0), high.min(most))
    }

    /// First frequency at which it is 3 dB below what it is at rest, rad/s; none of what does not rest or does not fall.
    pub fn bandwidth(&self) -> Option<f64> {
        let rest = self.dc_gain();
        if !rest.is_finite() || rest == 0.0 {
            return None;
        }
        self.scaled(std::f64::consts::SQRT_2 / rest).gain_crossings().into_iter().find(|w| *w > 0.0)
    }
}

impl FrequencyResponse {
    /// Absolute values, dB.
    pub fn magnitudes_db(&self) -> impl Iterator<Item = f64> {
        self.values.iter().map(|value| decibels(value.norm()))
    }

    /// Phases, degrees.
    pub fn phases_deg(&self) -> impl Iterator<Item = f64> {
        self.phases_rad.iter().map(|phase| phase.to_degrees())
    }
}

/// 20 log₁₀.
pub fn decibels(factor: f64) -> f64 {
    20.0 * factor.log10()
}

/// So many frequencies, evenly on a logarithmic scale, both ends included; rad/s.
pub fn logspace((from, to): (f64, f64), count: usize) -> Vec<f64> {
    let (low, span) = (from.ln(), to.ln() - from.ln());
    let last = count.saturating_sub(1).max(1) as f64;
    (0..count).map(|i| (low + span * i as f64 / last).exp()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> TransferFunction {
        TransferFunction::parse(text, Time::Continuous).unwrap()
    }

    #[test]
    fn phases_begin_where_the_poles_and_zeros_say() {
        for (text, at, degrees) in [
            ("1/s^2", 1.0, -180.0),
            ("1/s^3", 1.0, -270.0),
            ("-1", 1.0, -180.0),
            ("s/(s+1)", 1e-6, 90.0),
            ("(1-s)/(1+s)", 1e-6, 0.0),
            ("(1-s)/(1+s)", 1e6, -180.0),
            ("1/(s-1)", 1e-6, -180.0),
            ("1/(s^2+0.01s+1)^2", 10.0, -360.0),
        ] {
            let g = parse(text);
            assert!((g.phase(at).to_degrees() - degrees).abs() < 0.2, "{text}: {}", g.phase(at).to_degrees());
            let value = g.at(Complex::new(0.0, at));
            assert!(
                (Complex::from_polar(value.norm(), g.phase(at)) - value).norm() < 1e-9 * value.norm(),
                "{text}"
            );
        }
    }

    #[test]
    fn a_response_turns_without_jumps() {
        let response = parse("1000/(s (s+1)(s+2)(s^2+s+100))").frequency_response(logspace((0.01, 1e4), 400));
        assert!(response.phases_rad.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 1.0));
        let last = response.phases_deg().last().unwrap();
        assert!((last + 450.0).abs() < 1.0, "{last}");
        let slope =
            response.magnitudes_db().last().unwrap() - response.magnitudes_db().nth(399 - 66).unwrap();
        assert!((slope + 99.2).abs() < 1.0, "{slope}");
    }

    #[test]
    fn bandwidth_and_band() {
        assert!((parse("5/(s+2)").bandwidth().unwrap() - 2.0).abs() < 1e-12);
        assert_eq!(parse("1/s").bandwidth(), None);
        assert_eq!(parse("2").bandwidth(), None);
        assert_eq!(parse("1/((s+2)(s+300))").band(), (0.2, 3000.0));
        assert_eq!(parse("1/s").band(), (0.1, 10.0));
    }
}
