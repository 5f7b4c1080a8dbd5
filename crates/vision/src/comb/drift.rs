//! By how much each rule is off the law of its family: a page bends in more ways than a law knows, but from rule to rule hardly, and
//! writing on a rule looks like a part of it that lies elsewhere.

use tracelight_image::median::middle;
use tracelight_image::solve::line;

use super::chain::is_alike;
use super::law::Law;
use super::strips::{Strip, Strips};

/// From rule to rule a page bends by no more than this share of the spacing, or so many px, than it did before.
const NEAR: f64 = 0.025;
const NEAR_PX: f64 = 2.0;
/// So much of what a rule is further off than the one before it the next one is as well.
const KEPT: f64 = 0.5;
/// Strips to either side, and the fewest that tell.
const BESIDE: usize = 2;
const FEWEST: usize = 3;

/// How far off the law rules are seen, rule by rule and strip by strip, px.
pub(super) struct Drift<'a> {
    law: &'a Law,
    strips: &'a Strips<'a>,
    contrast: f64,
}

/// How far off a rule is at each strip; `None` where it is not seen.
type Seen = Vec<Option<f64>>;

impl<'a> Drift<'a> {
    /// Of rules of some contrast.
    pub(super) const fn of(law: &'a Law, strips: &'a Strips<'a>, contrast: f64) -> Self {
        Self { law, strips, contrast }
    }

    /// Where the rules of these numbers are at each strip, px across; they follow each other. The one that is seen best is begun with.
    pub(super) fn courses(&self, rules: std::ops::RangeInclusive<i32>) -> Vec<Vec<f64>> {
        let level = vec![0.0; self.strips.strips.len()];
        let reach = self.law.reach_px();
        let even = |rule: &i32| {
            let seen = self.seen(*rule, &level, reach);
            let steps = seen.windows(2).filter_map(|pair| pair[0].zip(pair[1]));
            steps.filter(|(a, b)| (a - b).abs() < 0.5 * NEAR_PX).count()
        };
        let (first, last) = (*rules.start(), *rules.end());
        let best = rules.max_by_key(even).unwrap_or(first);
        let begun = smoothed(&self.seen(best, &level, reach), f64::INFINITY);
        let mut up = self.followed((first..best).rev(), &begun);
        up.reverse();
        let down = self.followed(best + 1..=last, &begun);
        let offs = up.into_iter().chain([begun]).chain(down);
        offs.zip(first..).map(|(off, rule)| self.on_law(rule, &off)).collect()
    }

    /// How far off rule after rule is, from one that is known on.
    fn followed(&self, rules: impl Iterator<Item = i32>, begun: &[f64]) -> Vec<Vec<f64>> {
        let near = (NEAR * self.law.spacing).max(NEAR_PX);
        let (mut before, mut change) = (begun.to_vec(), vec![0.0; begun.len()]);
        let follow = |rule: i32| {
            let expected: Vec<f64> = before.iter().zip(&change).map(|(off, change)| off + change).collect();
            let rest = smoothed(&self.seen(rule, &expected, near), near);
            // what a strip alone is off is not the page's bend, and would add up from rule to rule
            let off: Seen = expected.iter().zip(rest).map(|(off, rest)| Some(off + rest)).collect();
            let off = smoothed(&off, f64::INFINITY);
            for (k, change) in change.iter_mut().enumerate() {
                *change = KEPT * (off[k] - before[k]);
            }
            before.clone_from(&off);
            off
        };
        rules.map(follow).collect()
    }

    /// How far off what is expected a rule is seen, as far as `near` px.
    fn seen(&self, rule: i32, expected: &[f64], near: f64) -> Seen {
        let on_law = self.on_law(rule, expected);
        let nearest = |(strip, at): (&Strip, &f64)| {
            let peak = strip.nearest(*at, near, |peak| is_alike(peak, self.contrast));
            peak.map(|peak| peak.at - at)
        };
        self.strips.strips.iter().zip(&on_law).map(nearest).collect()
    }

    fn on_law(&self, rule: i32, off: &[f64]) -> Vec<f64> {
        let strips = self.strips.strips.iter().zip(off);
        strips.map(|(strip, off)| self.law.at(f64::from(rule), strip.at) + off).collect()
    }
}

/// What is so near to the middle of what is seen about a strip is the rule, px.
const STRAY_PX: f64 = 1.5;

/// At each strip where the straight line leads through what is seen near it, but for what strays; at most so far off.
fn smoothed(seen: &Seen, most: f64) -> Vec<f64> {
    let at = |k: usize| {
        let near = |reach: usize| {
            let window = k.saturating_sub(reach)..(k + reach + 1).min(seen.len());
            window.filter_map(|i| seen[i].map(|off| (i as f64 - k as f64, off)))
        };
        let reach = (BESIDE..seen.len()).find(|&reach| near(reach).count() >= FEWEST).unwrap_or(seen.len());
        let middle = middle(near(reach).map(|(_, off)| off).collect()).unwrap_or(0.0);
        let own = || near(reach).filter(|(_, off)| (off - middle).abs() < STRAY_PX);
        // on one side of it alone a line would lead anywhere
        let is_about = own().map(|(i, _)| i).sum::<f64>().abs() <= (own().count() * BESIDE) as f64;
        let line = line(own().map(|(i, off)| (i, off, 1.0))).filter(|_| is_about);
        line.map_or(middle, |(at, _)| at).clamp(-most, most)
    };
    (0..seen.len()).map(at).collect()
}
