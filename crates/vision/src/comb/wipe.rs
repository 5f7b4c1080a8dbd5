//! Removes one rule from a plane; ink that crosses it remains.
//!
//! Where ink is much darker than the rule, how much of a pixel it covers follows from how dark the pixel is. Where it is not, the rows
//! just beside the rule tell: what leaves the rule on one side is matched with what leaves it on the other where its slope leads,
//! and its cross-section is carried from the one to the other.

use tracelight_image::Plane;

use super::runs::{Run, pairs, runs};
use super::template::{Template, bridged};

/// Levels by which ink differs at least from what it lies on.
const LEAST_LEVELS: f32 = 8.0;
/// And so many deviations.
const DEVIATIONS: f32 = 3.0;
/// Rows between the two that tell a run's slope.
const APART: isize = 3;
/// Ink that is this share darker than the rule is told from it by its darkness alone; from the second on, fully.
const TOLD: (f32, f32) = (0.25, 0.45);

/// What is darker than the rule by this share of what ink is, is ink.
const SURE: f32 = 0.3;

/// What is known of the picture's levels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Levels {
    /// A pixel's deviation.
    pub(super) noise: f32,
    /// The strongest ink.
    pub(super) ink: f32,
}

impl Levels {
    /// By how much a pixel is darker than another for sure.
    pub(super) fn margin(self) -> f32 {
        LEAST_LEVELS.max(DEVIATIONS * self.noise)
    }

    /// By how much ink for sure is darker than a rule, on paper of some darkness.
    fn sure(&self, pixel: &Pixel, paper: f32) -> f32 {
        SURE * (self.ink - paper - pixel.rule)
    }
}

/// Takes a rule off; `centre` is its middle by column. What lies beside it where there are rules `across` it, as dark as these over
/// the paper, is as it is on both sides of them.
pub(super) fn wipe(
    dark: &mut Plane<u8>,
    centre: &[f32],
    template: &Template,
    across: Option<&Plane<u8>>,
    levels: Levels,
) {
    let band = Band::of(dark, centre, template, across, levels);
    let filled = band.filled();
    band.write(dark, &filled);
}

/// The rows of a rule and those beside it.
struct Band<'a> {
    template: &'a Template,
    levels: Levels,
    centre: &'a [f32],
    /// By column: the last row above the rule, the first below.
    rows: Vec<(isize, isize)>,
    /// Most rows between them.
    depth: usize,
    above: Vec<f32>,
    below: Vec<f32>,
    /// Ink that touches the rule from above and from below, with slopes.
    upper: Vec<Run>,
    lower: Vec<Run>,
    margin: f32,
}

impl<'a> Band<'a> {
    fn of(
        dark: &Plane<u8>,
        centre: &'a [f32],
        template: &'a Template,
        across: Option<&Plane<u8>>,
        levels: Levels,
    ) -> Self {
        let rows: Vec<(isize, isize)> = centre
            .iter()
            .map(|c| ((c - template.before).ceil() as isize - 1, (c + template.behind).floor() as isize + 1))
            .collect();
        let depth = rows.iter().map(|r| (r.1 - r.0 - 1).max(0)).max().unwrap_or(0) as usize;
        let margin = levels.margin();
        let row = |pick: fn(&(isize, isize)) -> isize, off: isize| -> Vec<f32> {
            let level = |(x, r): (usize, &(isize, isize))| {
                let y = pick(r) + off;
                let inside = (0..dark.height as isize).contains(&y);
                let level = if inside { f32::from(dark.row(y as usize)[x]) } else { template.paper };
                let rule = across.map_or(0, |rules| rules.get(x as isize, y));
                let rule = Pixel { seen: level - template.paper, rule: f32::from(rule) };
                (rule.rule == 0.0 || rule.seen > rule.rule + margin.max(levels.sure(&rule, template.paper)))
                    .then_some(level)
            };
            bridged(&rows.iter().enumerate().map(level).collect::<Vec<_>>())
        };
        let (above, below) = (row(|r| r.0, 0), row(|r| r.1, 0));
        let sloped = |near: &[f32], far: &[f32]| {
            let far = runs(far, template.paper, margin);
            let mut near = runs(near, template.paper, margin);
            near.iter_mut().for_each(|run| run.lean_on(&far, APART as f32));
            near
        };
        let upper = sloped(&above, &row(|r| r.0, -APART));
        let lower = sloped(&below, &row(|r| r.1, APART));
        Self { template, levels, centre, rows, depth, above, below, upper, lower, margin }
    }

    fn height(&self, x: f32) -> f32 {
        let x = (x.max(0.0) as usize).min(self.rows.len() - 1);
        (self.rows[x].1 - self.rows[x].0) as f32
    }

    /// How dark the ink in the band is by what touches it: over the paper's darkness, by column, rows from the top.
    fn filled(&self) -> Vec<f32> {
        let mut filled = vec![0.0; self.depth * self.rows.len()];
        let pairs = pairs(&self.upper, &self.lower, |x| self.height(x));
        let mut is_through = (vec![false; self.upper.len()], vec![false; self.lower.len()]);
        for &(a, b) in &pairs {
            (is_through.0[a], is_through.1[b]) = (true, true);
            self.carry(&mut filled, Some(&self.upper[a]), Some(&self.lower[b]), 1.0);
        }
        for (run, _) in self.upper.iter().zip(is_through.0).filter(|(_, through)| !through) {
            self.carry(&mut filled, Some(run), None, 0.5);
        }
        for (run, _) in self.lower.iter().zip(is_through.1).filter(|(_, through)| !through) {
            self.carry(&mut filled, None, Some(run), 0.5);
        }
        filled
    }

    /// Carries a cross-section from above to below, or from one side so far in.
    fn carry(&self, filled: &mut [f32], upper: Option<&Run>, lower: Option<&Run>, share: f32) {
        let Some(any) = upper.or(lower) else { return };
        let height = self.height(any.middle());
        let (from, to) = match (upper, lower) {
            (Some(a), Some(b)) if a.is_as_wide_as(b) => (a.clone(), b.clone()),
            (Some(a), Some(b)) if a.width() < b.width() => (a.clone(), a.shifted(a.slope * height)),
            (Some(_), Some(b)) => (b.shifted(b.slope * height), b.clone()),
            (Some(a), None) => (a.clone(), a.carried(height)),
            (None, Some(b)) => (b.carried(height), b.clone()),
            (None, None) => return,
        };
        let reads = |run: Option<&Run>, row: &[f32], along: f32| {
            run.map(|run| sampled(row, run.left + along * run.width()) - self.template.paper)
        };
        let first = (from.left.min(to.left) - 2.0).max(0.0) as usize;
        let last = ((from.right.max(to.right) + 3.0).max(0.0) as usize).min(self.rows.len());
        for x in first..last {
            let (top, bottom) = self.rows[x];
            for y in top + 1..bottom {
                let f = (y - top) as f32 / (bottom - top) as f32;
                let is_in = if upper.is_none() { 1.0 - f <= share } else { f <= share };
                let (left, right) =
                    (from.left + (to.left - from.left) * f, from.right + (to.right - from.right) * f);
                let along = (x as f32 - left) / (right - left).max(0.5);
                let beyond = (left - x as f32).max(x as f32 - right);
                if !is_in || beyond > 1.5 || left > right {
                    continue;
                }
                let level = match (reads(upper, &self.above, along), reads(lower, &self.below, along)) {
                    (Some(u), Some(l)) => u * (1.0 - f) + l * f,
                    (Some(v), None) | (None, Some(v)) => v,
                    (None, None) => 0.0,
                };
                let cell = &mut filled[(y - top - 1) as usize * self.rows.len() + x];
                *cell = cell.max(level);
            }
        }
    }

    /// How dark the ink near a column is, over the paper's; 0 where there is none.
    fn ink_near(&self) -> Vec<f32> {
        let mut near = vec![0.0_f32; self.rows.len()];
        for run in self.upper.iter().chain(&self.lower) {
            let reach = run.slope.abs() * self.height(run.middle()) + 2.0;
            let first = (run.left - reach).max(0.0) as usize;
            let last = ((run.right + reach + 1.0).max(0.0) as usize).min(near.len());
            near[first.min(last)..last].iter_mut().for_each(|v| *v = v.max(run.peak - self.template.paper));
        }
        near
    }

    fn write(&self, dark: &mut Plane<u8>, filled: &[f32]) {
        let near = self.ink_near();
        let (width, paper) = (self.rows.len(), self.template.paper);
        let is_paper = |level: f32| if level < paper + self.margin { level } else { paper };
        for x in 0..width {
            let (top, bottom) = self.rows[x];
            let share = self.template.share(x, width);
            let (u, l) = (is_paper(self.above[x]), is_paper(self.below[x]));
            let rows = (top + 1).max(0)..bottom.min(dark.height as isize);
            let pixel = |dark: &Plane<u8>, y: isize| Pixel {
                seen: (f32::from(dark.row(y as usize)[x]) - paper).max(0.0),
                rule: share * self.template.at(y as f32 - self.centre[x]),
            };
            // ink that keeps to the rule shows by being darker
            let along = rows.clone().map(|y| pixel(dark, y)).filter(|p| p.seen > p.rule + self.sure(p));
            let near = along.map(|p| p.seen).fold(near[x], f32::max);
            for y in rows {
                let f = (y - top) as f32 / (bottom - top) as f32;
                let drawn = filled[(y - top - 1) as usize * width + x];
                let ink = self.ink(&pixel(dark, y), near, drawn);
                let under = u + (l - u) * f;
                let level = under + ink * (1.0 - (under - paper) / self.levels.ink.max(1.0));
                dark.row_mut(y as usize)[x] = level.round().clamp(0.0, 255.0) as u8;
            }
        }
    }

    /// By how much a pixel may be darker than the rule and be no more than it.
    fn spread(&self, pixel: &Pixel) -> f32 {
        self.margin.max(DEVIATIONS * self.template.deviation * (pixel.rule / self.template.most))
    }

    /// By how much it is darker where there is ink on it for sure.
    fn sure(&self, pixel: &Pixel) -> f32 {
        self.spread(pixel).max(self.levels.sure(pixel, self.template.paper))
    }

    /// The ink in a pixel; `near` is how dark ink is there, `drawn` what is carried through.
    fn ink(&self, pixel: &Pixel, near: f32, drawn: f32) -> f32 {
        if near <= 0.0 {
            return 0.0;
        }
        let room = near - pixel.rule;
        let told = ((room / near - TOLD.0) / (TOLD.1 - TOLD.0)).clamp(0.0, 1.0);
        let foot = 0.5 * self.spread(pixel);
        let covered = ((pixel.seen - pixel.rule - foot) / (room - foot).max(1.0)).clamp(0.0, 1.0);
        told * (covered * near).min(pixel.seen) + (1.0 - told) * drawn.min(pixel.seen)
    }
}

/// A pixel of a rule: how much darker than paper it is, and how much the rule alone would be.
struct Pixel {
    seen: f32,
    rule: f32,
}

/// Between two pixels of a row.
fn sampled(row: &[f32], x: f32) -> f32 {
    let x = x.clamp(0.0, (row.len() - 1) as f32);
    let (low, share) = (x as usize, x.fract());
    row[low] * (1.0 - share) + row[(low + 1).min(row.len() - 1)] * share
}
