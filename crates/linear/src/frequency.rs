use tracelight_maths::{complex, exp, ln, log10};

use crate::turns::Turns;
use crate::{Complex, Polynomial, Time, TransferFunction};

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
        let phases_rad = Turns::of(self).phases(&rad_s, &values);
        FrequencyResponse { rad_s, values, phases_rad }
    }

    /// Phase at a frequency, rad, as the sum of what each zero and pole turns: a double integrator has −π, not π.
    pub fn phase(&self, rad_s: f64) -> f64 {
        Turns::of(self).phase(rad_s, self.at(self.time().at_frequency(rad_s)))
    }

    /// Slope of ln G over the frequency: its real part is that of ln |G|, its imaginary part that of the phase, s.
    pub(crate) fn logarithmic_slope(&self, rad_s: f64) -> Complex {
        let at = self.time().at_frequency(rad_s);
        let share = |p: &Polynomial| p.derivative().at(at) / p.at(at);
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
                .map(|root| complex::norm(self.time().continuous(root)))
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
        self.values.iter().map(|value| decibels(complex::norm(*value)))
    }

    /// Phases, degrees.
    pub fn phases_deg(&self) -> impl Iterator<Item = f64> {
        self.phases_rad.iter().map(|phase| phase.to_degrees())
    }
}

/// 20 log₁₀.
pub fn decibels(factor: f64) -> f64 {
    20.0 * log10(factor)
}

/// So many frequencies, evenly on a logarithmic scale, both ends included; rad/s.
pub fn logspace((from, to): (f64, f64), count: usize) -> Vec<f64> {
    let (low, span) = (ln(from), ln(to) - ln(from));
    let last = count.saturating_sub(1).max(1) as f64;
    (0..count).map(|i| exp(low + span * i as f64 / last)).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

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
            ("1/(s^2+0.01s+1)^2", 10.0, -359.9),
            ("1/(s^2+0.0001s+1)^2", 10.0, -360.0),
            ("1/(s^2+1)", 0.9, 0.0),
            ("1/(s^2+1)", 1.1, -180.0),
            ("(s^2+1)/(s^2+4)", 1.5, 180.0),
            ("1/(s+1)^30", 1e6, -2700.0),
            ("1e-90/(s+1e9)^10", 1e13, -899.94),
        ] {
            let g = parse(text);
            assert!((g.phase(at).to_degrees() - degrees).abs() < 0.2, "{text}: {}", g.phase(at).to_degrees());
            let value = g.at(Complex::new(0.0, at));
            assert!(
                complex::norm(complex::from_polar(complex::norm(value), g.phase(at)) - value)
                    < 1e-9 * complex::norm(value),
                "{text}"
            );
        }
    }

    /// Resonances narrower than the grid turn the phase all the same.
    #[test]
    fn a_response_has_the_phase_of_each_of_its_frequencies() {
        for text in [
            "1/(s^2+1e-7 s+1)^2",
            "(s^2+1e-9s+1.001)^2/(s^2+1e-9s+1)^3",
            "(s^2-1e-9s+1.001)^3/((s^2+1e-9s+1)^3 (s-3))",
            "(s-1)^9/(s+1)^9",
        ] {
            let g = parse(text);
            let response = g.frequency_response(logspace((0.01, 100.0), 333));
            for (w, phase) in response.rad_s.iter().zip(&response.phases_rad) {
                assert!((g.phase(*w) - phase).abs() < 1e-9, "{text}: {w} {phase} {}", g.phase(*w));
            }
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

    /// From a place to the next there is no jump, whatever poles and zeros are inside, outside, left or right of the unit circle, and the
    /// phase is that of the value.
    #[test]
    fn a_sampled_response_turns_without_jumps() {
        let time = Time::Sampled(1e-3);
        for text in [
            "(z+1.5)/(z^2-1.9z+0.95)",
            "(z+0.8)(z-1.2)/((z-0.9)(z^2+0.5z+0.9))",
            "(z^2+2.2z+1.5)/((z+0.3)^4)",
            "1/((z-0.5)^7)",
            "(z-2)(z-3)/(z^2-3z+4)",
        ] {
            let g = TransferFunction::parse(text, time).unwrap();
            let even: Vec<f64> = (0..=4000).map(|k| PI * 1e3 * (f64::from(k) + 0.5) / 4001.0).collect();
            let response = g.frequency_response(even);
            for (phase, value) in response.phases_rad.iter().zip(&response.values) {
                assert!(
                    complex::norm(complex::from_polar(complex::norm(*value), *phase) - value)
                        < 1e-9 * complex::norm(*value),
                    "{text}"
                );
            }
            let jump =
                response.phases_rad.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
            assert!(jump < 0.1, "{text}: {jump}");
        }
        let begins = |text: &str| TransferFunction::parse(text, time).unwrap().phase(1e-3).to_degrees();
        for (text, degrees) in
            [("(z+1.5)/(z-0.5)", 0.0), ("1/(z-1)^2", -180.0), ("1/(z-1.5)", -180.0), ("(z-1)/(z+3)", 90.0)]
        {
            assert!((begins(text) - degrees).abs() < 0.01, "{text}: {}", begins(text));
        }
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
