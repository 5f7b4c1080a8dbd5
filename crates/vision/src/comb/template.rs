//! Cross profile of a rule, and its darkness along its length.

use tracelight_image::Plane;

/// Bins a pixel of a rule's template.
const BINS: f32 = 2.0;
/// Columns that are looked at.
const SAMPLED: usize = 600;
/// Of the levels at an offset this is the rule's: what is written over it is darker.
const QUANTILE: f64 = 0.4;
/// Where a rule's darkness is less than this share of its most, and so many levels, it ends.
const FOOT: f32 = 0.06;
const FOOT_LEVELS: f32 = 2.0;
/// Stretches along a rule whose darkness is taken together.
const STRETCHES: usize = 32;
/// A rule is printed as dark as this along its way, as shares of its usual darkness.
const LEAST_SHARE: f32 = 0.4;
const MOST_SHARE: f32 = 1.35;
/// A rule is looked at for its middle where it is darker than this share of its most.
const CORE: f32 = 0.15;
/// A rule's middle is known this well from where it crosses strips, px.
const MOST_OFF: f32 = 1.0;

/// A rule's darkness by the distance from its middle.
#[derive(Clone, Debug)]
pub(super) struct Template {
    /// The paper's darkness beside it.
    pub(super) paper: f32,
    /// Darkness over the paper's, from `-reach` on, by half pixels.
    levels: Vec<f32>,
    reach: f32,
    /// How far it is dark, before its middle and behind, px.
    pub(super) before: f32,
    pub(super) behind: f32,
    /// Its darkness along, as a share of the template's: one a stretch.
    shares: Vec<f32>,
    /// Deviation of its pixels, levels.
    pub(super) deviation: f32,
    /// Most darkness over the paper's.
    pub(super) most: f32,
}

impl Template {
    /// Of a rule whose middle is `centre` by column, looked at up to `reach` px away. `None` where there is none.
    pub(super) fn of(dark: &Plane<u8>, centre: &[f32], reach: usize) -> Option<Self> {
        let mut template = Self::profile(dark, centre, reach)?;
        template.shares = template.shares_along(dark, centre);
        template.deviation = template.deviation_along(dark, centre);
        Some(template)
    }

    /// Measures the cross profile only, uniform along the rule and without a deviation.
    pub(super) fn profile(dark: &Plane<u8>, centre: &[f32], reach: usize) -> Option<Self> {
        let every = sampled_every(dark);
        let mut bins: Vec<Vec<u8>> = vec![Vec::new(); 2 * reach * BINS as usize + 1];
        for x in (0..dark.width).step_by(every) {
            let middle = centre[x].round() as isize;
            for y in middle - reach as isize + 1..middle + reach as isize {
                let bin = ((y as f32 - centre[x] + reach as f32) * BINS).round();
                if (0..dark.height as isize).contains(&y) && (0.0..bins.len() as f32).contains(&bin) {
                    bins[bin as usize].push(dark.row(y as usize)[x]);
                }
            }
        }
        // few columns may be all of one place, where ink lies
        let least = dark.width / every / 5;
        let levels = bridged(&bins.into_iter().map(|bin| quantile(bin, least)).collect::<Vec<_>>());
        let (low, high) = levels.split_at(levels.len() / 2);
        let least = |half: &[f32]| half.iter().copied().fold(f32::MAX, f32::min);
        let paper = least(low).max(least(high));
        let levels: Vec<f32> = levels.iter().map(|v| (v - paper).max(0.0)).collect();
        let reach = reach as f32;
        let mut template = Self {
            paper,
            levels,
            reach,
            before: 0.0,
            behind: 0.0,
            shares: vec![1.0],
            deviation: 0.0,
            most: 0.0,
        };
        template.measure()?;
        Some(template)
    }

    /// How far it reaches and how dark it is.
    fn measure(&mut self) -> Option<()> {
        let middle = self.levels.len() / 2;
        let near = middle.saturating_sub(3)..(middle + 4).min(self.levels.len());
        let peak = near.max_by(|&a, &b| self.levels[a].total_cmp(&self.levels[b]))?;
        self.most = self.levels[peak];
        let foot = (FOOT * self.most).max(FOOT_LEVELS);
        if self.most <= foot {
            return None;
        }
        let before = (0..peak).rev().find(|&i| self.levels[i] < foot)?;
        let behind = (peak..self.levels.len()).find(|&i| self.levels[i] < foot)?;
        self.before = self.reach - before as f32 / BINS;
        self.behind = behind as f32 / BINS - self.reach;
        self.levels[..before].fill(0.0);
        self.levels[behind..].fill(0.0);
        Some(())
    }

    /// Width at half of its darkness, px.
    pub(super) fn width(&self) -> f64 {
        let half = self.levels.iter().filter(|v| **v >= 0.5 * self.most).count();
        half as f64 / f64::from(BINS)
    }

    /// Darkness over the paper's so far from the middle.
    pub(super) fn at(&self, offset: f32) -> f32 {
        let bin = ((offset + self.reach) * BINS).clamp(0.0, (self.levels.len() - 1) as f32);
        let (low, share) = (bin as usize, bin.fract());
        let high = (low + 1).min(self.levels.len() - 1);
        self.levels[low] * (1.0 - share) + self.levels[high] * share
    }

    /// By how much it is darker or paler than the template in a column.
    pub(super) fn share(&self, x: usize, width: usize) -> f32 {
        between(&self.shares, x, width)
    }

    fn shares_along(&self, dark: &Plane<u8>, centre: &[f32]) -> Vec<f32> {
        let of = |k: usize| {
            let columns = k * dark.width / STRETCHES..(k + 1) * dark.width / STRETCHES;
            let mut shares: Vec<f32> = columns
                .filter_map(|x| {
                    let y = centre[x].round();
                    let model = self.at(y - centre[x]);
                    let row = (0.0..dark.height as f32).contains(&y).then_some(y as usize)?;
                    (model > 0.5 * self.most).then(|| (f32::from(dark.row(row)[x]) - self.paper) / model)
                })
                .collect();
            shares.sort_unstable_by(f32::total_cmp);
            shares.get((QUANTILE * shares.len() as f64) as usize).copied().unwrap_or(1.0)
        };
        let raw: Vec<f32> = (0..STRETCHES).map(of).collect();
        // where ink lies along the rule, the rule's own darkness is not seen
        let known = |v: f32| if v <= MOST_SHARE { v.max(LEAST_SHARE) } else { 1.0 };
        let steadied = |k: usize| {
            let near = raw[k.saturating_sub(2)..(k + 3).min(raw.len())].iter();
            let mut near: Vec<f32> = near.map(|&v| known(v)).collect();
            near.sort_unstable_by(f32::total_cmp);
            near[near.len() / 2]
        };
        (0..STRETCHES).map(steadied).collect()
    }

    /// The rule's middle by column as its own levels tell it, stretch by stretch: between strips it may lie a part of a pixel beside
    /// `centre`, and of a rule as narrow as that a third would be left.
    pub(super) fn centred(&self, dark: &Plane<u8>, centre: &[f32]) -> Vec<f32> {
        // the foot of a wide rule is the paper's own shading as well
        let foot = CORE * self.most;
        let is_core = |v: &f32| *v > foot;
        let core = self.levels.iter().position(is_core).zip(self.levels.iter().rposition(is_core));
        let Some((first, last)) = core else { return centre.to_vec() };
        let at = |bin: usize| bin as f32 / BINS - self.reach;
        let core = (first..=last).map(|bin| (at(bin), (self.levels[bin] - foot).max(0.0)));
        let Some((middle, mass)) = centroid(core) else { return centre.to_vec() };
        let mass = mass / BINS;
        let off = |x: usize| {
            if centre[x] < -self.reach {
                return None;
            }
            let rows = (centre[x] + at(first) - MOST_OFF).ceil().max(0.0) as usize
                ..((centre[x] + at(last) + MOST_OFF).floor().max(0.0) as usize + 1).min(dark.height);
            let over = |y: usize| (f32::from(dark.row(y)[x]) - self.paper - foot).max(0.0);
            let (at, seen) = centroid(rows.map(|y| (y as f32 - centre[x], over(y))))?;
            // what is much darker than the rule has ink on it
            (LEAST_SHARE..MOST_SHARE).contains(&(seen / mass)).then_some(at - middle)
        };
        let usual = |k: usize| {
            let mut offs: Vec<f32> =
                (k * dark.width / STRETCHES..(k + 1) * dark.width / STRETCHES).filter_map(off).collect();
            offs.sort_unstable_by(f32::total_cmp);
            // a few columns may be all under ink
            let is_known = STRETCHES * offs.len() > dark.width / 4;
            if is_known { offs[offs.len() / 2].clamp(-MOST_OFF, MOST_OFF) } else { 0.0 }
        };
        let offs: Vec<f32> = (0..STRETCHES).map(usual).collect();
        centre.iter().enumerate().map(|(x, &at)| at + between(&offs, x, centre.len())).collect()
    }

    /// From what is paler than expected: what is darker may be ink.
    fn deviation_along(&self, dark: &Plane<u8>, centre: &[f32]) -> f32 {
        let mut below: Vec<f32> = Vec::new();
        for x in (0..dark.width).step_by(sampled_every(dark)) {
            let y = centre[x].round();
            if (0.0..dark.height as f32).contains(&y) {
                let expected = self.paper + self.share(x, dark.width) * self.at(y - centre[x]);
                below.push(expected - f32::from(dark.row(y as usize)[x]));
            }
        }
        below.retain(|v| *v > 0.0);
        below.sort_unstable_by(f32::total_cmp);
        // of a normal distribution half is within 0.6745 deviations
        below.get(below.len() / 2).copied().unwrap_or(0.0) / 0.6745
    }
}

/// Columns from one that is looked at to the next.
fn sampled_every(dark: &Plane<u8>) -> usize {
    (dark.width / SAMPLED).max(1)
}

/// Between the middles of stretches, in a column.
fn between(stretches: &[f32], x: usize, width: usize) -> f32 {
    let last = stretches.len() - 1;
    let place = ((x as f32 + 0.5) / width as f32 * stretches.len() as f32 - 0.5).clamp(0.0, last as f32);
    let (low, part) = (place as usize, place.fract());
    stretches[low] * (1.0 - part) + stretches[(low + 1).min(last)] * part
}

/// The mean place of some weights, and their sum; `None` where that is nothing.
fn centroid(weights: impl Iterator<Item = (f32, f32)>) -> Option<(f32, f32)> {
    let (sum, moment) = weights.fold((0.0, 0.0), |(sum, moment), (at, w)| (sum + w, moment + at * w));
    (sum > 0.0).then(|| (moment / sum, sum))
}

/// The level below which a share of some is; `None` where they are too few.
fn quantile(mut levels: Vec<u8>, least: usize) -> Option<f32> {
    if levels.len() <= least {
        return None;
    }
    let at = (QUANTILE * (levels.len() - 1) as f64) as usize;
    Some(f32::from(*levels.select_nth_unstable(at).1))
}

/// Places without a level between those with one, straight; 0 where there is none at all.
pub(super) fn bridged(levels: &[Option<f32>]) -> Vec<f32> {
    let mut out: Vec<f32> = Vec::with_capacity(levels.len());
    let mut last: Option<f32> = None;
    for (i, level) in levels.iter().enumerate() {
        let Some(level) = *level else { continue };
        // from the last one that is known, which the first has before it all along
        let (from, first) = (out.len(), last.unwrap_or(level));
        let steps = (i + 1 - from) as f32;
        out.extend((from..=i).map(|k| first + (level - first) * (k + 1 - from) as f32 / steps));
        last = Some(level);
    }
    out.resize(levels.len(), last.unwrap_or(0.0));
    out
}
