//! Margins of a loop with a dead time: its gain crosses 1 where the rational part's does; its phase crosses −180° again and again.

use std::f64::consts::{PI, TAU};

use tracelight_maths::{complex, ln, powi};

use super::search::highest;
use super::stability::gain_at_infinity;
use super::{Delayed, GrowingPoles, Phases};
use crate::margins::{Along, square};
use crate::{DelayMargin, GainMargin, Margins, ModulusMargin, PhaseMargin, Polynomial};

/// Crossings of the phase that are looked for in one stretch from each of its ends: between them the gain margin is between theirs.
const MOST_CROSSINGS: i64 = 200;

impl Delayed {
    /// Margins of this open loop. Each crossing lies in a stretch in which gain and phase only rise or only fall, so that none is missed.
    pub fn margins(&self) -> Margins {
        if self.delay_s == 0.0 {
            return self.rational.margins();
        }
        let phases = Phases::of(self);
        let stretches = self.stretches();
        let rational = self.rational.margins();
        Margins {
            gain: self.gain_margins_in(&phases, &stretches),
            phase: rational.phase.iter().map(|margin| self.phase_margin(margin.rad_s)).collect(),
            modulus: self.modulus_margin(&phases, &stretches),
            is_always_real: false,
            is_always_one: rational.is_always_one,
        }
    }

    /// For how much longer this open loop, whose margins these are, may be late once it is closed.
    pub fn delay_margin(&self, margins: &Margins) -> DelayMargin {
        if self.delay_s == 0.0 {
            return self.rational.delay_margin(margins);
        }
        match (self.closed_growing(), margins.least_delay()) {
            (GrowingPoles::Count(0), Some(margin)) => {
                DelayMargin::Delay { delay_s: margin.delay_s, rad_s: margin.rad_s }
            }
            (GrowingPoles::Count(0), None) => DelayMargin::Unlimited,
            _ => DelayMargin::Unstable,
        }
    }

    fn phase_margin(&self, rad_s: f64) -> PhaseMargin {
        let phase_rad = complex::arg(-self.at_frequency(rad_s));
        let late = if phase_rad < 0.0 { phase_rad + TAU } else { phase_rad };
        PhaseMargin { rad_s, phase_rad, delay_s: late / rad_s }
    }

    /// Frequencies, rad/s, rising, between which gain and phase each only rise or only fall, to where the last one is followed by some
    /// whole turns.
    pub(crate) fn stretches(&self) -> Vec<f64> {
        let along = Along::of(&self.rational);
        let (above, below) = (square(&along.above), square(&along.below));
        let (above_turns, below_turns) = (turning(&along.above), turning(&along.below));
        let delay = self.delay_s * powi(2.0, along.unit());
        // dφ/dω = turning(N)/|N|² − turning(D)/|D|² − T
        let turning =
            &(&(&above_turns * &below) - &(&below_turns * &above)) - &(&above * &below).scaled(delay);
        let gaining = &(&above.derivative() * &below) - &(&above * &below.derivative());
        let mut places = along.frequencies(&turning);
        places.extend(along.frequencies(&gaining));
        places.extend(self.rational.gain_crossings().into_iter().filter(|w| *w > 0.0));
        // a pole or zero on the axis turns at once
        let roots = self.rational.poles().into_iter().chain(self.rational.zeros());
        places.extend(roots.filter(|root| root.im > 0.0).map(|root| root.im));
        places.sort_by(f64::total_cmp);
        let order = self.rational.denominator().degree() + self.rational.numerator().degree();
        let last = places.last().copied().unwrap_or(0.0) + (order as f64 * PI + 2.0 * TAU) / self.delay_s;
        places.push(last);
        places.insert(0, 1e-9 * places[0]);
        places.dedup_by(|a, b| (*a - *b).abs() <= 1e-12 * *b);
        places
    }

    /// Gain margins alone.
    pub(super) fn gain_margins(&self) -> Vec<GainMargin> {
        self.gain_margins_in(&Phases::of(self), &self.stretches())
    }

    fn gain_margins_in(&self, phases: &Phases<'_>, stretches: &[f64]) -> Vec<GainMargin> {
        let mut found: Vec<GainMargin> = Vec::new();
        let at_rest = self.rational.dc_gain();
        if at_rest.is_finite() && at_rest < 0.0 {
            found.push(GainMargin { rad_s: 0.0, factor: -1.0 / at_rest });
        }
        for pair in stretches.windows(2) {
            // what turns at once does so at an end
            let (from, to) = (pair[0] * (1.0 + 1e-11), pair[1] * (1.0 - 1e-11));
            let crossings = crossings(phases, from, to);
            found.extend(
                crossings.map(|w| GainMargin { rad_s: w, factor: 1.0 / complex::norm(self.at_frequency(w)) }),
            );
        }
        let end = gain_at_infinity(self);
        if end > 0.0 && end.is_finite() {
            found.push(GainMargin { rad_s: f64::INFINITY, factor: 1.0 / end });
        }
        found.retain(|margin| margin.factor.is_finite() && margin.factor > 0.0);
        found
    }

    fn modulus_margin(&self, phases: &Phases<'_>, stretches: &[f64]) -> Option<ModulusMargin> {
        /// Turn from place to place, rad.
        const TURN: f64 = 0.1;
        const MOST_PLACES: f64 = 20_000.0;
        let distance = |w: f64| complex::norm(1.0 + self.at_frequency(w));
        let end = gain_at_infinity(self);
        let far = if end.is_finite() { (1.0 - end).abs() } else { 0.0 };
        let mut best = (f64::INFINITY, far);
        let at_rest = (1.0 + self.rational.dc_gain()).abs();
        if at_rest < best.1 {
            best = (0.0, at_rest);
        }
        for pair in stretches.windows(2) {
            let (from, to) = (pair[0] * (1.0 + 1e-11), pair[1] * (1.0 - 1e-11));
            let gains = [from, to].map(|w| complex::norm(self.at_frequency(w)));
            let (low, high) = (gains[0].min(gains[1]), gains[0].max(gains[1]));
            // what is as far from 1 all the way is no nearer to −1
            if high < 1.0 - best.1 || low > 1.0 + best.1 {
                continue;
            }
            let turned = (phases.at(to) - phases.at(from)).abs();
            let count = ((turned / TURN).ceil() + 64.0).min(MOST_PLACES) as usize;
            let place = |k: usize| from * tracelight_maths::exp(ln(to / from) * k as f64 / count as f64);
            let even = |k: usize| from + (to - from) * k as f64 / count as f64;
            for at in [&place as &dyn Fn(usize) -> f64, &even] {
                let values: Vec<f64> = (0..=count).map(|k| distance(at(k))).collect();
                for k in 0..=count {
                    let (left, right) = (k.saturating_sub(1), (k + 1).min(count));
                    if values[k] <= values[left] && values[k] <= values[right] && values[k] < 1.5 * best.1 {
                        let nearest = highest(|w| -distance(w), at(left), at(right));
                        if distance(nearest) < best.1 {
                            best = (nearest, distance(nearest));
                        }
                    }
                }
            }
        }
        let distance = if best.1 < 8.0 * f64::EPSILON { 0.0 } else { best.1 };
        Some(ModulusMargin { rad_s: best.0, distance })
    }
}

/// Imaginary part of ν d/dν of ln p(jν), times |p|² over ν, as a polynomial in ν²: o e + 2 x (o′ e − o e′).
fn turning(p: &Polynomial) -> Polynomial {
    let (even, odd) = crate::margins::halves(p);
    let change = &(&odd.derivative() * &even) - &(&odd * &even.derivative());
    &(&odd * &even) + &change.scaled(2.0).shifted(1)
}

/// Where the phase is an odd number of half turns, in a stretch in which it only rises or only falls.
fn crossings<'a>(phases: &'a Phases<'_>, from: f64, to: f64) -> impl Iterator<Item = f64> + use<'a> {
    let ends = [phases.at(from), phases.at(to)];
    let level = |phase: f64| (phase + PI) / TAU;
    let (low, high) = (level(ends[0].min(ends[1])).ceil() as i64, level(ends[0].max(ends[1])).floor() as i64);
    let few = high - low < 2 * MOST_CROSSINGS;
    let all = (low..=high).filter(move |k| few || k - low < MOST_CROSSINGS || high - k < MOST_CROSSINGS);
    let mut places: Vec<f64> = all.map(|k| crossing(phases, (from, to), TAU * k as f64 - PI)).collect();
    places.sort_by(f64::total_cmp);
    places.into_iter()
}

/// Where the phase is that: Newton's steps, halving where they lead out of what is left.
fn crossing(phases: &Phases<'_>, (from, to): (f64, f64), level: f64) -> f64 {
    let rises = phases.at(to) > phases.at(from);
    let (mut low, mut high) = (from, to);
    let mut place = 0.5 * (low + high);
    for _ in 0..200 {
        let off = phases.at(place) - level;
        if off == 0.0 {
            break;
        }
        if (off > 0.0) == rises {
            high = place
        } else {
            low = place
        }
        let newton = place - off / phases.of.logarithmic_slope(place).im;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - place).abs() <= 2.0 * f64::EPSILON * place {
            return next;
        }
        place = next;
    }
    place
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use crate::{Time, TransferFunction};

    fn delayed(text: &str, delay_s: f64) -> Delayed {
        Delayed::new(TransferFunction::parse(text, Time::Continuous).unwrap(), delay_s).unwrap()
    }

    #[test]
    fn margins_of_a_late_integrator_are_those_of_paper() {
        let loops = delayed("1/s", 0.5);
        let margins = loops.margins();
        let gain = margins.least_gain().unwrap();
        assert!((gain.rad_s - PI).abs() < 1e-12 && (gain.factor - PI).abs() < 1e-12, "{gain:?}");
        let phase = margins.least_phase().unwrap();
        assert!((phase.phase_rad - (FRAC_PI_2 - 0.5)).abs() < 1e-12 && phase.rad_s == 1.0, "{phase:?}");
        let DelayMargin::Delay { delay_s, .. } = loops.delay_margin(&margins) else { panic!("it has one") };
        assert!((delay_s - (FRAC_PI_2 - 0.5)).abs() < 1e-12);
        assert_eq!(delayed("1/s", 2.0).delay_margin(&delayed("1/s", 2.0).margins()), DelayMargin::Unstable);
    }

    /// No crossing of a fine grid is missing, and nothing on it is nearer to −1.
    #[test]
    fn nothing_is_missed() {
        for (text, delay_s) in [
            ("2/(s+1)", 0.7),
            ("5/((s+1)(s+2))", 0.1),
            ("3(s+1)/(s^2+0.2s+4)", 1.3),
            ("4/(s-1)", 0.05),
            ("30/(s(s^2+s+25))", 0.02),
            ("0.6(s+3)/(s+1)", 0.4),
            ("(s^2+4)/((s+1)^3)", 2.0),
            ("1/(s^2+1)", 0.3),
            ("0.9(s-1)^2/(s+1)^2", 3.0),
        ] {
            let loops = delayed(text, delay_s);
            let margins = loops.margins();
            let (mut seen, mut nearest) = (Vec::new(), f64::INFINITY);
            let mut last = loops.at_frequency(1e-4);
            for k in 1..=400_000 {
                let w = 1e-4 + f64::from(k) * 1e-4;
                let value = loops.at_frequency(w);
                if value.is_finite() {
                    nearest = nearest.min(complex::norm(1.0 + value));
                    if last.im * value.im < 0.0
                        && value.re < 0.0
                        && last.re < 0.0
                        && complex::norm(value - last) < 0.5 * complex::norm(value)
                    {
                        seen.push(w);
                    }
                    last = value;
                }
            }
            for w in &seen {
                let is_there = margins.gain.iter().any(|margin| (margin.rad_s - w).abs() < 2e-4);
                // beyond the last stretch the gain only falls
                let is_beyond = margins.gain.iter().filter(|m| m.rad_s.is_finite()).all(|m| m.rad_s < *w);
                assert!(is_there || is_beyond, "{text} {delay_s}: {w} in {:?}", margins.gain);
            }
            for margin in margins.gain.iter().filter(|margin| margin.rad_s > 0.0 && margin.rad_s.is_finite())
            {
                let value = loops.at_frequency(margin.rad_s) * margin.factor;
                assert!(complex::norm(value + 1.0) < 1e-8, "{text} {margin:?} {value}");
            }
            let modulus = margins.modulus.unwrap().distance;
            assert!(modulus <= nearest + 1e-9 && modulus > nearest - 1e-3, "{text}: {modulus} {nearest}");
        }
    }
}
