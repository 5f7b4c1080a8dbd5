//! Which of the lines that cross a page are its rules: equally spaced, alike, all over it, from border to border.

use tracelight_stroke::Point;

use super::drift::Drift;
use super::strips::{Peak, Strip, Strips};
use super::track::Track;
use crate::solve;

/// Fewest rules.
pub(super) const FEWEST: usize = 5;
/// Share of the page that they cover across.
const COVERED: f64 = 0.6;
/// Share of the rules between the first and the last that may be missing.
const MISSING: f64 = 0.25;
/// Share of the rules that reach either border.
const REACHING: f64 = 0.7;
/// Of a sheet on a table they need not be seen in this many strips next to its edges, which are known roughly, where they are many.
const SHORT: usize = 5;
const MANY: usize = 8;
/// Squares are as wide as high to this share.
const SQUARE: f64 = 0.03;
/// A rule is where it is expected to a share of the spacing, or so many px.
const NEAR: f64 = 0.13;
const NEAR_PX: f64 = 1.5;
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
/// Rules differ in contrast from their fellows by no more than this, as a ratio: each fifth may be printed darker.
const ALIKE: f64 = 2.6;

/// One rule: where it crosses each strip.
#[derive(Clone, Debug)]
pub(super) struct Rule {
    /// px across, from the first pixel's centre; one a strip.
    pub(super) at: Vec<f64>,
}

/// Rules of one direction.
#[derive(Clone, Debug)]
pub(super) struct Family {
    pub(super) rules: Vec<Rule>,
    /// Those that the picture's border cuts, all along or somewhere on their way.
    pub(super) cut: Vec<Rule>,
    pub(super) spacing: f64,
    /// Of most of them, levels.
    pub(super) contrast: f64,
}

impl Family {
    /// Whether a line that is there halfway along is one of the rules.
    pub(super) fn has(&self, middle: f64) -> bool {
        self.rules.first().is_some_and(|rule| self.has_at(rule.at.len() / 2, middle))
    }

    /// Whether a line that crosses a strip there is one of the rules.
    pub(super) fn has_at(&self, strip: usize, at: f64) -> bool {
        let near = (0.05 * self.spacing).max(2.0);
        self.rules.iter().any(|rule| (rule.at[strip] - at).abs() <= near)
    }

    /// How far apart its rules are, px, and how far they are turned, counter-clockwise as seen, rad, on the plane, on which it is level.
    pub(super) fn spacing_and_turn(&self, strips: &Strips<'_>) -> (f64, f64) {
        let (all, rules) = (strips.strips.len(), self.rules.len());
        let place = |rule: usize, strip: usize| {
            let (along, across) = strips.paper.on_plane(strips.strips[strip].at, self.rules[rule].at[strip]);
            Point::new(along, across)
        };
        let way = place(rules / 2, all * 3 / 4) - place(rules / 2, all / 4);
        // what lies between the first and the last, there and where they lie square
        let (first, last) = (place(0, all / 2), place(rules - 1, all / 2));
        let square = self.rules[rules - 1].at[all / 2] - self.rules[0].at[all / 2];
        let scale = (way.cross(last - first) / way.hypot()).abs() / square.max(f64::MIN_POSITIVE);
        (self.spacing * scale, -way.atan2())
    }
}

/// Where rules may end: at the border, or at a line that itself leads from border to border across them; or anywhere, where those
/// across them with this spacing are rules, or whatever is across them.
#[derive(Clone, Copy, Debug)]
pub(super) enum Ends<'a> {
    At(&'a [f64]),
    Squared(f64),
    Anywhere,
}

/// The family of rules among some tracks, if there is one.
pub(super) fn family(strips: &Strips<'_>, tracks: &[Track], ends: Ends<'_>) -> Option<Family> {
    let chain = longest_chain(strips, tracks)?;
    let law = Law::of(strips, tracks, &chain)?;

    if !law.is_even(strips, tracks, &chain) {
        return None;
    }
    let mut contrasts: Vec<f64> = chain.iter().map(|link| tracks[link.track].contrast()).collect();
    contrasts.sort_unstable_by(f64::total_cmp);
    let contrast = contrasts[contrasts.len() / 2];
    let found = law.seen(strips, contrast);
    let (first, last) = (found.first()?.0, found.last()?.0);
    let between = (last - first + 1) as usize;
    let is_all_over = (between as f64) * law.spacing >= COVERED * breadth(strips);
    let is_whole = found.len() >= FEWEST && (between - found.len()) as f64 <= MISSING * between as f64;
    let reach = match ends {
        Ends::At(lines) => law.reach(strips, &found, lines),
        Ends::Squared(spacing) => is_square(law.spacing, spacing),
        Ends::Anywhere => true,
    };

    if !(is_all_over && is_whole && reach) {
        return None;
    }
    let most = (strips.breadth as f64 / law.spacing) as i32 + 2;
    let is_cut = |index: &i32| law.is_cut(strips, *index);
    let cut: Vec<i32> = (first - most..first).chain(last + 1..=last + most).filter(is_cut).collect();
    let all = cut.iter().copied().fold((first, last), |(low, high), cut| (low.min(cut), high.max(cut)));
    let courses = Drift::of(&law, strips, contrast).courses(all.0..=all.1);
    let rule = |index: i32| Rule { at: courses[(index - all.0) as usize].clone() };
    let rules = found.iter().map(|(index, _)| rule(*index)).collect();
    let cut = cut.into_iter().map(rule).collect();
    Some(Family { rules, cut, spacing: law.spacing, contrast })
}

/// Whether rules that are so far apart either way make squares.
pub(super) fn is_square(spacing: f64, other: f64) -> bool {
    (spacing / other - 1.0).abs() < SQUARE
}

/// How much paper there is across the rules, halfway along, px.
fn breadth(strips: &Strips<'_>) -> f64 {
    let (first, last) = strips.strips[strips.strips.len() / 2].sheet;
    last + 1.0 - first
}

/// A track and which rule it is.
#[derive(Clone, Copy, Debug)]
struct Link {
    index: i32,
    track: usize,
}

/// The most tracks that follow each other at equal distances, in the page's middle.
fn longest_chain(strips: &Strips<'_>, tracks: &[Track]) -> Option<Vec<Link>> {
    let places: Vec<(f64, usize)> = tracks.iter().enumerate().map(|(k, t)| (t.middle(strips), k)).collect();
    let chains = (0..places.len()).filter_map(|k| {
        // the other side of the paper may shine through: rules look alike
        let contrast = tracks[places[k].1].contrast();
        let is_alike = |p: &&(f64, usize)| ratio(tracks[p.1].contrast(), contrast) < ALIKE;
        let mut alike: Vec<(f64, usize)> = places.iter().filter(is_alike).copied().collect();
        alike.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let from = alike.iter().position(|p| p.1 == places[k].1)?;
        let spacing = alike.get(from + 1)?.0 - alike[from].0;
        (spacing >= LEAST_SPACING).then(|| chain(&alike, from, spacing))
    });
    let whole = |chain: &Vec<Link>| {
        let span = (chain[chain.len() - 1].index - chain[0].index + 1) as f64;
        chain.len() >= FEWEST.min(4) && (span - chain.len() as f64) <= 0.5 * span
    };
    // a line midway between two rules makes each second one of another comb missing
    let missing =
        |chain: &Vec<Link>| (chain[chain.len() - 1].index - chain[0].index + 1) as usize - chain.len();
    chains.filter(whole).max_by_key(|chain| chain.len() as isize - missing(chain) as isize)
}

/// Whether a line is as dark as rules of some contrast.
pub(super) fn is_alike(peak: &Peak, contrast: f64) -> bool {
    ratio(peak.contrast, contrast) < ALIKE
}

/// How many times the larger of two is the smaller.
pub(crate) fn ratio(a: f64, b: f64) -> f64 {
    (a / b).max(b / a)
}

/// Least distance of two rules, px.
const LEAST_SPACING: f64 = 6.0;

/// From one track on, both ways, those at a distance that changes slowly.
fn chain(places: &[(f64, usize)], from: usize, spacing: f64) -> Vec<Link> {
    let mut links = vec![Link { index: 0, track: places[from].1 }];
    for way in [1.0, -1.0] {
        let (mut at, mut spacing, mut index) = (places[from].0, spacing, 0);
        'on: loop {
            for skipped in 1..=3 {
                let expected = at + way * f64::from(skipped) * spacing;
                let near = |p: &&(f64, usize)| (p.0 - expected).abs();
                let Some(next) = places.iter().min_by(|a, b| near(a).total_cmp(&near(b))) else { break 'on };
                if near(&next) <= (NEAR * spacing).max(NEAR_PX) {
                    spacing += 0.3 * ((next.0 - at) * way / f64::from(skipped) - spacing);
                    (at, index) = (next.0, index + way as i32 * skipped);
                    links.push(Link { index, track: next.1 });
                    continue 'on;
                }
            }
            break;
        }
    }
    links.sort_unstable_by_key(|link| link.index);
    links.dedup_by_key(|link| link.index);
    links
}

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
    fn of(strips: &Strips<'_>, tracks: &[Track], chain: &[Link]) -> Option<Self> {
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
        std::array::from_fn(|k| i.powi(power(k)) * u.powi(k as i32 % 4))
    }

    /// Where a rule is, px across.
    pub(super) fn at(&self, index: f64, x: f64) -> f64 {
        self.basis(index, x).iter().zip(self.terms).map(|(b, t)| b * t).sum()
    }

    /// Whether the tracks keep to the law as print does.
    fn is_even(&self, strips: &Strips<'_>, tracks: &[Track], chain: &[Link]) -> bool {
        let (mut between, mut along) = (0.0, 0.0);
        for link in chain {
            let off = |(_, x, peak): (f64, f64, Peak)| peak.at - self.at(f64::from(link.index), x);
            let mut offs: Vec<f64> = points(strips, tracks, &[*link]).map(off).collect();
            offs.sort_unstable_by(f64::total_cmp);
            let middle = offs[offs.len() / 2];
            between += middle * middle;
            // half of them lie within the quartiles: writing on a rule moves some
            let quartiles = 0.5 * (offs[offs.len() * 3 / 4] - offs[offs.len() / 4]);
            along += (1.48 * quartiles).powi(2);
        }
        let rms = |sum: f64| (sum / chain.len() as f64).sqrt();
        rms(between) <= (EVEN * self.spacing).max(EVEN_PX)
            && rms(along) <= (STRAIGHT * self.spacing).max(STRAIGHT_PX)
    }

    /// The rules that are seen, also those that no track followed, by number, with where.
    fn seen(&self, strips: &Strips<'_>, contrast: f64) -> Vec<(i32, Vec<Option<Peak>>)> {
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
    fn reach(&self, strips: &Strips<'_>, found: &[(i32, Vec<Option<Peak>>)], lines: &[f64]) -> bool {
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
    fn is_cut(&self, strips: &Strips<'_>, index: i32) -> bool {
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
