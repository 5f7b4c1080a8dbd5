//! The largest gain of a loop with a dead time.

use tracelight_maths::{complex, exp, ln};

use crate::Peak;
use crate::dead_time::highest;
use crate::feedback::function::LoopFunction;
use crate::margins::{Along, square};

/// Turn of the open loop from place to place, rad.
const TURN: f64 = 0.1;
/// Places in a stretch: at least and at most.
const FEWEST: f64 = 64.0;
const MOST: f64 = 20_000.0;

impl LoopFunction {
    /// The largest gain of a stable loop with a dead time, that has no more zeros than poles.
    ///
    /// It is looked for in stretches between the frequencies at which gain and phase of the open loop, and the gain of what is above, turn:
    /// in each on grids that follow the dead time, then between three places of the grid.
    pub(super) fn highest(&self) -> Peak {
        let gain = |w: f64| complex::norm(self.at_frequency(w));
        let mut best = Peak { rad_s: f64::INFINITY, gain: self.gain_at_infinity() };
        let at_rest = self.dc_gain().abs();
        if at_rest >= best.gain {
            best = Peak { rad_s: 0.0, gain: at_rest };
        }
        for pair in self.stretches().windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let turned = (to - from) * self.open().delay_s();
            let count = ((turned / TURN).ceil() + FEWEST).min(MOST) as usize;
            let share = |k: usize| k as f64 / count as f64;
            let even = |k: usize| from + (to - from) * share(k);
            let logarithmic = |k: usize| from * exp(ln(to / from) * share(k));
            for at in [&even as &dyn Fn(usize) -> f64, &logarithmic] {
                let values: Vec<f64> = (0..=count).map(|k| gain(at(k))).collect();
                for k in 0..=count {
                    let (left, right) = (k.saturating_sub(1), (k + 1).min(count));
                    let is_high = values[k] >= values[left] && values[k] >= values[right];
                    if !is_high || values[k] < 0.5 * best.gain {
                        continue;
                    }
                    let inside = highest(gain, at(left), at(right));
                    for w in [at(k), inside] {
                        if gain(w) > best.gain * (1.0 + 4.0 * f64::EPSILON) {
                            best = Peak { rad_s: w, gain: gain(w) };
                        }
                    }
                }
            }
        }
        best
    }

    /// What it nears as the frequency rises, at most: there a dead time lets what comes round add up.
    fn gain_at_infinity(&self) -> f64 {
        let open = self.open().rational();
        let below = open.denominator().degree();
        let leading = |degree: usize, leading: f64| if degree == below { leading.abs() } else { 0.0 };
        let round = leading(open.numerator().degree(), open.numerator().leading());
        self.forward().map_or(0.0, |forward| {
            let above = forward.numerator();
            leading(above.degree(), above.leading()) / (1.0 - round)
        })
    }

    /// Frequencies, rad/s, rising, between which gains and phases only rise or only fall, and some way beyond.
    fn stretches(&self) -> Vec<f64> {
        let mut places = self.open().stretches();
        if let Some(forward) = self.forward() {
            let along = Along::of(&forward);
            let (above, below) = (square(&along.above), square(&along.below));
            let flat = &(&above.derivative() * &below) - &(&above * &below.derivative());
            places.extend(along.frequencies(&flat));
        }
        // resonances of the closed loop
        places.extend(self.open().closed_poles().iter().map(|pole| pole.im).filter(|w| *w > 0.0));
        places.sort_by(f64::total_cmp);
        let (first, last) = (places.first().copied(), places.last().copied());
        places.extend(first.into_iter().flat_map(|w| [1e-2 * w, 1e-1 * w]));
        places.extend(last.into_iter().flat_map(|w| [3.0 * w, 10.0 * w]));
        places.sort_by(f64::total_cmp);
        places.retain(|w| *w > 0.0 && w.is_finite());
        places.dedup_by(|a, b| (*a - *b).abs() <= 1e-12 * *b);
        places
    }
}
