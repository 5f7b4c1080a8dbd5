//! Margins, bandwidth and resonance of frequency data, between its points and nowhere else.

use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

use tracelight_maths::{complex, exp, ln};

use crate::frequency_data::data::FrequencyData;
use crate::golden::lowest;
use crate::{Complex, GainMargin, Margins, ModulusMargin, Peak, PhaseMargin};

/// Places near −1 that are searched between points.
const MOST_NEAR: usize = 64;

impl FrequencyData {
    /// Margins of this open loop, of its crossings inside the data: whether the closed loop is stable is not in them, see
    /// [`unstable_when_closed`](Self::unstable_when_closed). The modulus margin is the least inside the data.
    pub fn margins(&self) -> Margins {
        let is_real = |value: &Complex| value.im.abs() <= 1e-12 * value.re.abs();
        let is_one = |value: &Complex| (complex::norm(*value) - 1.0).abs() <= 1e-12;
        let is_always_real = self.values().iter().all(is_real);
        let is_always_one = self.values().iter().all(is_one);
        Margins {
            gain: if is_always_real { Vec::new() } else { self.gain_margins() },
            phase: if is_always_one { Vec::new() } else { self.phase_margins() },
            modulus: Some(self.modulus_margin()),
            is_always_real,
            is_always_one,
        }
    }

    /// The first frequency at which the gain is 3 dB below what it is at rest, rad/s: at frequency 0, or where the data begin if they
    /// are level there (less than 0.1 dB from the first point to the second, and less than 1 dB a decade). None otherwise, and none
    /// that lies outside the data.
    pub fn bandwidth(&self) -> Option<f64> {
        let rest = match self.at_rest() {
            Some(gain) => ln(gain.abs()),
            None => {
                let sizes = self.size.values();
                let (rise, width) = (sizes[1] - sizes[0], self.size.places()[1] - self.size.places()[0]);
                let is_level = rise.abs() < 0.1 / DECIBELS && (rise / width).abs() < 0.05;
                is_level.then_some(sizes[0])?
            }
        };
        rest.is_finite().then(|| self.size.crossings(rest + ln(FRAC_1_SQRT_2)).next())?.map(exp)
    }

    /// The largest gain, where it is inside the data; none where it is at an end, and may be beyond it.
    pub fn resonance(&self) -> Option<Peak> {
        let sizes = self.size.values();
        let highest = (0..sizes.len()).max_by(|&a, &b| sizes[a].total_cmp(&sizes[b]))?;
        if highest == 0 || highest == sizes.len() - 1 {
            return None;
        }
        let pieces = [highest - 1, highest].map(|number| self.size.piece(number));
        let tops = pieces.iter().flat_map(|piece| {
            piece.turns().into_iter().map(|share| (piece.from + share * piece.width, piece.at(share)))
        });
        let (place, size) = tops.max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(Peak { rad_s: exp(place), gain: exp(size) })
    }

    fn phase_margins(&self) -> Vec<PhaseMargin> {
        let margin = |place: f64| {
            let rad_s = exp(place);
            let turned = self.phase.at(place) + PI;
            let phase_rad = turned - TAU * ((turned - PI) / TAU).ceil();
            let late = if phase_rad < 0.0 { phase_rad + TAU } else { phase_rad };
            PhaseMargin { rad_s, phase_rad, delay_s: late / rad_s }
        };
        self.size.crossings(0.0).map(margin).collect()
    }

    fn gain_margins(&self) -> Vec<GainMargin> {
        let mut found = Vec::new();
        for number in 0..self.rad_s().len() - 1 {
            let (low, high) = self.phase.piece(number).range();
            // every odd multiple of π that it passes
            let (first, last) =
                (((low / PI - 1.0) / 2.0).ceil() as i64, ((high / PI - 1.0) / 2.0).floor() as i64);
            for turn in first..=last {
                let level = (2 * turn + 1) as f64 * PI;
                found.extend(self.phase.piece_crossings(number, level));
            }
        }
        found.sort_by(f64::total_cmp);
        found
            .into_iter()
            .map(|place| GainMargin { rad_s: exp(place), factor: exp(-self.size.at(place)) })
            .collect()
    }

    fn modulus_margin(&self) -> ModulusMargin {
        let distance = |place: f64| complex::norm(1.0 + self.there(place));
        let places = self.size.places();
        let at_points: Vec<f64> = self.values().iter().map(|value| complex::norm(1.0 + value)).collect();
        let last = places.len() - 1;
        let is_low = |&i: &usize| {
            at_points[i] <= at_points[i.saturating_sub(1)] && at_points[i] <= at_points[(i + 1).min(last)]
        };
        let mut lows: Vec<usize> = (0..=last).filter(is_low).collect();
        lows.sort_by(|&a, &b| at_points[a].total_cmp(&at_points[b]));
        let mut best = (places[0], at_points[0]);
        for i in lows.into_iter().take(MOST_NEAR) {
            let own = (places[i], at_points[i]);
            let ends = [(i.saturating_sub(1), i), (i, (i + 1).min(last))];
            let inside = ends.map(|(from, to)| lowest(&distance, (places[from], places[to]), SECTIONS));
            for found in [own].into_iter().chain(inside) {
                if found.1 < best.1 {
                    best = found;
                }
            }
        }
        ModulusMargin { rad_s: exp(best.0), distance: best.1 }
    }
}

/// Sections of a search: to half the digits, as further on rounding decides.
const SECTIONS: usize = 45;

/// Of 1 in ln.
const DECIBELS: f64 = 20.0 / std::f64::consts::LN_10;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Time, TransferFunction, logspace};

    fn of(text: &str, band: (f64, f64), count: usize) -> (TransferFunction, FrequencyData) {
        let g = TransferFunction::parse(text, Time::Continuous).unwrap();
        let response = g.frequency_response(logspace(band, count));
        (g, FrequencyData::new(response.rad_s, response.values).unwrap())
    }

    const LOOPS: [&str; 7] = [
        "1/(s(s+1)(s+2))",
        "30 (s+1)^2 / (s^3 (1 + s/50)^2)",
        "40/(s (s+2)(s+8))",
        "25/(s^3+10s^2+10s+10)",
        "1/(s+1)^5",
        "4 (1 - 0.1 s)/(s (1 + 0.1 s)(1 + 0.5 s))",
        "8/((s+1)(s+2)(s+3)) (s+9)",
    ];

    /// Errors of what is interpolated against what is exact, at 10 and at 40 points a decade: of gain margins (shares of the factor and of
    /// the frequency), of phase margins (degrees, share), of the modulus margin (share).
    #[test]
    fn margins_are_those_of_the_system_the_data_are_of() {
        for (count, most) in [(50, [1e-4, 5e-5, 1e-2, 1e-4, 1e-3]), (200, [5e-7, 5e-7, 5e-5, 5e-7, 1e-6])] {
            for text in LOOPS {
                let off = errors(text, count);
                let is_good = off.iter().zip(most).all(|(off, most)| *off <= most);
                assert!(is_good, "{count} points, {text}: {off:?} is more than {most:?}");
            }
        }
    }

    /// A resonance of damping 0.08 is as narrow as 15 points a decade: 10 miss it, and the step of the phase says so; 40 do not.
    #[test]
    fn a_resonance_between_points_is_missed_and_the_spacing_tells() {
        let text = "10 (s+2)/(s (s^2 + s + 40))";
        let off = errors(text, 200);
        assert!(off[0] < 1e-3 && off[2] < 0.2 && off[4] < 1e-2, "{off:?}");
        let step = |count| of(text, (0.01, 1e3), count).1.spacing().phase_rad.to_degrees();
        assert!(step(50) > 60.0 && step(1000) < 15.0, "{} {}", step(50), step(1000));
    }

    fn errors(text: &str, count: usize) -> [f64; 5] {
        let (g, data) = of(text, (0.01, 1e3), count);
        let (truth, ours) = (g.margins(), data.margins());
        let inside: Vec<_> = truth.gain.iter().filter(|m| m.rad_s > 0.01 && m.rad_s < 1e3).collect();
        assert_eq!(
            (ours.gain.len(), ours.phase.len()),
            (inside.len(), truth.phase.len()),
            "{text}: {ours:?}"
        );
        let share = |a: f64, b: f64| (a / b - 1.0).abs();
        let mut most = [0.0_f64; 5];
        for (a, b) in ours.gain.iter().zip(inside) {
            most[0] = most[0].max(share(a.factor, b.factor));
            most[1] = most[1].max(share(a.rad_s, b.rad_s));
        }
        for (a, b) in ours.phase.iter().zip(&truth.phase) {
            most[2] = most[2].max((a.degrees() - b.degrees()).abs());
            most[3] = most[3].max(share(a.rad_s, b.rad_s));
        }
        most[4] = share(ours.modulus.unwrap().distance, truth.modulus.unwrap().distance);
        most
    }

    #[test]
    fn nothing_is_found_outside_the_data() {
        let (_, data) = of("1/(s(s+1)(s+2))", (0.6, 1.2), 30);
        let margins = data.margins();
        assert!(margins.gain.is_empty() && margins.phase.is_empty(), "{margins:?}");
        assert!((margins.modulus.unwrap().rad_s - 0.6).abs() < 0.6, "it is the least inside");
        assert_eq!((data.bandwidth(), data.resonance()), (None, None));
    }

    #[test]
    fn bandwidth_and_resonance_are_those_of_the_textbook() {
        let (g, data) = of("3/(s^2+0.4s+1)", (0.001, 100.0), 200);
        let (width, exact) = (data.bandwidth().unwrap(), g.bandwidth().unwrap());
        assert!((width / exact - 1.0).abs() < 1e-6, "{width} {exact}");
        let (ours, exact) = (data.resonance().unwrap(), g.peak().unwrap());
        assert!((ours.gain / exact.gain - 1.0).abs() < 1e-3, "{ours:?} {exact:?}");
        assert!((ours.rad_s / exact.rad_s - 1.0).abs() < 1e-3, "{ours:?} {exact:?}");
    }

    #[test]
    fn data_that_are_real_or_one_throughout_say_so() {
        let real =
            FrequencyData::new(vec![1.0, 2.0, 3.0], vec![2.0.into(), (-0.5).into(), (-3.0).into()]).unwrap();
        assert!(real.margins().is_always_real);
        let one = FrequencyData::new(vec![1.0, 2.0], vec![Complex::ONE, Complex::I]).unwrap();
        assert!(one.margins().is_always_one && one.margins().phase.is_empty());
    }
}
