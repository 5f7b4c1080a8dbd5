//! Levels that an output crosses, and how far it goes, for all time: none is missed.
//!
//! From each moment on the output is a Taylor polynomial and a remainder that the modes bound. In Bernstein's form that says where it
//! cannot cross a level, has no turn, or has one alone. Steps are as long as it does: long where nothing can happen, short where
//! something does.

use crate::LinearError;
use crate::transient::taylor::Taylor;
use crate::transient::term::Sum;

/// Most moments that are looked at.
const MOST_MOMENTS: usize = 200_000;
/// What is no more than that share of what matters is rounding, and what is no more than so many roundings of all modes.
const ROUNDING: f64 = 1e-13;
const ROUNDINGS: f64 = 16.0;

/// A sweep over the modes of an output that converges; times in its own unit.
pub(super) struct Sweep<'a> {
    sum: &'a Sum,
    /// Rates of the fastest and of the slowest mode.
    fastest: f64,
    slowest: f64,
    /// Below that it is rounding.
    noise: f64,
    left: usize,
}

/// A largest value and when it is there.
type Best = (f64, Option<f64>);

impl<'a> Sweep<'a> {
    /// Of modes that all die out; `scale` is what values are judged by. Nothing without modes.
    pub(super) fn new(sum: &'a Sum, scale: f64) -> Option<Self> {
        let (fastest, slowest) = sum.rates()?;
        let noise = (ROUNDING * scale)
            .max(ROUNDINGS * f64::EPSILON * (sum.most_after(0.0, 1.0) + sum.most_after(0.0, -1.0)));
        Some(Self { sum, fastest, slowest, noise, left: MOST_MOMENTS })
    }

    fn moment(&mut self, time: f64) -> Result<Taylor, LinearError> {
        self.left = self.left.checked_sub(1).ok_or(LinearError::NotConverged)?;
        Ok(self.sum.modes(time))
    }

    fn first_step(&self) -> f64 {
        0.3 / self.fastest
    }

    /// Whether a step is too short to be halved again.
    fn is_short(&self, step: f64, time: f64) -> bool {
        step <= (1e-7 / self.fastest).max(4.0 * f64::EPSILON * time)
    }

    /// Largest value of the modes at any time, times `sign`, and when; 0 and no time if they come to that from below.
    pub(super) fn largest(&mut self, sign: f64) -> Result<Best, LinearError> {
        let mut here = self.moment(0.0)?;
        let mut best = (0.0, None);
        improve(&mut best, sign, &here);
        let mut step = self.first_step();
        for count in 0_usize.. {
            // what is left cannot be more
            if count.is_multiple_of(4) && self.sum.most_after(here.time, sign) <= best.0 + self.noise {
                break;
            }
            let last = self.sum.most_last(&here, step);
            let is_less = here.over(step, 0, last).most(sign) <= best.0 + self.noise;
            let is_short = self.is_short(step, here.time);
            if is_less || is_short || here.over(step, 1, last).has_one_sign() {
                here = self.moment(here.time + step)?;
                improve(&mut best, sign, &here);
                step *= 2.0;
                continue;
            }
            if here.over(step, 2, last).has_one_sign() {
                let next = self.moment(here.time + step)?;
                if sign * here.slope() > 0.0 && sign * next.slope() < 0.0 {
                    let top = self.zero(&here, &next, |at| (at.derivatives[1], at.derivatives[2]))?;
                    improve(&mut best, sign, &top);
                }
                improve(&mut best, sign, &next);
                (here, step) = (next, 2.0 * step);
                continue;
            }
            step *= 0.5;
        }
        Ok(best)
    }

    /// Where a function is zero between two moments at which its signs differ: Newton's iteration, kept between them.
    fn zero(
        &mut self,
        from: &Taylor,
        to: &Taylor,
        of: impl Fn(&Taylor) -> (f64, f64),
    ) -> Result<Taylor, LinearError> {
        let (before, after) = (of(from).0, of(to).0);
        let (mut low, mut high) = (from.time, to.time);
        let mut time = low + (high - low) * before / (before - after);
        loop {
            let at = self.moment(time)?;
            let (value, slope) = of(&at);
            if (value > 0.0) == (after > 0.0) {
                high = time
            } else {
                low = time
            }
            let newton = time - value / slope;
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if (next - time).abs() <= 4.0 * f64::EPSILON * time || value == 0.0 {
                return Ok(at);
            }
            time = next;
        }
    }

    /// When the modes first are at a level, times `sign`: they begin below it, and end above it.
    pub(super) fn first_at(&mut self, level: f64, sign: f64) -> Result<f64, LinearError> {
        let over = |at: &Taylor| sign * at.value() - level;
        let mut here = self.moment(0.0)?;
        let mut step = self.first_step();
        while over(&here) < 0.0 {
            let last = self.sum.most_last(&here, step);
            if here.over(step, 0, last).most(sign) < level {
                (here, step) = (self.moment(here.time + step)?, 2.0 * step);
                continue;
            }
            if here.over(step, 1, last).has_one_sign() || self.is_short(step, here.time) {
                let next = self.moment(here.time + step)?;
                if over(&next) >= 0.0 {
                    let at = self.zero(&here, &next, |at| (over(at), sign * at.slope()))?;
                    return Ok(at.time);
                }
                (here, step) = (next, 2.0 * step);
                continue;
            }
            step *= 0.5;
        }
        Ok(here.time)
    }

    /// When the modes are last that far from 0; 0 if they never are.
    pub(super) fn last_at(&mut self, limit: f64) -> Result<f64, LinearError> {
        let mut end = self.surely_within(limit);
        let mut step = 0.1 / self.slowest;
        while end > 0.0 {
            step = step.min(end);
            let from = self.moment(end - step)?;
            let last = self.sum.most_last(&from, step);
            let over = from.over(step, 0, last);
            if over.most(1.0) < limit && over.most(-1.0) < limit {
                (end, step) = (from.time, 2.0 * step);
                continue;
            }
            if from.over(step, 1, last).has_one_sign() || self.is_short(step, end) {
                if from.value().abs() >= limit {
                    let side = from.value().signum();
                    let until = self.moment(end)?;
                    let of = |at: &Taylor| (side * at.value() - limit, side * at.slope());
                    return self.zero(&from, &until, of).map(|at| at.time);
                }
                (end, step) = (from.time, 2.0 * step);
                continue;
            }
            step *= 0.5;
        }
        Ok(0.0)
    }

    /// A time from which on the modes surely stay within a limit.
    fn surely_within(&self, limit: f64) -> f64 {
        let is_within =
            |time: f64| self.sum.most_after(time, 1.0) <= limit && self.sum.most_after(time, -1.0) <= limit;
        let (mut low, mut high) = (0.0, 1.0 / self.slowest);
        while !is_within(high) && high < f64::MAX / 4.0 {
            (low, high) = (high, 2.0 * high);
        }
        for _ in 0..6 {
            let middle = 0.5 * (low + high);
            if is_within(middle) { high = middle } else { low = middle }
        }
        high
    }
}

fn improve(best: &mut Best, sign: f64, at: &Taylor) {
    if sign * at.value() > best.0 {
        *best = (sign * at.value(), Some(at.time));
    }
}
