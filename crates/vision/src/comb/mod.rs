//! Detects the rules of ruled and squared paper and removes them from under the ink.
//!
//! Printed rules are thin, straight but for the page's own bend, parallel, equally spaced, of one darkness, and run from border to border
//! all over the page; a drawing's lines rarely do one of these things and never all. On a sheet laid square (`paper`) `strips` finds thin lines in narrow strips
//! across the page, `track` follows them over it, a `chain` is those of them that follow each other at equal distances, a `family` those that are rules: they keep to a `law`, but for how much each of them `drift`s off it; `template` learns what each looks
//! like, `wipe` takes it off and leaves what is drawn over it; what was `taken` off may have left something where it lay.

mod chain;
mod drift;
mod family;
mod law;
mod paper;
mod rules;
mod runs;
mod strips;
mod taken;
mod template;
mod track;
mod wipe;

pub(crate) use chain::ratio;
use family::{Ends, Family};
pub(crate) use paper::Lie;
use paper::{Laid, Paper};
pub use rules::{Comb, Rules};
use strips::Strips;
pub(crate) use taken::TakenOff;
use template::Template;
use track::{Track, tracks};
use wipe::{Levels, wipe};

use tracelight_image::threshold::over;
use tracelight_image::{Plane, regions};

/// Most families of rules in one direction.
const MOST_FAMILIES: usize = 3;

/// How far a rule's darkness may reach from its middle, as a share of the side across it and at least, px.
const REACH_SHARE: usize = 40;
const LEAST_REACH: usize = 6;

/// Shortest side of a picture in which rules are looked for, px.
const LEAST_SIDE: usize = 56;

/// A plane of darkness without the rules of its paper, and which they were. `noise` is its pixels' deviation, `strongest` how dark the
/// strongest ink is. `None` where the paper is plain.
pub(crate) fn without_rules(
    dark: &Plane<u8>,
    noise: f64,
    strongest: f64,
    lie: Lie<'_>,
) -> Option<(Plane<u8>, TakenOff)> {
    let laid = Laid::of(lie, (dark.width, dark.height));
    let papers = [Paper::level(&laid), Paper::upright(&laid)];
    let seen = laid.seen(dark);
    if seen.width.min(seen.height) < LEAST_SIDE {
        return None;
    }
    let sides = [Strips::of_level(&seen, noise, papers[0]), Strips::of_upright(&seen, noise, papers[1])];
    if !sides.iter().any(|strips| strips.are_crossed_by(chain::FEWEST - 1)) {
        return None;
    }
    let [level, upright] = sides.map(Side::of);
    let [level_rules, upright_rules] = families(&level, &upright, strongest)?;
    let levels = Levels { noise: noise as f32, ink: strongest as f32 };
    let mut turned = dark.transposed();
    let across = upright.printed(&turned, &upright_rules);
    let mut plane = dark.clone();
    let along = level.printed(&plane, &level_rules);
    // where those of the other direction lie
    let under_upright = across.upright_on(dark.width, dark.height);
    let under_level = along.upright_on(dark.height, dark.width);
    along.take_off(&mut plane, Some(&under_upright), levels);
    turned = plane.transposed();
    across.take_off(&mut turned, None, levels);
    plane = turned.transposed();
    // margins and the like: without the rules that cross them they are seen all along, but where they lie under one
    let bare =
        Strips::of_level(&laid.seen(&plane), noise, papers[0]).with(&level.strips_beside(&level_rules));
    Side::of(bare).whole_lines_off(&mut plane, &under_upright, levels);
    let bare =
        Strips::of_upright(&laid.seen(&plane), noise, papers[1]).with(&upright.strips_beside(&upright_rules));
    turned = plane.transposed();
    Side::of(bare).whole_lines_off(&mut turned, &under_level, levels);
    plane = turned.transposed();
    let under_level = under_level.transposed();
    crossings_off(&mut plane, &under_level, &under_upright, levels);
    let mut combs = along.combs;
    let turn = |comb: Comb| Comb { upright: true, turned_rad: -comb.turned_rad, ..comb };
    combs.extend(across.combs.into_iter().map(turn));
    (!combs.is_empty()).then(|| {
        let rules = Rules { combs };
        (plane, TakenOff::of(dark, rules, [&under_level, &under_upright], levels))
    })
}

/// Width of the bare paper that surrounds a remnant where two rules cross, px.
const ROUND_CROSSING: usize = 2;
/// Largest darkness in that border, as a share of the ink's.
const LEFT: f32 = 0.3;

/// Clears what rules left where they cross, level ones and upright ones each known by how dark they were, and nothing else is drawn.
fn crossings_off(plane: &mut Plane<u8>, level: &Plane<u8>, upright: &Plane<u8>, levels: Levels) {
    let crossings = over(level, 0).and(&over(upright, 0));
    let most = LEFT * levels.ink;
    for crossing in regions(&crossings) {
        let Some((columns, rows)) = crossing.bounds(ROUND_CROSSING, (plane.width, plane.height)) else {
            continue;
        };
        let (left, right, top, bottom) = (columns.start, columns.end - 1, rows.start, rows.end - 1);
        let ends = [top, bottom].into_iter().flat_map(|y| plane.row(y)[left..=right].to_vec());
        let sides = (top..=bottom).flat_map(|y| [plane.row(y)[left], plane.row(y)[right]]);
        let mut round: Vec<u8> = ends.chain(sides).collect();
        if round.iter().all(|&level| f32::from(level) < most) {
            round.sort_unstable();
            let paper = round[round.len() / 2];
            rows.for_each(|y| plane.row_mut(y)[left..=right].fill(paper));
        }
    }
}

/// Fewest rules in each direction of squared paper that does not fill the sheet.
const FEWEST_SQUARED: usize = 12;
/// Largest darkness of such rules, as a share of the strongest ink: a drawn board is as dark as the ink.
const PALER: f64 = 0.8;

/// The rules of either direction; `None` where there are none at all. The strongest ink is so dark.
fn families(level: &Side<'_>, upright: &Side<'_>, strongest: f64) -> Option<[Vec<Family>; 2]> {
    let mut level_rules = level.families(Ends::At(&upright.margins()));
    let mut upright_rules = upright.families(Ends::At(&level.margins()));
    match (level_rules.first(), upright_rules.first()) {
        (None, None) => return squares(level, upright, strongest),
        (Some(rules), None) => upright_rules = upright.families(Ends::Squared(rules.spacing)),
        (None, Some(rules)) => level_rules = level.families(Ends::Squared(rules.spacing)),
        (Some(_), Some(_)) => (),
    }
    Some([level_rules, upright_rules])
}

/// The rules of squared paper that end anywhere: its edge may be unknown.
fn squares(level: &Side<'_>, upright: &Side<'_>, strongest: f64) -> Option<[Vec<Family>; 2]> {
    let found = [level, upright].map(|side| side.families(Ends::Anywhere));
    let [Some(first), Some(other)] = found.each_ref().map(|families| families.first()) else { return None };
    let is_paper =
        |family: &Family| family.rules.len() >= FEWEST_SQUARED && family.contrast < PALER * strongest;
    let are_squares = family::is_square(first.spacing, other.spacing);
    (are_squares && is_paper(first) && is_paper(other)).then_some(found)
}

/// What crosses the strips of one direction.
struct Side<'a> {
    strips: Strips<'a>,
    tracks: Vec<Track>,
}

impl<'a> Side<'a> {
    fn of(strips: Strips<'a>) -> Self {
        let tracks = tracks(&strips);
        Self { strips, tracks }
    }

    /// Where the lines are that lead from border to border.
    fn margins(&self) -> Vec<f64> {
        let whole = self.tracks.iter().filter(|track| track.is_whole(&self.strips, |_, _| false));
        whole.map(|track| track.middle(&self.strips)).collect()
    }

    /// Rules of this direction: those of the page, and those of its back that shine through.
    fn families(&self, ends: Ends<'_>) -> Vec<Family> {
        let (mut left, mut found) = (self.tracks.clone(), Vec::new());
        while let Some(family) = family::family(&self.strips, &left, ends) {
            let before = left.len();
            left.retain(|track| !family.has(track.middle(&self.strips)));
            found.push(family);
            if left.len() == before || found.len() == MOST_FAMILIES {
                break;
            }
        }
        found
    }

    /// The rules of some families as they are printed on a plane on which they are level.
    fn printed(&self, plane: &Plane<u8>, families: &[Family]) -> Printed {
        let mut printed = Printed { rules: Vec::new(), cut: Vec::new(), combs: Vec::new() };
        for family in families {
            let (spacing_px, turned_rad) = family.spacing_and_turn(&self.strips);
            let reach = ((0.45 * spacing_px) as usize).clamp(3, most_reach(plane));
            let course = |at: &[f64]| self.course(at, plane.width);
            let rules: Vec<Rule> =
                family.rules.iter().filter_map(|rule| Rule::of(plane, course(&rule.at), reach)).collect();
            let mut by_width: Vec<&Template> = rules.iter().map(|rule| &rule.template).collect();
            by_width.sort_by(|a, b| a.width().total_cmp(&b.width()));
            let Some(&usual) = by_width.get(by_width.len() / 2) else { continue };
            let (count, width_px) = (family.rules.len(), usual.width());
            printed.combs.push(Comb { count, spacing_px, width_px, upright: false, turned_rad });
            // too little of it is seen to know it by itself
            let cut =
                |at: &[f64]| Rule { centre: usual.centred(plane, &course(at)), template: usual.clone() };
            printed.cut.extend(family.cut.iter().map(|rule| cut(&rule.at)));
            printed.rules.extend(rules);
        }
        printed
    }

    /// What crosses the strips beside some families of rules.
    fn strips_beside(&self, families: &[Family]) -> Strips<'a> {
        self.strips.clone().without(|strip, at| families.iter().any(|family| family.has_at(strip, at)))
    }

    /// By column of a plane on which it is level, between where it crosses the strips; beside the sheet it is far off the plane.
    fn course(&self, at: &[f64], width: usize) -> Vec<f32> {
        let paper = self.strips.paper;
        let places = self.strips.strips.iter().zip(at).map(|(strip, &at)| paper.on_plane(strip.at, at));
        let (along, across): (Vec<f64>, Vec<f64>) = places.unzip();
        // beyond the horizon of a sheet there is none of it
        if along.iter().any(|&at| at < 0.5 * paper::FAR) {
            return vec![OFF_THE_PLANE; width];
        }
        let mut course = courses(&along, &across, width);
        for (x, at) in course.iter_mut().enumerate() {
            if !paper.is_on_plane(x, at.round().max(0.0) as usize) {
                *at = OFF_THE_PLANE;
            }
        }
        course
    }

    /// Takes the lines from border to border off a plane on which they are level; where there were rules `across` them it may not be seen.
    fn whole_lines_off(&self, plane: &mut Plane<u8>, across: &Plane<u8>, levels: Levels) {
        let reach = most_reach(plane);
        let half = strips::wide(plane.width) as isize / 2;
        let is_blind = |along: f64, at: f64| {
            let (along, at) = self.strips.paper.on_plane(along, at);
            let (x, y) = (along.round() as isize, at.round() as isize);
            (x - half..=x + half).any(|x| across.get(x, y) > 0)
        };
        for track in self.tracks.iter().filter(|track| track.is_whole(&self.strips, is_blind)) {
            let course = self.course(&track.smoothed(&self.strips), plane.width);
            if let Some(rule) = Rule::of(plane, course, reach) {
                wipe(plane, &rule.centre, &rule.template, None, levels);
            }
        }
    }
}

/// Where a rule is that is not on the sheet, px across.
const OFF_THE_PLANE: f32 = -1e5;

/// How far a level rule's darkness may reach, px.
fn most_reach(plane: &Plane<u8>) -> usize {
    (plane.height / REACH_SHARE).max(LEAST_REACH)
}

/// One rule as it is printed.
struct Rule {
    /// Its middle by column.
    centre: Vec<f32>,
    template: Template,
}

impl Rule {
    /// About `course`, looked at up to `reach` px away; `None` where there is none.
    fn of(plane: &Plane<u8>, course: Vec<f32>, reach: usize) -> Option<Self> {
        let centre = Template::profile(plane, &course, reach)?.centred(plane, &course);
        let template = Template::of(plane, &centre, reach)?;
        Some(Self { centre, template })
    }
}

/// All rules of one direction as they are printed, level.
struct Printed {
    rules: Vec<Rule>,
    /// Those that the border cuts.
    cut: Vec<Rule>,
    combs: Vec<Comb>,
}

impl Printed {
    /// How dark they are on a plane on which they are upright, over the paper's darkness; 0 beside them.
    fn upright_on(&self, width: usize, height: usize) -> Plane<u8> {
        let mut plane = Plane::filled(width, height, 0);
        for rule in self.rules.iter().chain(&self.cut) {
            let Rule { centre, template } = rule;
            for (y, &at) in centre.iter().enumerate().take(height) {
                let column = |x: f32| x.clamp(0.0, width as f32) as usize;
                let share = template.share(y, centre.len());
                for x in column(at - template.before - 1.0)..column(at + template.behind + 2.0) {
                    let level = (share * template.at(x as f32 - at)).clamp(1.0, 255.0) as u8;
                    let cell = &mut plane.row_mut(y)[x];
                    *cell = level.max(*cell);
                }
            }
        }
        plane
    }

    /// Takes them off a plane; what is there of rules `across` them is not drawn.
    fn take_off(&self, plane: &mut Plane<u8>, across: Option<&Plane<u8>>, levels: Levels) {
        for rule in &self.rules {
            wipe(plane, &rule.centre, &rule.template, across, levels);
        }
        for rule in &self.cut {
            wipe(plane, &rule.centre, &rule.template, across, levels);
            continue_over(plane, &rule.centre, rule.template.width());
        }
    }
}

/// Covers a rule, where it lies on the plane's upper or lower border, with what is just within: half a rule has no other
/// side.
fn continue_over(plane: &mut Plane<u8>, centre: &[f32], width: f64) {
    let (columns, last) = (plane.width, plane.height - 1);
    let on_border = |at: f32| at.abs().min((at - last as f32).abs()) <= law::CUT_PX as f32;
    for (x, &at) in centre.iter().enumerate().filter(|(_, at)| on_border(**at)) {
        let reach = (width as f32 + 1.5).ceil();
        let is_upper = at < 0.5 * last as f32;
        let within = if is_upper { at + reach } else { at - reach }.clamp(0.0, last as f32) as usize;
        let rows = if is_upper { 0..within } else { within + 1..last + 1 };
        let level = plane.values[within * columns + x];
        rows.for_each(|y| plane.values[y * columns + x] = level);
    }
}

/// Between places where it is known, by column, and beyond them: straight from one to the next, or as the nearest few lead, bent as
/// the places about it are.
fn courses(at: &[f64], values: &[f64], width: usize) -> Vec<f32> {
    /// Two places beside each other would tell a course, or a bend, from too near.
    const FEW: usize = 4;
    let last = at.len() - 1;
    let slope = |from: usize, to: usize| (values[to] - values[from]) / (at[to] - at[from]);
    // half the second derivative: the difference of two slopes over the way between their middles
    let bends = |k: usize| {
        let (first, end) = (k.saturating_sub(FEW), (k + FEW).min(last));
        let middle = (first + end) / 2;
        (slope(middle, end) - slope(first, middle)) / (at[end] - at[first])
    };
    let bends: Vec<f64> = (0..=last).map(bends).collect();
    let mut k = 0;
    let value = |x: usize| {
        let x = x as f64;
        while k + 2 < at.len() && x > at[k + 1] {
            k += 1;
        }
        let (from, to) = match x {
            x if x < at[0] => (0, FEW.min(last)),
            x if x > at[last] => (last, last.saturating_sub(FEW)),
            _ => (k, k + 1),
        };
        let straight = values[from] + slope(from, to) * (x - at[from]);
        (straight + bends[from] * (x - at[from]) * (x - at[to])) as f32
    };
    (0..width).map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// So small that the strips at the borders are those beside them.
    #[test]
    fn rules_of_a_picture_of_some_ninety_px_are_taken_off() {
        let level = |i: usize| if (i / 90) % 12 == 6 { 120 } else { 4 };
        let plane = Plane { width: 90, height: 90, values: (0..90 * 90).map(level).collect() };
        let (plain, off) = without_rules(&plane, 0.0, 200.0, Lie { beside: None, corners: None })
            .unwrap_or_else(|| panic!());
        assert_eq!(off.rules.combs.len(), 1);
        let left = plain.values.iter().filter(|&&level| level > 60).count();
        assert!(left < 90, "{left} of 630 px");
    }

    #[test]
    fn what_two_rules_left_where_they_cross_goes_and_a_line_over_it_stays() {
        let rule = |at: &dyn Fn(usize, usize) -> bool| {
            let level = |i: usize| if at(i % 40, i / 40) { 90 } else { 0 };
            Plane { width: 40, height: 30, values: (0..1200).map(level).collect() }
        };
        let level = rule(&|_, y| (14..17).contains(&y));
        let upright = rule(&|x, _| (9..12).contains(&x) || (29..32).contains(&x));
        let levels = Levels { noise: 0.0, ink: 200.0 };
        // a speck at the first crossing, a line over the second
        let ink = |x: usize, y: usize| {
            (10..12).contains(&x) && (14..16).contains(&y) || x + y > 43 && x + y < 47 && x > 20
        };
        let mut plane = Plane { width: 40, height: 30, values: vec![3; 1200] };
        (0..1200).filter(|i| ink(i % 40, i / 40)).for_each(|i| plane.values[i] = 180);
        let before = plane.clone();
        crossings_off(&mut plane, &level, &upright, levels);
        let is_speck = |i: &usize| i % 40 < 20;
        assert!((0..1200).filter(is_speck).all(|i| plane.values[i] == 3));
        assert!((0..1200).filter(|i| !is_speck(i)).all(|i| plane.values[i] == before.values[i]));
    }
}
