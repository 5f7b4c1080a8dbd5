//! The largest value of what is made of frequency data, between its points and nowhere else.

use tracelight_maths::exp;

use crate::dead_time::highest;
use crate::frequency_data::data::FrequencyData;
use crate::{Complex, Peak};

/// Peaks of the points that are searched between them.
const MOST_PEAKS: usize = 64;

/// A largest value inside measured data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DataPeak {
    /// The value and where it is.
    pub peak: Peak,
    /// Where the data begin or end: beyond, it may be larger.
    pub is_at_end: bool,
}

impl FrequencyData {
    /// The largest value of a gain that is made of a frequency, rad/s, and of the data there, interpolated between points.
    pub fn highest(&self, gain: impl Fn(f64, Complex) -> f64) -> DataPeak {
        let places = self.size.places();
        let at_points: Vec<f64> =
            self.rad_s().iter().zip(self.values()).map(|(w, value)| gain(*w, *value)).collect();
        let last = places.len() - 1;
        let is_high = |&i: &usize| {
            at_points[i] >= at_points[i.saturating_sub(1)] && at_points[i] >= at_points[(i + 1).min(last)]
        };
        let mut peaks: Vec<usize> = (0..=last).filter(is_high).collect();
        peaks.sort_by(|&a, &b| at_points[b].total_cmp(&at_points[a]));
        let there = |place: f64| gain(exp(place), self.there(place));
        let mut best = (places[0], at_points[0]);
        for i in peaks.into_iter().take(MOST_PEAKS) {
            let inside = highest(there, places[i.saturating_sub(1)], places[(i + 1).min(last)]);
            for found in [(places[i], at_points[i]), (inside, there(inside))] {
                if found.1 > best.1 {
                    best = found;
                }
            }
        }
        let ends = [places[0], places[last]];
        let is_at_end = ends.iter().any(|end| (end - best.0).abs() <= 1e-9);
        DataPeak { peak: Peak { rad_s: exp(best.0), gain: best.1 }, is_at_end }
    }
}

#[cfg(test)]
mod tests {
    use tracelight_maths::complex;

    use super::*;
    use crate::{Time, TransferFunction, logspace};

    #[test]
    fn a_peak_between_points_is_found_and_one_at_an_end_is_told() {
        let open = TransferFunction::parse("1/(s(s+1)(s+2))", Time::Continuous).unwrap();
        let response = open.frequency_response(logspace((0.05, 50.0), 120));
        let data = FrequencyData::new(response.rad_s, response.values).unwrap();
        let found = data.highest(|_, value| 1.0 / complex::norm(1.0 + value));
        let modulus = open.margins().modulus.unwrap();
        assert!((found.peak.gain * modulus.distance - 1.0).abs() < 1e-6 && !found.is_at_end, "{found:?}");
        assert!((found.peak.rad_s / modulus.rad_s - 1.0).abs() < 1e-3, "{found:?}");
        assert!(data.highest(|_, value| complex::norm(value)).is_at_end);
    }
}
