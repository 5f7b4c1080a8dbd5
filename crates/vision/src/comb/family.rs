//! Selects the lines of a page that are its rules: equally spaced, similar, from border to border.

use tracelight_maths::planar;
use tracelight_stroke::Point;

use super::chain::{FEWEST, longest_chain};
use super::drift::Drift;
use super::law::Law;
use super::strips::Strips;
use super::track::Track;

/// Share of the page that they cover across.
const COVERED: f64 = 0.6;
/// Share of the rules between the first and the last that may be missing.
const MISSING: f64 = 0.25;
/// Squares are as wide as high to this share.
const SQUARE: f64 = 0.03;

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
        (self.spacing * scale, -planar::heading(way))
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
