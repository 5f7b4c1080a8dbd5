//! Checks that a segment stays within its bounds from start to end.

use tracelight_rig::{Joint, Segment, TICK_S};

use crate::config::Config;

/// Most times that a stretch is halved where its hull is too wide to tell: the hull of a quintic that keeps within its bounds is
/// at most some fifty times as far beyond them, and a quarter of that after each halving; seven leave less than 1 %.
const MOST_HALVINGS: u32 = 7;

/// A polynomial on a stretch: coefficients of Bernstein's quintics there. The first and the last are its values at the ends, and all it
/// does between lies within the lowest and the highest (Farin, *Curves and Surfaces for CAGD*, §6).
type Hull = [f32; 6];

/// The bounds of one quantity.
#[derive(Clone, Copy)]
struct Bounds {
    lower: f32,
    upper: f32,
}

impl Bounds {
    const fn both_ways(most: f32) -> Self {
        Self { lower: -most, upper: most }
    }

    /// What is not a number is not within.
    fn contains(self, value: f32) -> bool {
        self.lower <= value && value <= self.upper
    }

    /// Whether a polynomial stays within; in doubt not.
    fn hold(self, hull: &Hull, halvings: u32) -> bool {
        if hull.iter().all(|&value| self.contains(value)) {
            return true;
        }
        let [first, .., last] = *hull;
        if halvings == 0 || !self.contains(first) || !self.contains(last) {
            return false;
        }
        let (before, after) = halves(hull);
        self.hold(&before, halvings - 1) && self.hold(&after, halvings - 1)
    }
}

impl Config {
    /// Whether a segment says how far its joints may stray, which is no further than a host may say, and keeps both where they may be, as slow
    /// and as steady as they have to be.
    pub(crate) fn may_run(&self, segment: &Segment, homed: bool) -> bool {
        Joint::BOTH.into_iter().all(|j| {
            let tolerance_rad = segment.tolerance_rad[j];
            let limits = &self.axes[j].limits;
            let position = self.range_rad(j, homed);
            let [angle, speed, acceleration] = motions(&segment.coefficients[j], f32::from(segment.ticks));
            // as fast as its clock may run
            let rate = segment.rate_limit.most();
            tolerance_rad > 0.0
                && segment.rate_limit.is_valid()
                && tolerance_rad <= self.tolerance_limit_rad
                && Bounds { lower: position.0, upper: position.1 }.hold(&angle, MOST_HALVINGS)
                && Bounds::both_ways(limits.speed_rad_s * TICK_S / rate).hold(&speed, MOST_HALVINGS)
                && Bounds::both_ways(limits.acceleration_rad_s2 * TICK_S * TICK_S / (rate * rate))
                    .hold(&acceleration, MOST_HALVINGS)
        })
    }
}

/// A quintic, its speed and its acceleration over so many ticks: rad, rad per tick, rad per tick².
fn motions(c: &[f32; 6], ticks: f32) -> [Hull; 3] {
    let [c0, c1, c2, c3, c4, c5] = *c;
    [
        hull(&[c0, c1, c2, c3, c4, c5], ticks),
        hull(&[c1, 2.0 * c2, 3.0 * c3, 4.0 * c4, 5.0 * c5, 0.0], ticks),
        hull(&[2.0 * c2, 6.0 * c3, 12.0 * c4, 20.0 * c5, 0.0, 0.0], ticks),
    ]
}

/// Bernstein's coefficients of a polynomial in ticks over so many of them: bᵢ = Σₖ C(i,k)/C(5,k) cₖ Tᵏ, by sums of neighbours.
fn hull(c: &[f32; 6], ticks: f32) -> Hull {
    const CHOOSE: [f32; 6] = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];
    let mut hull = *c;
    let mut power = 1.0;
    for (value, choose) in hull.iter_mut().zip(CHOOSE) {
        *value *= power / choose;
        power *= ticks;
    }
    for first in 1..6 {
        for i in (first..6).rev() {
            hull[i] += hull[i - 1];
        }
    }
    hull
}

/// Splits the polynomial at the middle of its interval (de Casteljau).
fn halves(hull: &Hull) -> (Hull, Hull) {
    let (mut before, mut after) = (*hull, *hull);
    for (step, value) in before.iter_mut().enumerate().skip(1) {
        for i in 0..6 - step {
            after[i] = 0.5 * (after[i] + after[i + 1]);
        }
        *value = after[0];
    }
    (before, after)
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use std::vec::Vec;

    /// Seeded numbers in −1 to 1 (Marsaglia's xorshift).
    struct Dice(u64);

    impl Dice {
        fn roll(&mut self) -> f64 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
    }

    /// A quintic in the shape of what a host may send: any size of each coefficient's share of its way.
    fn any(dice: &mut Dice, ticks: f64) -> [f32; 6] {
        core::array::from_fn(|k| {
            (dice.roll() * libm::exp(3.0 * dice.roll()) / libm::pow(ticks, k as f64)) as f32
        })
    }

    /// A polynomial at many instants, and the sum of its terms' sizes at the end: what rounding is a share of.
    fn samples(c: &[f64], ticks: f64) -> (Vec<f64>, f64) {
        const MANY: u32 = 2000;
        let at = |i: u32| f64::from(i) / f64::from(MANY) * ticks;
        let horner = |n: f64| c.iter().rev().fold(0.0, |sum, c| sum * n + c);
        let terms = c.iter().rev().fold(0.0, |sum, c| sum * ticks + c.abs());
        ((0..=MANY).map(|i| horner(at(i))).collect(), terms)
    }

    #[test]
    fn a_hull_tells_what_dense_samples_tell() {
        let mut dice = Dice(7);
        let (mut held, mut refused, mut in_vain) = (0, 0, 0);
        for _ in 0..20_000 {
            let ticks = (1.0 + 200.0 * dice.roll().abs()).floor();
            let c = any(&mut dice, ticks);
            let of = c.map(f64::from);
            let speed = [of[1], 2.0 * of[2], 3.0 * of[3], 4.0 * of[4], 5.0 * of[5]];
            let acceleration = [2.0 * of[2], 6.0 * of[3], 12.0 * of[4], 20.0 * of[5]];
            let all = [&of[..], &speed, &acceleration].map(|c| samples(c, ticks));
            for (hull, (values, terms)) in motions(&c, ticks as f32).iter().zip(all) {
                let most = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
                // somewhere about the bound
                let bound = most * (1.0 + 0.03 * dice.roll());
                let holds = Bounds::both_ways(bound as f32).hold(hull, MOST_HALVINGS);
                let beyond = most - bound;
                assert!(!holds || beyond <= 1e-6 * terms, "{c:?} over {ticks}: {beyond} beyond {bound}");
                assert!(holds || most > 0.99 * bound, "{c:?} over {ticks}: refused at {most} of {bound}");
                held += u32::from(holds);
                refused += u32::from(!holds);
                in_vain += u32::from(!holds && most < bound);
            }
        }
        assert!(held > 20_000 && refused > 20_000 && in_vain < 1000, "{held} {refused} {in_vain}");
    }

    #[test]
    fn what_is_not_a_number_keeps_to_no_bound() {
        for place in 0..6 {
            for wild in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e38] {
                let mut c = [0.0; 6];
                c[place] = wild;
                let all = motions(&c, 100.0);
                assert!(!all.iter().all(|hull| Bounds::both_ways(1e3).hold(hull, MOST_HALVINGS)), "{c:?}");
            }
        }
    }
}
