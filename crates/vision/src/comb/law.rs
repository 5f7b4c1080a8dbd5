//! The model of a family of rules: the position of each rule by its number.

use tracelight_image::solve;
use tracelight_maths::powi;

use super::chain::{LEAST_SPACING, Link, NEAR, NEAR_PX, is_alike};
use super::strips::{Peak, Strip, Strips};
use super::track::Track;

/// Share of the rules that reach either border.
const REACHING: f64 = 0.7;
/// Of a sheet on a table they need not be seen in this many strips next to its edges, which are known roughly, where they are many.
const SHORT: usize = 5;
const MANY: usize = 8;
/// Printed rules are equally spaced to a share of the spacing, or so many px (rms): what a hand draws is not.
const EVEN: f64 = 0.025;
const EVEN_PX: f64 = 0.6;
/// And they are straight to so much, along their own smooth course.
const STRAIGHT: f64 = 0.035;
const STRAIGHT_PX: f64 = 0.7;
/// Share of the strips in which a rule whose place is known must be seen.
const SEEN: f64 = 0.45;
/// The middle of a rule that the picture's border cuts is this near to it, px: half of a wide rule.
pub(super) const CUT_PX: f64 = 4.0;

/// Terms of the law: up to the cube of a rule's number, and of the way along it.
const TERMS: usize = 16;
/// Of the cube of their number only so many rules tell: those of a sheet that is seen at a slant are the nearer to each other the
/// further they are away.
const TELL_CUBE: usize = 14;

/// Of a rule's number in a term.
const fn power(term: usize) -> i32 {
    term as i32 / 4
}

/// Where each rule is: smooth in its number and along it, for a page lies bent or is seen at a slant.
pub(super) struct Law {
    terms: [f64; TERMS],
    /// Rules that were used to find it, the middle one and half their number.
    about: (f64, f64),
    length: f64,
    pub(super) spacing: f64,
}

impl Law {
    /// The law that the tracks of a chain keep to best; `None` where they tell none.
    pub(super) fn of(strips: &Strips<'_>, tracks: &[Track], chain: &[Link]) -> Option<Self> {
        let (first, last) = (f64::from(chain.first()?.index), f64::from(chain.last()?.index));
        let about = (0.5 * (first + last), (0.5 * (last - first)).max(1.0));
        let mut law = Self { terms: [0.0; TERMS], about, length: strips.length as f64, spacing: 0.0 };
        let mut most_off = f64::MAX;
        for _ in 0..3 {
            let (mut normal, mut right) = ([[0.0; TERMS]; TERMS], [0.0; TERMS]);
            for (index, x, peak) in points(strips, tracks, chain) {
                if (peak.at - law.at(index, x)).abs() > most_off {
                    continue;
                }
                let basis = law.basis(index, x);
                for (k, row) in normal.iter_mut().enumerate() {
                    row.iter_mut().zip(basis).for_each(|(cell, b)| *cell += basis[k] * b);
                    right[k] += basis[k] * peak.at;
                }
            }
            let unknown = |k: usize| if power(k) == 3 && chain.len() < TELL_CUBE { 1e9 } else { 1e-6 };
            (0..TERMS).for_each(|k| normal[k][k] += unknown(k));
            law.terms = solve::symmetric(normal, right)?;
            let middle = 0.5 * law.length;
            law.spacing = (law.at(last, middle) - law.at(first, middle)) / (last - first);
            most_off = (0.1 * law.spacing).max(NEAR_PX);
        }
        (law.spacing >= LEAST_SPACING).then_some(law)
    }

    fn basis(&self, index: f64, x: f64) -> [f64; TERMS] {
        let (i, u) = ((index - self.about.0) / self.about.1, 2.0 * x / self.length - 1.0);
        std::array::from_fn(|k| powi(i, power(k)) * powi(u, k as i32 % 4))
    }

    /// Where a rule is, px across.
    pub(super) fn at(&self, index: f64, x: f64) -> f64 {
        self.basis(index, x).iter().zip(self.terms).map(|(b, t)| b * t).sum()
    }

    /// Whether the tracks keep to the law as print does.
    pub(super) fn is_even(&self, strips: &Strips<'_>, tracks: &[Track], chain: &[Link]) -> bool {
        let (mut between, mut along) = (0.0, 0.0);
        for link in chain {
            let off = |(_, x, peak): (f64, f64, Peak)| peak.at - self.at(f64::from(link.index), x);
            let mut offs: Vec<f64> = points(strips, tracks, &[*link]).map(off).collect();
            offs.sort_unstable_by(f64::total_cmp);
            let middle = offs[offs.len() / 2];
            between += middle * middle;
            // half of them lie within the quartiles: writing on a rule moves some
            let quartiles = 0.5 * (offs[offs.len() * 3 / 4] - offs[offs.len() / 4]);
            along += powi(1.48 * quartiles, 2);
        }
        let rms = |sum: f64| (sum / chain.len() as f64).sqrt();
        rms(between) <= (EVEN * self.spacing).max(EVEN_PX)
            && rms(along) <= (STRAIGHT * self.spacing).max(STRAIGHT_PX)
    }

    /// The rules that are seen, also those that no track followed, by number, with where.
    pub(super) fn seen(&self, strips: &Strips<'_>, contrast: f64) -> Vec<(i32, Vec<Option<Peak>>)> {
        let mut found = Vec::new();
        let middle = self.about.0.round() as i32;
        let most = (strips.breadth as f64 / self.spacing) as i32 + 2;
        for index in middle - most..=middle + most {
            let points = self.points_on(strips, f64::from(index), contrast);
            let within = strips.strips.iter().filter(|strip| {
                let at = self.at(f64::from(index), strip.at);
                strip.has(at - 1.0) && strip.has(at + 1.0)
            });
            let (within, seen) = (within.count(), points.iter().flatten().count());
            if within >= 4 && seen as f64 >= SEEN * within as f64 && 2 * within > strips.strips.len() {
                found.push((index, points));
            }
        }
        found
    }

    /// Whether most rules lead from one border of the sheet to the other, or to one of some lines across them that is near it.
    pub(super) fn reach(
        &self,
        strips: &Strips<'_>,
        found: &[(i32, Vec<Option<Peak>>)],
        lines: &[f64],
    ) -> bool {
        let all = &strips.strips;
        let most = |reaching: usize| reaching as f64 >= REACHING * found.len() as f64;
        let is_reached = |k: usize| most(found.iter().filter(|(_, seen)| seen[k].is_some()).count());
        // by rule: where the sheet is turned in the picture, each has its own ends
        let short = if strips.paper.is_cut_out() && found.len() >= MANY { SHORT } else { 1 };
        let is_within = |index: i32, k: usize| all[k].has(self.at(f64::from(index), all[k].at));
        let starts = found.iter().filter(|(index, seen)| {
            (0..all.len()).filter(|&k| is_within(*index, k)).take(short).any(|k| seen[k].is_some())
        });
        let ends = found.iter().filter(|(index, seen)| {
            (0..all.len()).rev().filter(|&k| is_within(*index, k)).take(short).any(|k| seen[k].is_some())
        });
        let (is_started, is_ended) = (most(starts.count()), most(ends.count()));
        // the strips just within such a line
        let right_of = |line: &f64| all.partition_point(|strip| strip.at <= *line);
        let mut firsts = lines.iter().map(right_of).filter(|k| *k < all.len() / 4);
        let left_of = |line: &f64| all.partition_point(|strip| strip.at < *line).checked_sub(1);
        let mut lasts = lines.iter().filter_map(left_of).filter(|k| *k >= all.len() - all.len() / 4);
        (is_started || firsts.any(is_reached)) && (is_ended || lasts.any(is_reached))
    }

    /// So far from where it is expected a rule may be, px.
    pub(super) fn reach_px(&self) -> f64 {
        (NEAR * self.spacing).max(NEAR_PX)
    }

    /// Whether some of a rule lies in the picture, or on its border, which cuts it.
    pub(super) fn is_cut(&self, strips: &Strips<'_>, index: i32) -> bool {
        strips.strips.iter().any(|strip| {
            let at = self.at(f64::from(index), strip.at);
            strip.sheet.0 - CUT_PX <= at && at <= strip.sheet.1 + CUT_PX
        })
    }

    /// In each strip the line nearest to where a rule must be.
    fn points_on(&self, strips: &Strips<'_>, index: f64, contrast: f64) -> Vec<Option<Peak>> {
        let reach = self.reach_px();
        let nearest =
            |strip: &Strip| strip.nearest(self.at(index, strip.at), reach, |peak| is_alike(peak, contrast));
        strips.strips.iter().map(nearest).collect()
    }
}

/// Number, place along and line of all that some tracks passed.
fn points<'a>(
    strips: &'a Strips<'_>,
    tracks: &'a [Track],
    chain: &'a [Link],
) -> impl Iterator<Item = (f64, f64, Peak)> + 'a {
    chain.iter().flat_map(move |link| {
        let known = tracks[link.track].points.iter().zip(&strips.strips);
        known.filter_map(move |(p, s)| p.map(|p| (f64::from(link.index), s.at, p)))
    })
}
