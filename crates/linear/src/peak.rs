use tracelight_maths::complex;

use crate::TransferFunction;
use crate::margins::{Along, square};
use crate::stability::Stability;

/// Where a system amplifies sines most: its H∞ norm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Frequency, rad/s; infinite where it is at the very end.
    pub rad_s: f64,
    /// By how much.
    pub gain: f64,
}

impl TransferFunction {
    /// The largest absolute value over all frequencies, the H∞ norm of what is stable; none of what is not, or has more zeros than poles.
    ///
    /// Where the square of the value neither rises nor falls is a root of a polynomial: none is missed between grid points.
    pub fn peak(&self) -> Option<Peak> {
        if self.stability() != Stability::Stable || self.relative_degree() < 0 {
            return None;
        }
        let along = Along::of(self);
        let (above, below) = (square(&along.above), square(&along.below));
        let flat = &(&above.derivative() * &below) - &(&above * &below.derivative());
        let end = self.time().nyquist_rad_s();
        let gain = |rad_s: f64| match rad_s {
            w if w.is_infinite() && self.relative_degree() > 0 => 0.0,
            w if w.is_infinite() => self.numerator().leading().abs(),
            w => complex::norm(self.value(w)),
        };
        let places = [0.0, end].into_iter().chain(along.frequencies(&flat));
        let peaks = places.map(|rad_s| Peak { rad_s, gain: gain(rad_s) });
        peaks.max_by(|a, b| a.gain.total_cmp(&b.gain))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Time;

    fn peak(text: &str) -> Option<Peak> {
        TransferFunction::parse(text, Time::Continuous).unwrap().peak()
    }

    #[test]
    fn a_resonance_amplifies_as_the_textbook_says() {
        // 1 / (2 ζ √(1 − ζ²)) at ω √(1 − 2 ζ²)
        let (w, zeta) = (20.0_f64, 0.1_f64);
        let found = peak("400/(s^2+4s+400)").unwrap();
        assert!((found.gain - 0.5 / (zeta * (1.0 - zeta * zeta).sqrt())).abs() < 1e-12, "{found:?}");
        assert!((found.rad_s - w * (1.0 - 2.0 * zeta * zeta).sqrt()).abs() < 1e-9, "{found:?}");
        // so narrow that no grid sees it
        let narrow = peak("1/((s+1)(s^2+2e-9s+1))").unwrap();
        assert!((narrow.gain / (0.5e9 / 2.0_f64.sqrt()) - 1.0).abs() < 1e-6, "{narrow:?}");
    }

    #[test]
    fn ends_count_and_what_grows_has_none() {
        assert_eq!(peak("3/(s+1)").unwrap(), Peak { rad_s: 0.0, gain: 3.0 });
        assert_eq!(peak("5s/(s+1)").unwrap(), Peak { rad_s: f64::INFINITY, gain: 5.0 });
        assert_eq!((peak("1/s"), peak("1/(s-1)"), peak("s^2/(s+1)")), (None, None, None));
        let sampled = TransferFunction::parse("0.1/(z+0.9)", Time::Sampled(0.1)).unwrap().peak().unwrap();
        assert!(
            (sampled.gain - 1.0).abs() < 1e-12 && (sampled.rad_s - std::f64::consts::PI * 10.0).abs() < 1e-9
        );
    }

    /// One over the sensitivity's peak is the modulus margin.
    #[test]
    fn a_sensitivity_peaks_at_the_modulus_margin() {
        let open = TransferFunction::parse(
            "281 (s+32.9)(s+97.8)/((s+250)(s+177)) 13.16/(s(s+0.1316))",
            Time::Continuous,
        );
        let open = open.unwrap();
        let sensitivity = TransferFunction::gain(1.0, Time::Continuous).feedback(&open).unwrap();
        let (peak, margin) = (sensitivity.peak().unwrap(), open.margins().modulus.unwrap());
        assert!(
            (peak.gain * margin.distance - 1.0).abs() < 1e-10
                && (peak.rad_s / margin.rad_s - 1.0).abs() < 1e-6
        );
    }
}
